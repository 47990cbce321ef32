"""All checks of a robot, each finding as a Problem where it was written."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.problems import Problem
from studio.robot.checks.extents import extents
from studio.robot.checks.joint_types import type_findings
from studio.robot.checks.likeness import likeness_findings
from studio.robot.checks.limits import limit_findings
from studio.robot.checks.masses import mass_findings
from studio.robot.checks.mending import Mender
from studio.robot.checks.mesh_scale import mesh_scale_findings
from studio.robot.checks.presence import presence_findings
from studio.robot.checks.shapes import shape_findings

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from studio.description.values import Part
    from studio.robot.checks.finding import Finding
    from studio.robot.measures import Bounds
    from studio.robot.values import Robot

ALIKE_AT_MOST: Final = 200
"""Findings of one code that are told one by one: nobody reads ten thousand."""


@dataclass(frozen=True, slots=True)
class CheckedRobot:
    """A robot and what is known around it.

    `part` gives the element of a part key as it was written, `mesh_bounds` the box of a mesh by
    its URI, unscaled (None while it is not known), `source` the bytes of a file as it is edited
    now (None when it cannot be read).
    """

    robot: Robot
    part: Callable[[str], Part | None]
    mesh_bounds: Callable[[str], Bounds | None]
    source: Callable[[str], bytes | None]


def check_robot(checked: CheckedRobot) -> tuple[Problem, ...]:
    """Everything that is wrong with a robot itself, with a fix where one is safe.

    What its names and ties come to is not looked at: `structure` does that.
    """
    mender = Mender(checked.source)
    found: list[Problem] = []
    counts = Counter[str]()
    left_out: dict[str, Finding] = {}
    for one in robot_findings(checked):
        counts[one.code] += 1
        if counts[one.code] <= ALIKE_AT_MOST:
            found.append(_problem(one, checked, mender))
        else:
            left_out[one.code] = one
    return (*found, *(_more(one, counts[one.code]) for one in left_out.values()))


def _more(last: Finding, count: int) -> Problem:
    more = count - ALIKE_AT_MOST
    sentence = (
        f'{more:,} more parts have the fault "{last.code}": mend those that are listed first.'
    )
    return Problem(last.severity, last.code, sentence)


def robot_findings(checked: CheckedRobot) -> Iterator[Finding]:
    """The findings of every check, before places and fixes are looked for."""

    def xml_of(key: str) -> str:
        part = checked.part(key)
        return part.xml if part else ""

    robot = checked.robot
    found = extents(robot.links.values(), checked.mesh_bounds)
    yield from type_findings(robot, xml_of)
    yield from limit_findings(robot, xml_of)
    yield from mass_findings(robot, found)
    yield from likeness_findings(robot, found)
    yield from presence_findings(robot)
    yield from shape_findings(robot, found)
    yield from mesh_scale_findings(robot, checked.mesh_bounds)


def _problem(finding: Finding, checked: CheckedRobot, mender: Mender) -> Problem:
    part = checked.part(finding.key) if finding.key else None
    return Problem(
        finding.severity,
        finding.code,
        finding.sentence,
        part.place if part else None,
        macro_stack=part.calls if part else (),
        fix=mender.fix(finding.mend, part) if finding.mend and part else None,
        parts=tuple(key for key in (finding.key, *finding.others) if key),
    )
