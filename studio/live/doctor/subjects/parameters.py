"""Parameters that were changed while somebody listened: a node no longer runs as launched."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import Looked, listed, short
from studio.protocol.doctor import Concern, Finding

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.live.doctor.seen import ChangedParameter, Seen, System
    from studio.protocol.doctor import SubjectName

SUBJECT: Final[SubjectName] = "parameters"
_EVENTS: Final = "/parameter_events"


def looked_at(seen: Seen) -> Looked | None:
    """Since when changes are heard."""
    if seen.heard is None or seen.system is None:
        return None
    publishers = seen.system.topics.get(_EVENTS)
    count = len(publishers.senders) if publishers else 0
    heard = seen.heard.parameters
    return Looked(count, f"changes of the last {heard.listened_s:.0f} s, since {heard.since}")


def findings(seen: Seen) -> Iterator[Finding]:
    """Find parameters that have another value than before."""
    if seen.heard is None or seen.system is None:
        return
    by_node: dict[str, list[ChangedParameter]] = defaultdict(list)
    for one in seen.heard.parameters.changed:
        by_node[one.node].append(one)
    for node, changed in by_node.items():
        if _still_runs(changed[0], seen.system):
            yield _of_node(node, changed, seen.heard.parameters.since)


def _still_runs(changed: ChangedParameter, system: System) -> bool:
    """Whether it is that node, and not one of the same name that was started later."""
    publishers = system.topics.get(_EVENTS)
    same = [one for one in publishers.senders if short(one.node.path) == changed.node] if (
        publishers
    ) else []  # fmt: skip
    return any(one.gid == changed.gid for one in same)


def _of_node(node: str, changed: list[ChangedParameter], since: str) -> Finding:
    names = listed(one.name for one in changed)
    is_start_known = all(one.started is not None for one in changed)
    return Finding(
        code="parameter-changed",
        level="note",
        subject=SUBJECT,
        sentence=(
            f"{node} runs with other parameters than it was started with ({names}): a restart "
            "brings back those."
            if is_start_known
            else f"Parameters of {node} were changed since {since} ({names}); what they were at "
            "its start was not heard."
        ),
        evidence=tuple(map(_change, changed[:10])),
        line=f"ros2 param dump {node}",
        about=(Concern(kind="parameter", name=node),),
    )


def _change(one: ChangedParameter) -> str:
    began = "" if one.started is None else f", and was {one.started} when it was declared"
    return f"{one.name} is now {one.value}{began}"
