"""Services and actions: served twice, waited for in vain, or not answered."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import Looked, listed, short
from studio.live.doctor.subjects.nodes import duplicates, place_of
from studio.protocol.doctor import Concern, Finding, Talk
from studio.ros.graph.graph import goal_service
from studio.ros.names import is_hidden

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.live.doctor.seen import Ends, Seen, System, Unanswered
    from studio.protocol.doctor import SubjectName

SUBJECT: Final[SubjectName] = "services"
_GOAL: Final = goal_service("")


def looked_at(seen: Seen) -> Looked | None:
    """The services."""
    return Looked(len(seen.system.services), "") if seen.system else None


def findings(seen: Seen) -> Iterator[Finding]:
    """Find services that are not served once."""
    if seen.system is not None:
        twice = duplicates(seen.system)
        for name, ends in seen.system.services.items():
            yield from _served_twice(name, ends, twice)
            yield from _not_served(name, ends, seen.system)
    for one in seen.unanswered:
        what = "goal" if one.is_action else "call"
        yield Finding(
            code="not-answered",
            level="warn",
            subject=SUBJECT,
            sentence=(
                f"The last {what} of {short(one.name)} was not answered. {short(one.why, 300)}"
            ),
            evidence=(_who_serves(one, seen.system),),
            about=(Concern(kind="action" if one.is_action else "service", name=one.name),),
        )


def _who_serves(unanswered: Unanswered, system: System | None) -> str:
    name = goal_service(unanswered.name) if unanswered.is_action else unanswered.name
    ends = system.services.get(name) if system else None
    if ends is None or not ends.senders:
        return f"nobody serves {short(unanswered.name)} now"
    return f"{short(unanswered.name)} is served by {listed(one.node.path for one in ends.senders)}"


def _served_twice(name: str, ends: Ends, twice: dict[str, int]) -> Iterator[Finding]:
    servers = ends.senders
    if len(servers) < 2:
        return
    paths = [one.node.path for one in servers]
    # Reported once for nodes of one name, not for each of their services.
    if len(set(paths)) == 1 and paths[0] in twice:
        return
    shown = ", ".join(map(short, paths[:6]))
    yield Finding(
        code="two-servers",
        level="warn",
        subject=SUBJECT,
        sentence=f"{short(name)} is served {len(servers)} times, by {shown}: keep one.",
        evidence=tuple(
            f"{short(one.node.path)} {place_of(one.node)}: {short(one.type_name)}"
            for one in servers[:8]
        ),
        about=(Concern(kind="service", name=name),),
    )


def _not_served(name: str, ends: Ends, system: System) -> Iterator[Finding]:
    """A client waits; of an action one of its services stands for all."""
    waiting = [one for one in ends.receivers if not system.is_own(one)]
    is_action = name.endswith(_GOAL) and len(name) > len(_GOAL)
    if ends.senders or not waiting or (is_hidden(name) and not is_action):
        return
    plain = name.removesuffix(_GOAL) if is_action else name
    what = "action" if is_action else "service"
    who = listed(one.node.path for one in waiting)
    yield Finding(
        code="not-served",
        level="warn",
        subject=SUBJECT,
        sentence=f"{who} has a client of the {what} {short(plain)}, which nobody serves.",
        evidence=tuple(
            f"{short(one.node.path)} calls it as {short(one.type_name)}" for one in waiting[:8]
        ),
        about=(
            Concern(kind="node", name=waiting[0].node.path),
            Concern(kind="action" if is_action else "service", name=plain),
        ),
        talk=Talk(
            sources=(short(waiting[0].node.path),), name=short(plain), targets=(), meets=False
        ),
        line=f"ros2 {what} list",
    )
