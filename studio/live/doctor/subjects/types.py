"""Types of topics and services: two of one name never meet, and what is unknown cannot be read."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.errors import StudioError
from studio.live.doctor.seen import NAMED_MAX, Ends, Looked, Written, short, shown_nodes
from studio.protocol.doctor import Concern, ConcernKind, Finding, Talk

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.errors import InterfaceTextError
    from studio.live.doctor.seen import Seen
    from studio.protocol.doctor import SubjectName
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.types.library import TypeLibrary

SUBJECT: Final[SubjectName] = "types"


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
        if len({one.type_hash for one in both if one.type_name == type_name}) > 1:
            yield written("hash", partial(_several_forms, named, type_name))
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


def _several_forms(named: _Named, type_name: str) -> Finding:
    both = (*named.ends.senders, *named.ends.receivers)
    same = [one for one in both if one.type_name == type_name]
    who = ", ".join(f"{short(one.node.path)} {one.type_hash[:15]}" for one in same[:NAMED_MAX])
    return Finding(
        code="hash",
        level="error",
        subject=SUBJECT,
        sentence=(
            f"{short(named.name)}: {short(type_name)} has several forms, which never meet ({who})."
        ),
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
    lines = (f"{short(one.node.path)}: {short(one.type_name)} {one.type_hash[:15]}" for one in ends)
    return tuple(dict.fromkeys(lines))[:8]


def _talk(named: _Named) -> Talk:
    sources, targets = shown_nodes(named.ends.senders), shown_nodes(named.ends.receivers)
    return Talk(sources=sources, name=short(named.name), targets=targets, meets=False)
