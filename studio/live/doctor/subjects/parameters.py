"""Parameters that were changed while the Doctor listened: it no longer runs as launched."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import Looked, short
from studio.protocol.doctor import Concern, Finding

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.live.doctor.seen import ChangedParameter, Seen
    from studio.protocol.doctor import SubjectName

SUBJECT: Final[SubjectName] = "parameters"


def looked_at(seen: Seen) -> Looked | None:
    """Since when changes are heard."""
    if seen.heard is None or seen.system is None:
        return None
    publishers = seen.system.topics.get("/parameter_events")
    count = len(publishers.senders) if publishers else 0
    return Looked(count, f"changes of the last {seen.heard.listened_s:.0f} s")


def findings(seen: Seen) -> Iterator[Finding]:
    """Find parameters that have another value than before."""
    by_node: dict[str, list[ChangedParameter]] = defaultdict(list)
    for one in seen.heard.parameters if seen.heard else ():
        by_node[one.node].append(one)
    for node, changed in by_node.items():
        names = ", ".join(one.name for one in changed[:6])
        yield Finding(
            code="parameter-changed",
            level="note",
            subject=SUBJECT,
            sentence=(
                f"{node} runs with changed parameters ({names}): a restart brings back those that "
                "it was started with."
            ),
            evidence=tuple(f"{one.name} is now {one.value}" for one in changed[:10]),
            line=f"ros2 param dump {short(node)}",
            about=(Concern(kind="parameter", name=node),),
        )
