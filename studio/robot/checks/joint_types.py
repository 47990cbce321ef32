"""Checks of the types that joints are written with: what URDF does not know is drawn fixed."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING, Final

from studio.problems import Severity
from studio.robot.checks.finding import Finding, SetAttributes
from studio.robot.checks.limits import joint_element
from studio.robot.values import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from studio.robot.values import Joint, Robot

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
"""What other formats and people call them."""


def type_findings(robot: Robot, xml_of: Callable[[str], str]) -> Iterator[Finding]:
    """Joints of no or an unknown type; `xml_of` as for the limits."""
    for joint in robot.joints.values():
        if joint.type is JointType.FIXED:
            xml = xml_of(f"joint:{joint.name}")
            if 'type="fixed"' not in xml and (element := joint_element(xml)) is not None:
                written = element.get("type", "")
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
    """The type that was most likely meant; empty when nobody can tell."""
    word = written.strip().lower()
    if word in _OTHER_NAMES:
        return _OTHER_NAMES[word].value
    return next(iter(get_close_matches(word, [*JointType], 1, _LIKENESS)), "")
