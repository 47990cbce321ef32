"""Types of topics and services: two of one name never meet, and what is unknown cannot be read."""

from __future__ import annotations

from collections import defaultdict
from functools import partial
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.errors import StudioError
from studio.live.doctor.seen import NAMED_MAX, Ends, Looked, Written, listed, short, shown_nodes
from studio.live.doctor.subjects.router import CONNECTION
from studio.protocol.displays import Mend
from studio.protocol.doctor import Concern, ConcernKind, Finding, Talk
from studio.ros.names import is_hidden
from studio.ros.profiles import HUMBLE

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.errors import InterfaceTextError
    from studio.live.doctor.seen import Seen, System
    from studio.protocol.doctor import SubjectName
    from studio.ros.graph.endpoints import GraphEndpoint, GraphNode
    from studio.ros.types.library import TypeLibrary

SUBJECT: Final[SubjectName] = "types"
_OLD: Final = HUMBLE.distro
"""The newest of the distributions whose nodes tell no hashes on DDS."""


def looked_at(seen: Seen) -> Looked | None:
    """The topics and services whose types were compared."""
    if seen.system is None:
        return None
    return Looked(len(seen.system.topics) + len(seen.system.services), "")


def findings(seen: Seen) -> Iterator[Finding]:
    """Find types that clash, that are not known, and whose text has a fault."""
    if seen.system is None:
        return
    system, written, unknown = seen.system, Written(), _Unknown(seen.system.types)
    for name, ends in system.topics.items():
        yield from _of_name(_Named(name, ends, "topic"), unknown, written)
    for name, ends in system.services.items():
        yield from _of_name(_Named(name, ends, "service"), unknown, written)
    for type_name, error in system.types.faults().items():
        yield _faulty_text(type_name, error)
    yield from _told_by_name(system)


def _faulty_text(type_name: str, error: InterfaceTextError) -> Finding:
    place = short(error.name) if error.line is None else f"{short(error.name)}, line {error.line}"
    return Finding(
        code="interface-text",
        level="warn",
        subject=SUBJECT,
        sentence=short(str(error), 500),
        evidence=(f"{short(type_name)} is not known because of {place}",),
        about=(Concern(kind="interface", name=type_name),),
    )


def _told_by_name(system: System) -> Iterator[Finding]:
    """Types of nodes on DDS that tell no hash at all, as before Iron: they are read as known here.

    Of services and actions hashes are missing everywhere, so that topics alone tell such a node.
    """
    by_node: dict[GraphNode, list[GraphEndpoint]] = defaultdict(list)
    for ends in system.topics.values():
        for one in (*ends.senders, *ends.receivers):
            if one.node.bridge and not is_hidden(one.name):
                by_node[one.node].append(one)
    by_name = [ends for ends in by_node.values() if not any(one.type_hash for one in ends)]
    topics: dict[str, GraphEndpoint] = {}
    for ends in by_name:
        for one in ends:
            topics.setdefault(one.type_name, one)
    if not topics:
        return
    differing = [one for name, one in topics.items() if _differs(system, name)]
    shown = differing or list(topics.values())
    who = listed(ends[0].node.path for ends in by_name)
    who += f" {'tells' if len(by_name) == 1 else 'tell'} types by name only, as nodes of {_OLD} do"
    here = system.profile.distro
    yield Finding(
        code="other-form" if differing else "by-name-only",
        level="warn" if differing else "note",
        subject=SUBJECT,
        sentence=(
            f"{who}, and {listed(one.type_name for one in differing)} of {_OLD} is another than of "
            f"{here}: it may be misread. Choose --distro {_OLD}, if the robot has that."
            if differing
            else f"{who}: they are read as {here} has them."
        ),
        evidence=tuple(
            f"{short(one.name)}: {short(one.type_name)} by name only" for one in shown[:8]
        ),
        mend=_speak_old(system) if differing else None,
        about=(CONNECTION, *(Concern(kind="topic", name=one.name) for one in shown[:3])),
    )


