"""Ties of links by joints: ends that name no link, links that no joint holds, and fixes."""

from __future__ import annotations

import re
from collections import Counter
from difflib import get_close_matches
from functools import cached_property
from html import escape
from itertools import islice
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.description.evaluator.output_tree import write_xml
from studio.description.faults import shorten
from studio.description.syntax.attribute_spans import quoted
from studio.description.syntax.mends import ElementMends
from studio.problems import Severity

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from studio.description.checks.checked_run import CheckedRun
    from studio.description.evaluator.output_tree import OutputElement
    from studio.description.syntax.source_tree import SourceElement
    from studio.problems import Fix, Problem, Replacement

_OF_JOINTS: Final = frozenset(
    {
        *("origin", "parent", "child", "axis", "calibration", "dynamics", "limit", "mimic"),
        "safety_controller",
    }
)
"""A joint that holds something else may have its parent or child there, misspelt."""
_LIKENESS: Final = 0.7
_NAMES_MAX: Final = 2_000
_FOUND_LIMIT: Final = 100
_SHOWN: Final = 5
_BASE: Final = "base_link"
_SEPARATORS: Final = re.compile(r"[\s_-]+")


def loose_ties(run: CheckedRun) -> Iterator[Problem]:
    """Yield what is wrong with the ties: one finding for each fact."""
    links = {name: one for one in run.keys if one.tag == "link" and (name := _name(one))}
    ties = [tie for one in run.keys if one.tag == "joint" for tie in _ties(one)]
    named = {tie.link for tie in ties}
    dangling = [tie for tie in ties if tie.link not in links]
    holding = Holding(run) if dangling else None
    for tie in dangling[:_FOUND_LIMIT]:
        yield _dangling(run, tie, links, named, holding)
    if not dangling:
        yield from _several_roots(run, links, ties)


class _Joint(NamedTuple):
    """A joint, and the names at its ends; empty where there is no such element."""

    element: OutputElement
    name: str
    parent: str
    child: str


