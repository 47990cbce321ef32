"""Topics that one side waits for, and whose name the other side may have meant."""

from __future__ import annotations

from collections import defaultdict
from difflib import get_close_matches
from typing import TYPE_CHECKING, Final, Literal

from studio.live.doctor.seen import Looked, listed, short, shown_nodes
from studio.protocol.doctor import Concern, Finding, Talk
from studio.ros.names import is_hidden

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from studio.live.doctor.seen import Ends, Seen, System
    from studio.protocol.doctor import SubjectName
    from studio.ros.graph.endpoints import GraphEndpoint

SUBJECT: Final[SubjectName] = "topics"
_LIKENESS: Final = 0.75
_COMPARED_MAX: Final = 200
"""Names compared with one another; more is no help, and takes its time."""
_SHOWN_MAX: Final = 3
_EVIDENCE_MAX: Final = 8
_OF_ROS: Final = frozenset({"/rosout", "/parameter_events", "/clock", "/tf", "/tf_static"})
"""Every node has these, or may; that one side is missing means nothing."""


def looked_at(seen: Seen) -> Looked | None:
    """The topics."""
    return Looked(len(seen.system.topics), "") if seen.system else None


def findings(seen: Seen) -> Iterator[Finding]:
    """Find topics with one side only."""
    if seen.system is None:
        return
    unheard, unsaid = _one_sided(seen.system)
    waited = {one: ends for one, ends in unsaid.items() if not _is_own(seen.system, ends)}
    meant = _meant(unheard, waited)
    for waiting, there in meant.items():
        yield _perhaps_meant(waiting, there, unsaid[waiting], unheard[there])
    for name in [one for one in unsaid if one not in waited]:
        yield _studio_waits(name, unsaid[name])
    yield from _by_node(
        {name: unsaid[name].receivers for name in waited if name not in meant}, "to"
    )
    taken = set(meant.values())
    yield from _by_node(
        {name: unheard[name].senders for name in unheard if name not in taken}, "by"
    )


def _one_sided(system: System) -> tuple[dict[str, Ends], dict[str, Ends]]:
    """Return topics that nobody subscribes, and those that nobody publishes."""
    unheard: dict[str, Ends] = {}
    unsaid: dict[str, Ends] = {}
    for name, ends in system.topics.items():
        if is_hidden(name) or name in _OF_ROS:
            continue
        if not ends.receivers and any(not system.is_own(one) for one in ends.senders):
            unheard[name] = ends
        elif not ends.senders and ends.receivers:
            unsaid[name] = ends
    return unheard, unsaid


def _is_own(system: System, ends: Ends) -> bool:
    return all(map(system.is_own, ends.receivers))


def _studio_waits(name: str, ends: Ends) -> Finding:
    return Finding(
        code="studio-waits",
        level="note",
        subject=SUBJECT,
        sentence=(
            f"A panel or a display of the studio waits for {short(name)}, which nobody publishes."
        ),
        evidence=(_counted(name, ends.senders, ends.receivers),),
        about=(_topic(name),),
        line=f"ros2 topic info -v {short(name)}",
    )


def _meant(unheard: Mapping[str, Ends], unsaid: Mapping[str, Ends]) -> dict[str, str]:
    """Return, by topics that nobody publishes, one of the same type that nobody hears."""
    by_type: dict[str, list[str]] = defaultdict(list)
    for name, ends in unheard.items():
        if len(by_type[ends.senders[0].type_name]) < _COMPARED_MAX:
            by_type[ends.senders[0].type_name].append(name)
    found: dict[str, str] = {}
    for name, ends in list(unsaid.items())[:_COMPARED_MAX]:
        alike = by_type.get(ends.receivers[0].type_name, [])
        same_end = [one for one in alike if _last(one) == _last(name)]
        near = same_end or get_close_matches(short(name), alike, 1, _LIKENESS)
        if near and near[0] not in found.values():
            found[name] = near[0]
    return found


def _last(name: str) -> str:
    return name.rpartition("/")[2]


def _perhaps_meant(waiting: str, there: str, wanting: Ends, offering: Ends) -> Finding:
    return Finding(
        code="perhaps-meant",
        level="warn",
        subject=SUBJECT,
        sentence=(
            f"{_who(wanting.receivers)} subscribes to {short(waiting)}, which nobody publishes, "
            f"and {_who(offering.senders)} publishes {short(there)}, which nobody hears: one name "
            "may be meant for the other."
        ),
        evidence=(f"both are {short(wanting.receivers[0].type_name)}",),
        line=f"ros2 run PACKAGE EXECUTABLE --ros-args -r {short(waiting)}:={short(there)}",
        about=(_topic(waiting), _topic(there)),
        talk=Talk(
            sources=shown_nodes(offering.senders),
            name=f"{short(there)} ≠ {short(waiting)}",
            targets=shown_nodes(wanting.receivers),
            meets=False,
        ),
    )


def _by_node(
    ends_by_topic: Mapping[str, tuple[GraphEndpoint, ...]], side: Literal["to", "by"]
) -> Iterator[Finding]:
    """One finding for each node and all its topics without the other side: mostly that is usual."""
    by_node: dict[str, list[str]] = defaultdict(list)
    for name, ends in ends_by_topic.items():
        by_node[_who(ends)].append(name)
    for who, names in by_node.items():
        node = ends_by_topic[names[0]][0].node.path
        evidence = tuple(
            _counted(name, (), ends_by_topic[name])
            if side == "to"
            else _counted(name, ends_by_topic[name], ())
            for name in names[:_EVIDENCE_MAX]
        )
        one_sided = _waiting if side == "to" else _unheard
        yield one_sided(who, names, node, evidence)


def _waiting(who: str, names: list[str], node: str, evidence: tuple[str, ...]) -> Finding:
    return Finding(
        code="no-publisher",
        level="note",
        subject=SUBJECT,
        sentence=f"{who} waits for {listed(names)}, which nobody publishes.",
        evidence=evidence,
        about=(*map(_topic, names[:_SHOWN_MAX]), Concern(kind="node", name=node)),
        talk=Talk(sources=(), name=listed(names, 2), targets=(short(node),), meets=False),
        line=f"ros2 topic info -v {short(names[0])}",
    )


def _unheard(who: str, names: list[str], node: str, evidence: tuple[str, ...]) -> Finding:
    return Finding(
        code="no-subscriber",
        level="note",
        subject=SUBJECT,
        sentence=f"{who} publishes {listed(names)}, which nobody subscribes to.",
        evidence=evidence,
        about=(*map(_topic, names[:_SHOWN_MAX]), Concern(kind="node", name=node)),
        talk=Talk(sources=(short(node),), name=listed(names, 2), targets=(), meets=False),
        line=f"ros2 topic info -v {short(names[0])}",
    )


def _counted(
    name: str, senders: tuple[GraphEndpoint, ...], receivers: tuple[GraphEndpoint, ...]
) -> str:
    type_name = (*senders, *receivers)[0].type_name
    return (
        f"{short(name)}: {short(type_name)}, publishers {len(senders)}, "
        f"subscriptions {len(receivers)}"
    )


def _who(ends: tuple[GraphEndpoint, ...]) -> str:
    paths = shown_nodes(ends)
    more = len({one.node.path for one in ends}) - 1
    return f"{paths[0]} and {more} more" if more else paths[0]


def _topic(name: str) -> Concern:
    return Concern(kind="topic", name=name)
