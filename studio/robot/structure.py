"""The tree of a robot: which joints hold, which links are roots, and what is wrong with it."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from studio.problems import Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.robot.values import Joint, Robot

Finding: TypeAlias = tuple[Problem, str]
"""A problem and the part key of the element that it is about, empty for the whole robot."""
_Shape: TypeAlias = tuple[frozenset[str], tuple[tuple[str, str, str, str], ...]]


@dataclass(frozen=True, slots=True)
class Structure:
    """The tree that names, parents, children and mimicked joints make; numbers do not matter."""

    shape: _Shape
    findings: tuple[Finding, ...]
    dropped: frozenset[str]
    """Joints that hold nothing: a link of theirs is missing or already held by another joint."""
    freed: frozenset[str]
    """Joints that mimic a joint which cannot be followed: they move by themselves."""
    broken: bool
    """No link, or joints in a cycle: there is nothing to draw."""

    @classmethod
    def of(cls, robot: Robot) -> Structure:
        """Examine the whole tree."""
        findings: list[Finding] = []
        held = _held_joints(robot, findings)
        parents = {joint.child: joint.parent for joint in held.values()}
        roots = [name for name in robot.links if name not in parents]
        broken = not robot.links or _report_cycles(robot, parents, held, findings)
        _report_roots(robot, roots, findings)
        freed = _unled(held, findings)
        dropped = frozenset(robot.joints) - frozenset(held)
        return cls(_shape(robot), tuple(findings), dropped, freed, broken)

    def fits(self, robot: Robot) -> bool:
        """Whether the names and ties of `robot` are still those that were examined."""
        return self.shape == _shape(robot)

    def pruned(self, robot: Robot) -> Robot:
        """Return the robot without joints that hold nothing and leaders that do not exist."""
        if not self.dropped and not self.freed:
            return robot
        joints = {
            name: dataclasses.replace(joint, mimic=None) if name in self.freed else joint
            for name, joint in robot.joints.items()
            if name not in self.dropped
        }
        return dataclasses.replace(robot, joints=joints)


def _shape(robot: Robot) -> _Shape:
    return frozenset(robot.links), tuple(
        (one.name, one.parent, one.child, one.mimic.joint if one.mimic else "")
        for one in robot.joints.values()
    )


def _held_joints(robot: Robot, findings: list[Finding]) -> dict[str, Joint]:
    """Return the joints that tie two links; of several with one child, the first."""
    held: dict[str, Joint] = {}
    holder: dict[str, str] = {}
    for joint in robot.joints.values():
        faults = _why_loose(robot, joint, holder)
        for code, sentence in faults:
            findings.append(_rejected(code, sentence, f"joint:{joint.name}"))
        if not faults:
            held[joint.name] = joint
            holder[joint.child] = joint.name
    return held


def _why_loose(robot: Robot, joint: Joint, holder: Mapping[str, str]) -> list[tuple[str, str]]:
    found: list[tuple[str, str]] = []
    for role, link in (("parent", joint.parent), ("child", joint.child)):
        if link not in robot.links:
            sentence = (
                f'Joint "{joint.name}" has the {role} "{link}", and no link has that name: '
                "the joint was left out; ROS rejects this."
            )
            found.append((f"dangling-{role}", sentence))
    if joint.child in holder and not found:
        sentence = (
            f'Joint "{joint.name}" has the child "{joint.child}", which joint '
            f'"{holder[joint.child]}" already holds: the joint was left out, '
            "since a link has one parent."
        )
        found.append(("second-parent", sentence))
    return found


def _report_cycles(
    robot: Robot, parents: Mapping[str, str], held: Mapping[str, Joint], findings: list[Finding]
) -> bool:
    """Find every link that no root leads to; True when there is one."""
    joint_of = {joint.child: joint.name for joint in held.values()}
    cycles = list(_cycles(robot.links, parents))
    for cycle in cycles:
        loop = " -> ".join((cycle[0], *reversed(cycle)))
        sentence = f"The joints form a cycle ({loop}): a robot is a tree, cut one of them."
        problem = Problem(Severity.ERROR, "cycle", sentence)
        findings.append((problem, f"joint:{joint_of[cycle[0]]}"))
    return bool(cycles)


def _cycles(links: Iterable[str], parents: Mapping[str, str]) -> Iterable[list[str]]:
    """Yield each cycle once, from child to parent."""
    done: set[str] = set()
    for start in links:
        path: dict[str, None] = {}
        link: str | None = start
        while link is not None and link not in done and link not in path:
            path[link] = None
            link = parents.get(link)
        if link is not None and link in path:
            names = list(path)
            yield names[names.index(link) :]
        done.update(path)


def _report_roots(robot: Robot, roots: list[str], findings: list[Finding]) -> None:
    if not robot.links:
        sentence = "The file describes no link: add at least one <link>."
        findings.append((Problem(Severity.ERROR, "no-links", sentence), ""))
    elif len(roots) > 1:
        shown = ", ".join(f'"{name}"' for name in roots[:5]) + (", ..." if roots[5:] else "")
        sentence = (
            f"{len(roots)} links have no parent ({shown}) and are drawn at the origin; "
            "ROS rejects this: tie all but one with a joint."
        )
        findings.append(_rejected("several-roots", sentence, f"link:{roots[1]}"))


def _unled(held: Mapping[str, Joint], findings: list[Finding]) -> frozenset[str]:
    """Joints that mimic a joint that is not there, or themselves in a round."""
    freed: set[str] = set()
    for joint in held.values():
        if joint.mimic is None:
            continue
        if joint.mimic.joint not in held:
            sentence = (
                f'Joint "{joint.name}" mimics "{joint.mimic.joint}", and no joint has that name: '
                "it moves by itself."
            )
        elif _leads_round(joint, held, freed):
            sentence = f'Joint "{joint.name}" mimics itself in a round: it moves by itself.'
        else:
            continue
        freed.add(joint.name)
        problem = Problem(Severity.WARNING, "bad-mimic", sentence)
        findings.append((problem, f"joint:{joint.name}"))
    return frozenset(freed)


def _leads_round(joint: Joint, held: Mapping[str, Joint], freed: set[str]) -> bool:
    seen = {joint.name}
    leader = held.get(joint.mimic.joint) if joint.mimic else None
    while leader is not None and leader.name not in freed:
        if leader.name in seen:
            return leader.name == joint.name
        seen.add(leader.name)
        leader = held.get(leader.mimic.joint) if leader.mimic else None
    return False


def _rejected(code: str, sentence: str, key: str) -> Finding:
    """Return what keeps ROS from loading the robot, even if it can be drawn."""
    return Problem(Severity.ERROR, code, sentence), key