def _speak_old(system: System) -> Mend | None:
    """Return the click that speaks as they do; None: others are there that would not be heard."""
    if not all(one.bridge for one in system.others):
        return None
    command: dict[str, bool | int | float | str] = {"type": "connect_wire", "distro": _OLD}
    return Mend(label=f"Speak {_OLD}", command=command)


def _differs(system: System, type_name: str) -> bool:
    """Whether a type is another in the last distribution without hashes than in the one spoken."""
    forms = (system.form_of(_OLD, type_name), system.form_of(system.profile.distro, type_name))
    return None not in forms and forms[0] != forms[1]


class _Unknown:
    """Why types are not known, each looked up once."""

    def __init__(self, types: TypeLibrary) -> None:
        self._types = types
        self._why: dict[str, str] = {}

    def __call__(self, type_name: str) -> str:
        if type_name not in self._why:
            try:
                self._types.hash_of(type_name)
                self._why[type_name] = ""
            except StudioError as error:
                self._why[type_name] = str(error)
        return self._why[type_name]


class _Named(NamedTuple):
    """A topic or a service with its ends."""

    name: str
    ends: Ends
    kind: ConcernKind


def _of_name(named: _Named, unknown: _Unknown, written: Written) -> Iterator[Finding]:
    both = [*named.ends.senders, *named.ends.receivers]
    types = {one.type_name for one in both}
    if len(types) > 1:
        yield written("type", partial(_several_types, named, sorted(types)))
    for type_name in types:
        told = [one for one in both if one.type_name == type_name and one.type_hash]
        if len({one.type_hash for one in told}) > 1:
            yield written("hash", partial(_several_forms, named, told))
        if why := unknown(type_name):
            yield written("unknown-type", partial(_not_known, named, type_name, why))


def _several_types(named: _Named, types: list[str]) -> Finding:
    name = short(named.name)
    shown = ", ".join(map(short, types[:NAMED_MAX]))
    return Finding(
        code="type",
        level="error",
        subject=SUBJECT,
        sentence=f"{name} has {len(types)} types, {shown}: they never meet.",
        evidence=_evidence((*named.ends.senders, *named.ends.receivers)),
        about=(Concern(kind=named.kind, name=named.name),),
        talk=_talk(named),
        line=f"ros2 topic info -v {name}" if named.kind == "topic" else "",
    )


def _several_forms(named: _Named, same: list[GraphEndpoint]) -> Finding:
    type_name = same[0].type_name
    is_on_dds = all(one.node.bridge for one in same)
    # DDS compares names of types only.
    outcome = "which are misread on DDS" if is_on_dds else "which never meet"
    who = ", ".join(f"{short(one.node.path)} {one.type_hash[:15]}" for one in same[:NAMED_MAX])
    return Finding(
        code="hash",
        level="error",
        subject=SUBJECT,
        sentence=(f"{short(named.name)}: {short(type_name)} has several forms, {outcome} ({who})."),
        evidence=_evidence(same),
        about=(Concern(kind=named.kind, name=named.name),),
        talk=_talk(named),
    )


def _not_known(named: _Named, type_name: str, why: str) -> Finding:
    both = (*named.ends.senders, *named.ends.receivers)
    return Finding(
        code="unknown-type",
        level="warn",
        subject=SUBJECT,
        sentence=f"{short(named.name)}: {short(why, 400)}",
        evidence=_evidence(one for one in both if one.type_name == type_name),
        about=(
            Concern(kind=named.kind, name=named.name),
            Concern(kind="interface", name=type_name),
        ),
    )


def _evidence(ends: Iterable[GraphEndpoint]) -> tuple[str, ...]:
    lines = (
        f"{short(one.node.path)}: {short(one.type_name)} {one.type_hash[:15] or 'by name only'}"
        for one in ends
    )
    return tuple(dict.fromkeys(lines))[:8]


def _talk(named: _Named) -> Talk:
    sources, targets = shown_nodes(named.ends.senders), shown_nodes(named.ends.receivers)
    return Talk(sources=sources, name=short(named.name), targets=targets, meets=False)