class Holding:
    """The joint and parent of each link; of several joints with one child the first counts."""

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
        """Yield what one edit certainly mends, worded as in the robot's check."""
        if len(self.second) == 1:
            yield from self._second_parent(self.second[0])
        lacking = [one for one in self.joints if not (one.parent and one.child)]
        if len(lacking) == 1:
            yield from self._lacking_end(lacking[0])

    def only_parent(self, child: str) -> str:
        """Return the one possible parent of a joint with this child; empty: not one."""
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
        """Return the link above all; empty in a round."""
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
        """Return a fix that removes a joint that repeats the first and is not used by name."""
        if not self._is_alone(joint) or _content(joint) != _content(first):
            return None
        named = re.findall(
            rf"(?<!\w){re.escape(escape(joint.name, quote=False))}(?!\w)", write_xml(self._run.root)
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
        xml = f"<{role} link={quoted(meant)}/>"
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


def _content(joint: _Joint) -> tuple[str | None, list[str]]:
    """Return all of a joint but its name."""
    element = joint.element
    return element.attributes.get("type"), [write_xml(one) for one in element.elements()]


class _Tie(NamedTuple):
    """A joint and the element in it that names its parent or its child."""

    joint: OutputElement
    end: OutputElement
    role: str
    link: str


def _ties(joint: OutputElement) -> Iterator[_Tie]:
    for role in ("parent", "child"):
        end = next((one for one in joint.elements() if one.tag == role), None)
        if end is not None and (link := end.attributes.get("link")):
            yield _Tie(joint, end, role, link)


def _dangling(
    run: CheckedRun,
    tie: _Tie,
    links: dict[str, OutputElement],
    named: set[str],
    holding: Holding | None,
) -> Problem:
    """A joint names a link that is not there: another name was meant, or the link is missing."""
    meant = _meant(tie.link, links)
    fix = _spelling_fix(tie, meant, links, named)
    if not meant:
        fix, meant = _link_fix(tie), ""
        if tie.role == "parent" and holding and (only := holding.only_parent(_child(tie))):
            fix, meant = _parent_fix(tie, only), only
    advice = f'did you mean "{meant}"?' if meant else "add the link, or name one that is there."
    sentence = (
        f'Joint "{_name(tie.joint)}" has the {tie.role} "{tie.link}", and no link has that name: '
        f"the joint was left out; {advice}"
    )
    return run.problem(
        Severity.ERROR,
        f"dangling-{tie.role}",
        shorten(sentence, 480),
        tie.end,
        fix,
        (run.keys[tie.joint],),
    )


def _meant(name: str, links: dict[str, OutputElement]) -> str:
    """Return the link with nearly this name; blanks, dashes and underscores are the same."""
    plain = _SEPARATORS.sub("_", name.strip())
    for link in links:
        if _SEPARATORS.sub("_", link.strip()) == plain:
            return link
    near = get_close_matches(name, islice(links, _NAMES_MAX), 1, _LIKENESS)
    return near[0] if near else ""


def _spelling_fix(
    tie: _Tie, meant: str, links: dict[str, OutputElement], named: set[str]
) -> Fix | None:
    """Make both names the same: the joint's, or the link's when nothing can mean that one."""
    if not meant:
        return None
    link = ElementMends(links[meant].origin)
    if re.search(r"\s", meant) and meant not in named and link.written("name") == meant:
        return link.fix(f'Rename the link to "{tie.link}"', link.value("name", tie.link))
    end = ElementMends(tie.end.origin)
    return end.fix(f'Write "{meant}"', end.value("link", meant))


def _child(tie: _Tie) -> str:
    return next((one.link for one in _ties(tie.joint) if one.role == "child"), "")


def _parent_fix(tie: _Tie, only: str) -> Fix | None:
    """Name the only link that can hold the child."""
    if tie.joint.calls is not None:
        return None
    end = ElementMends(tie.end.origin)
    return end.fix(f'Write "{only}"', end.value("link", only))


def _link_fix(tie: _Tie) -> Fix | None:
    """Add the link before its joint, by the name as it is written there."""
    if tie.role == "parent" or "link" not in tie.end.origin.attributes:
        return None
    written = tie.end.origin.attributes["link"]
    mends = ElementMends(tie.joint.origin)
    return mends.fix(f'Add the link "{tie.link}"', mends.before(f"<link name={quoted(written)}/>"))


def _several_roots(
    run: CheckedRun, links: dict[str, OutputElement], ties: Sequence[_Tie]
) -> Iterator[Problem]:
    held = {tie.link for tie in ties if tie.role == "child"}
    roots = [name for name in links if name not in held]
    if len(roots) < 2:
        return
    shown = ", ".join(f'"{name}"' for name in roots[:_SHOWN]) + (", ..." if roots[_SHOWN:] else "")
    makers = Counter(one.calls.macro for name in roots if (one := links[name]).calls)
    maker, count = makers.most_common(1)[0] if makers else ("", 0)
    advice = (
        f'the macro "{maker}" makes {count} of them and no joint: write one into it.'
        if count > 1
        else "tie all but one with a joint."
    )
    sentence = (
        f"{len(roots)} links have no parent ({shown}) and are drawn at the origin; "
        f"ROS rejects this: {advice}"
    )
    yield run.problem(
        Severity.ERROR,
        "several-roots",
        shorten(sentence, 480),
        links[roots[1]],
        _fix_of_roots(run, links, roots, ties),
        tuple(run.keys[links[name]] for name in roots[:_FOUND_LIMIT]),
    )


def _fix_of_roots(
    run: CheckedRun,
    links: dict[str, OutputElement],
    roots: Sequence[str],
    ties: Sequence[_Tie],
) -> Fix | None:
    """Hold all roots by fixed joints at the root that carries most, or at a new one.

    A link that a macro writes gets its joint in that macro, so that no call of it lacks one.
    """
    origins = {links[name].origin: name for name in roots}
    if len(roots) > _FOUND_LIMIT:
        return None
    alone = [n for n in roots if sum(links[o].origin is links[n].origin for o in roots) == 1]
    carried = Counter(tie.link for tie in ties if tie.role == "parent")
    base = max(alone, key=lambda name: carried[name], default="")
    edits = [_held(one, base or _BASE) for one, name in origins.items() if name != base]
    first = next(iter(run.root.origin.elements()), None)
    if not base:
        if _BASE in links or first is None:
            return None
        edits.append(ElementMends(first).before(f'<link name="{_BASE}"/>'))
    return ElementMends(run.root.origin).fix(f'Tie them to "{base or _BASE}"', *edits)


def _held(link: SourceElement, base: str) -> Replacement | None:
    """Return a fixed joint behind a link, by the name as it is written there."""
    name = link.attributes.get("name")
    if name is None:
        return None
    xml = (
        f'<joint name={quoted(f"{name}_joint")} type="fixed"><parent link={quoted(base)}/>'
        f"<child link={quoted(name)}/></joint>"
    )
    return ElementMends(link).after(xml)


WHY: Final = {
    "second-parent": {
        "en": "A link hangs on one joint only; URDF has no closed chains. Close a loop in the "
        "simulator's own format instead.",
        "de": "Ein Link hängt an genau einem Gelenk; URDF kennt keine geschlossenen Ketten. "
        "Schließen Sie eine Schleife stattdessen im Format des Simulators.",
    },
    "bad-element": {
        "en": "Something that the element needs is missing or is no number, so it could not be "
        "taken over.",
        "de": "Etwas, das das Element braucht, fehlt oder ist keine Zahl; es konnte nicht "
        "übernommen werden.",
    },
    "dangling-child": {
        "en": "The joint names a child link that does not exist: a typo, or a link that is made "
        "only with other arguments.",
        "de": "Das Gelenk nennt ein Kind (child), das es nicht gibt: ein Tippfehler, oder der "
        "Link entsteht nur mit anderen Argumenten.",
    },
    "dangling-parent": {
        "en": "The joint names a parent link that does not exist: a typo, or a link that is made "
        "only with other arguments.",
        "de": "Das Gelenk nennt ein Elternteil (parent), das es nicht gibt: ein Tippfehler, "
        "oder der Link entsteht nur mit anderen Argumenten.",
    },
    "several-roots": {
        "en": "A robot is one tree: exactly one link has no joint above it. Every other root is a "
        "part that hangs on nothing.",
        "de": "Ein Roboter ist ein Baum: Genau ein Link hat kein Gelenk über sich. Jede weitere "
        "Wurzel ist ein Teil, das an nichts hängt.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
