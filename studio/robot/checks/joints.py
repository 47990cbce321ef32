"""Checks of joints: their types, limits and axes."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING, Final

from studio.problems import Severity
from studio.robot.checks.finding import AddChild, Finding, SetAttributes, SwapAttributes
from studio.robot.values import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from studio.description.elements import Element
    from studio.robot.checks.finding import CheckedRobot
    from studio.robot.values import Joint, Limit, Robot

_NEEDS_LIMIT: Final = {
    JointType.REVOLUTE: AddChild(
        "Add limits of ±1.57 rad", '<limit lower="-1.57" upper="1.57" effort="10" velocity="1"/>'
    ),
    JointType.PRISMATIC: AddChild(
        "Add limits of 0 and 0.1 m", '<limit lower="0" upper="0.1" effort="10" velocity="0.1"/>'
    ),
}
"""Types that need a limit, and one to begin with."""
_MOST: Final = {
    "effort": ("10", "the most that it pushes, in N m or N"),
    "velocity": ("1", "the fastest that it goes, in rad/s or m/s"),
}
_HAS_AXIS: Final = frozenset(
    {JointType.REVOLUTE, JointType.CONTINUOUS, JointType.PRISMATIC, JointType.PLANAR}
)
_LIKENESS: Final = 0.6
_OTHER_NAMES: Final = {
    "hinge": JointType.REVOLUTE,
    "rotary": JointType.REVOLUTE,
    "rotational": JointType.REVOLUTE,
    "slider": JointType.PRISMATIC,
    "linear": JointType.PRISMATIC,
    "wheel": JointType.CONTINUOUS,
    "free": JointType.FLOATING,
    "static": JointType.FIXED,
}
"""Names for joint types in other formats."""


def findings(checked: CheckedRobot) -> Iterator[Finding]:
    """Yield what is wrong with the types, the limits and the axes of joints."""
    yield from _of_types(checked.robot, checked.element)
    yield from _of_limits(checked.robot, checked.element)


def _of_limits(robot: Robot, element_of: Callable[[str], Element | None]) -> Iterator[Finding]:
    """Yield what is wrong with the limits and axes of the joints.

    Args:
        robot: As it is drawn.
        element_of: Returns the element of a part by its key; None when it is not known. Only that
            distinguishes a missing effort from one of 0.
    """
    for joint in robot.joints.values():
        if joint.limit is None:
            element = element_of(_key(joint))
            is_unwritten = element is None or element.find("limit") is None
            if joint.type in _NEEDS_LIMIT and is_unwritten:
                yield _missing_limit(joint)
        else:
            yield from _range_findings(joint, joint.limit)
            if not (joint.limit.effort and joint.limit.velocity):
                yield from _unwritten(joint, element_of(_key(joint)))
        if joint.type in _HAS_AXIS and not any(joint.axis):
            yield _zero_axis(joint)


def _missing_limit(joint: Joint) -> Finding:
    sentence = (
        f'Joint "{joint.name}" is {joint.type} and has no <limit>, so that ROS rejects the robot: '
        f"say how far it goes, or make it {_without_limit(joint)}."
    )
    mend = _NEEDS_LIMIT[joint.type]
    return Finding(Severity.ERROR, "missing-limit", sentence, _key(joint), mend)


def _without_limit(joint: Joint) -> str:
    return "continuous" if joint.type is JointType.REVOLUTE else "fixed"


def _range_findings(joint: Joint, limit: Limit) -> Iterator[Finding]:
    if joint.type not in _NEEDS_LIMIT:
        return
    lower, upper = f"{limit.lower:.6g}", f"{limit.upper:.6g}"
    if limit.lower > limit.upper:
        sentence = (
            f'Joint "{joint.name}" has a lower limit of {lower} above its upper one of {upper}: '
            "no position lies between them, swap them."
        )
        mend = SwapAttributes("Swap the limits", "limit", "lower", "upper")
        yield Finding(Severity.ERROR, "reversed-limits", sentence, _key(joint), mend)
    elif limit.lower == limit.upper:
        sentence = (
            f'Joint "{joint.name}" is {joint.type} and cannot move, since both of its limits are '
            f"{lower}: widen them, or make it fixed."
        )
        yield Finding(Severity.WARNING, "equal-limits", sentence, _key(joint))


def _unwritten(joint: Joint, element: Element | None) -> Iterator[Finding]:
    """Yield an effort or velocity that the limit leaves out: urdfdom needs both."""
    limit = None if element is None else element.find("limit")
    if limit is None:
        return
    for name, (text, meaning) in _MOST.items():
        if limit.get(name) is None:
            sentence = (
                f'The <limit> of joint "{joint.name}" has no {name}, so that ROS rejects the '
                f"robot: write {meaning}."
            )
            mend = SetAttributes(f'Add {name}="{text}"', ("limit",), ((name, text),))
            yield Finding(Severity.ERROR, f"limit-without-{name}", sentence, _key(joint), mend)


def _zero_axis(joint: Joint) -> Finding:
    sentence = (
        f'Joint "{joint.name}" is {joint.type} and its axis is 0 0 0, which points nowhere: '
        "write the direction that it turns about or slides along."
    )
    mend = SetAttributes('Write xyz="0 0 1"', ("axis",), (("xyz", "0 0 1"),))
    return Finding(Severity.WARNING, "zero-axis", sentence, _key(joint), mend)


def _key(joint: Joint) -> str:
    return f"joint:{joint.name}"


def _of_types(robot: Robot, element_of: Callable[[str], Element | None]) -> Iterator[Finding]:
    """Yield joints of no or an unknown type; `element_of` as for the limits."""
    for joint in robot.joints.values():
        if joint.type is JointType.FIXED:
            element = element_of(_key(joint))
            written = JointType.FIXED if element is None else element.get("type", "")
            if written.strip() not in set(JointType):
                yield _unknown(joint, written)


def _unknown(joint: Joint, written: str) -> Finding:
    known = ", ".join(JointType)
    what = f'is of type "{written}"' if written else "has no type"
    meant = _meant(written)
    todo = f'did you mean "{meant}"?' if meant else f"URDF knows {known}."
    sentence = f'Joint "{joint.name}" {what}, so that ROS rejects the robot: {todo}'
    mend = SetAttributes(f'Write type="{meant}"', (), (("type", meant),)) if meant else None
    return Finding(Severity.ERROR, "joint-type", sentence, f"joint:{joint.name}", mend)


def _meant(written: str) -> str:
    """Return the type that was most likely meant; empty when that is unclear."""
    text = written.strip().lower()
    if text in _OTHER_NAMES:
        return _OTHER_NAMES[text].value
    return next(iter(get_close_matches(text, [*JointType], 1, _LIKENESS)), "")


WHY: Final = {
    "missing-limit": {
        "en": "Revolute and prismatic joints need a limit with lower, upper, effort and velocity; "
        "readers of URDF refuse the robot without it.",
        "de": "Gelenke vom Typ revolute und prismatic brauchen ein limit mit lower, upper, effort "
        "und velocity; URDF-Parser lehnen den Roboter sonst ab.",
    },
    "reversed-limits": {
        "en": "With lower above upper no position is allowed: controllers clamp to one end or "
        "refuse to move.",
        "de": "Liegt lower über upper, ist keine Stellung erlaubt: Controller bleiben an einem "
        "Ende oder weigern sich, das Gelenk zu bewegen.",
    },
    "equal-limits": {
        "en": 'With lower and upper alike the joint cannot move. If that is meant, type="fixed" '
        "says it better.",
        "de": "Sind lower und upper gleich, kann sich das Gelenk nicht bewegen. Ist das gemeint, "
        'sagt es type="fixed" besser.',
    },
    "zero-axis": {
        "en": "An axis of no length has no direction: the joint would not know around or along "
        "what it moves.",
        "de": "Eine Achse ohne Länge hat keine Richtung: Das Gelenk wüsste nicht, um was oder "
        "entlang was es sich bewegt.",
    },
    "joint-type": {
        "en": "URDF knows revolute, continuous, prismatic, fixed, floating and planar; any other "
        "word is refused by its readers.",
        "de": "URDF kennt revolute, continuous, prismatic, fixed, floating und planar; jedes "
        "andere Wort lehnen Parser ab.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
