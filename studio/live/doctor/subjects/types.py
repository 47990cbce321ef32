"""Types of topics and services: two of one name never meet, and what is unknown cannot be read."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, Final

from studio.errors import StudioError
from studio.live.doctor.seen import NAMED_MAX, Looked, short
from studio.protocol.doctor import Concern, Finding, Talk

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.live.doctor.seen import Ends, Seen
    from studio.protocol.doctor import ConcernKind, SubjectName
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
    system, unknown = seen.system, _Unknown(seen.system.types)
    for name, ends in system.topics.items():
        yield from _of_name(name, ends, "topic", unknown)
    for name, ends in system.services.items():
        yield from _of_name(name, ends, "service", unknown)
    for error in system.types.faults().values():
        yield Finding(
            code="interface-text", level="warn", subject=SUBJECT, sentence=short(str(error), 500)
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


def _of_name(name: str, ends: Ends, kind: ConcernKind, unknown: _Unknown) -> Iterator[Finding]:
    both = [*ends.senders, *ends.receivers]
    about = (Concern(kind=kind, name=name),)
    names = sorted({one.type_name for one in both})
    if len(names) > 1:
        yield Finding(
            code="type",
            level="error",
            subject=SUBJECT,
            sentence=(
                f"{short(name)} has {len(names)} types, "
                f"{', '.join(map(short, names[:NAMED_MAX]))}: they never meet."
            ),
            evidence=_evidence(both),
            about=about,
            talk=_talk(name, ends),
            line=f"ros2 {kind} info -v {short(name)}" if kind == "topic" else "",
        )
    ordered = sorted(both, key=lambda end: end.type_name) if len(names) > 1 else both
    for type_name, same in groupby(ordered, key=lambda end: end.type_name):
        yield from _of_hashes(name, type_name, list(same), ends, about)
        if why := unknown(type_name):
            yield Finding(
                code="unknown-type",
                level="warn",
                subject=SUBJECT,
                sentence=f"{short(name)}: {short(why, 400)}",
                about=about,
            )


def _of_hashes(
    name: str,
    type_name: str,
    same: list[GraphEndpoint],
    ends: Ends,
    about: tuple[Concern, ...],
) -> Iterator[Finding]:
    if len({one.type_hash for one in same}) < 2:
        return
    who = ", ".join(f"{short(one.node.path)} {one.type_hash[:15]}" for one in same[:NAMED_MAX])
    yield Finding(
        code="hash",
        level="error",
        subject=SUBJECT,
        sentence=f"{short(name)}: {short(type_name)} has several forms, which never meet ({who}).",
        evidence=_evidence(same),
        about=about,
        talk=_talk(name, ends),
    )


def _evidence(ends: Iterable[GraphEndpoint]) -> tuple[str, ...]:
    lines = (f"{short(one.node.path)}: {short(one.type_name)} {one.type_hash[:15]}" for one in ends)
    return tuple(dict.fromkeys(lines))[:8]


def _talk(name: str, ends: Ends) -> Talk:
    def paths(some: tuple[GraphEndpoint, ...]) -> tuple[str, ...]:
        return tuple(dict.fromkeys(short(one.node.path) for one in some))[:NAMED_MAX]

    return Talk(
        sources=paths(ends.senders), name=short(name), targets=paths(ends.receivers), meets=False
    )
