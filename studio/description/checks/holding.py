"""Joints that do not hold a link of their own, where exactly one link can have been meant."""

from __future__ import annotations

import re
from collections import Counter
from functools import cached_property
from typing import TYPE_CHECKING, Final, NamedTuple
from xml.sax.saxutils import escape, quoteattr

from studio.description.checks.element_mends import ElementMends
from studio.description.evaluator.output_tree import write_xml
from studio.description.faults import shorten
from studio.problems import Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.checks.checked_run import CheckedRun
    from studio.description.evaluator.output_tree import OutputElement
    from studio.problems import Fix, Problem

_OF_JOINTS: Final = frozenset(
    {
        *("origin", "parent", "child", "axis", "calibration", "dynamics", "limit", "mimic"),
        "safety_controller",
    }
)
"""A joint that holds something else may have its parent or child there, misspelt."""


class _Joint(NamedTuple):
    """A joint, and the names at its ends; empty where there is no such element."""

    element: OutputElement
    name: str
    parent: str
    child: str


class Holding:
    """Who holds whom in a run; of several joints with one child the first holds it."""

    def __init__(self, run: CheckedRun) -> None:
        self._run = run
        self._origins = Counter(element.origin for element in run.keys)
        own = [one for one, key in run.keys.items() if key == f"{one.tag}:{_name(one)}"]
        self.links = {_name(one): one for one in own if one.tag == "link"}
        self.joints = [
            _Joint(one, _name(one), _end(one, "parent"), _end(one, "child"))
            for one in own
            if one.tag == "joint"
        ]
        self._holders: dict[str, _Joint] = {}
        self._known_roots: dict[str, str] = {}
        """Of links that were asked for: long chains are walked once."""
        self.second: list[_Joint] = []
        for joint in self.joints:
            if joint.parent in self.links and joint.child in self.links:
                first = self._holders.setdefault(joint.child, joint)
                self.second += [joint] if first is not joint else []

    def problems(self) -> Iterator[Problem]:
        """What one edit mends for certain, in the words of the robot's check."""
        if len(self.second) == 1:
            yield from self._second_parent(self.second[0])
        lacking = [one for one in self.joints if not (one.parent and one.child)]
        if len(lacking) == 1:
            yield from self._lacking_end(lacking[0])

    def only_parent(self, child: str) -> str:
        """The one link that a joint with this child can have as its parent; empty: not one."""
        if child not in self.links or child in self._holders:
            return ""
        return _only([name for name in self.links if self._root(name) != child])

    def _only_child(self, parent: str) -> str:
        root = self._root(parent)
        return _only([name for name in self._roots if name != root]) if root else ""

    @cached_property
    def _roots(self) -> list[str]:
        return [name for name in self.links if name not in self._holders]

    def _root(self, link: str) -> str:
        """The link above all; empty in a round."""
        seen: set[str] = set()
        while link not in self._known_roots and link not in seen and link in self._holders:
            seen.add(link)
            link = self._holders[link].parent
        root = self._known_roots.get(link, "" if link in seen else link)
        self._known_roots |= dict.fromkeys(seen, root)
        return root

    def _second_parent(self, joint: _Joint) -> Iterator[Problem]:
        first = self._holders[joint.child]
        meant = self._only_child(joint.parent)
        if fix := self._other_child(joint, meant) if meant else self._taken_out(joint, first):
            sentence = (
                f'Joint "{joint.name}" has the child "{joint.child}", which joint "{first.name}" '
                "already holds: the joint was left out, since a link has one parent"
            )
            advice = f': did you mean "{meant}"?' if meant else "; both say the same."
            yield self._problem("second-parent", sentence + advice, joint, fix)

    def _other_child(self, joint: _Joint, meant: str) -> Fix | None:
        end = next(one for one in joint.element.elements() if one.tag == "child")
        if not self._is_alone(joint):
            return None
        mends = ElementMends(end.origin)
        return mends.fix(f'Write "{meant}"', mends.value("link", meant))

    def _taken_out(self, joint: _Joint, first: _Joint) -> Fix | None:
        """Where it says all that the first says, and nothing else names it."""
        if not self._is_alone(joint) or _said(joint) != _said(first):
            return None
        named = re.findall(
            rf"(?<!\w){re.escape(escape(joint.name))}(?!\w)", write_xml(self._run.root)
        )
        if len(named) != 1:
            return None
        mends = ElementMends(joint.element.origin)
        return mends.fix(f'Remove joint "{joint.name}"', mends.gone())

    def _lacking_end(self, joint: _Joint) -> Iterator[Problem]:
        tags = [one.tag for one in joint.element.elements()]
        role = "child" if joint.parent else "parent"
        if role in tags or not (joint.parent or joint.child) or not _OF_JOINTS.issuperset(tags):
            return
        meant = self._only_child(joint.parent) if joint.parent else self.only_parent(joint.child)
        there = next(one for one in joint.element.elements() if one.tag in {"parent", "child"})
        is_inside = there.origin in set(joint.element.origin.elements())
        if not meant or not is_inside or not self._is_alone(joint):
            return
        mends = ElementMends(there.origin)
        xml = f"<{role} link={quoteattr(meant)}/>"
        edit = mends.before(xml) if role == "parent" else mends.after(xml)
        sentence = f'joint "{joint.name}" has no <{role}>: write one.'
        fix = mends.fix(f'Write {role} "{meant}"', edit)
        yield self._problem("bad-element", sentence, joint, fix)

    def _is_alone(self, joint: _Joint) -> bool:
        """No macro writes it, with other names perhaps at its next call."""
        element = joint.element
        return element.calls is None and self._origins[element.origin] == 1

    def _problem(self, code: str, sentence: str, joint: _Joint, fix: Fix | None) -> Problem:
        parts = (self._run.keys[joint.element],)
        short = shorten(sentence, 480)
        return self._run.problem(Severity.ERROR, code, short, joint.element, fix, parts)


def _name(element: OutputElement) -> str:
    return element.attributes.get("name", "")


def _end(joint: OutputElement, role: str) -> str:
    end = next((one for one in joint.elements() if one.tag == role), None)
    return end.attributes.get("link", "") if end is not None else ""


def _only(names: list[str]) -> str:
    return names[0] if len(names) == 1 else ""


def _said(joint: _Joint) -> tuple[str | None, list[str]]:
    """All of a joint but its name."""
    element = joint.element
    return element.attributes.get("type"), [write_xml(one) for one in element.elements()]
