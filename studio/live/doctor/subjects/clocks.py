"""Clocks: of machines that differ, and of nodes that go by simulated time while others do not."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import NAME_MAX, Looked, called, listed, short
from studio.live.doctor.subjects.nodes import place_of
from studio.protocol.displays import Mend
from studio.protocol.doctor import Concern, Finding

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.live.doctor.seen import Offset, Seen, System
    from studio.protocol.doctor import SubjectName

SUBJECT: Final[SubjectName] = "clocks"
_CLOCK: Final = "/clock"
_AHEAD_NS: Final = 20_000_000
"""A message that came so long before it was sent shows that a clock is ahead."""
_BEHIND_NS: Final = 500_000_000
"""The quickest of some messages should not take so long."""
_SAMPLES_MIN: Final = 3
_OWN_TOPICS: Final = frozenset({"/rosout", "/parameter_events", _CLOCK})


def looked_at(seen: Seen) -> Looked | None:
    """The processes whose samples came."""
    if seen.heard is None:
        return None
    clock = seen.heard.clock
    return Looked(len(seen.heard.offsets), f"/clock is {clock.now_ns / 1e9:.1f} s" if clock else "")


def findings(seen: Seen) -> Iterator[Finding]:
    """Find clocks that do not go together."""
    for one in seen.heard.offsets if seen.heard else ():
        yield from _of_offset(one)
    if seen.system is not None:
        yield from _of_simulated_time(seen.system)


def _is_off(offset: Offset) -> bool:
    enough = offset.samples >= _SAMPLES_MIN
    return offset.least_ns < -_AHEAD_NS or (enough and offset.least_ns > _BEHIND_NS)


def _of_offset(offset: Offset) -> Iterator[Finding]:
    if not _is_off(offset):
        return
    off_s = abs(offset.least_ns) / 1e9
    # Samples from DDS carry the time at which their bridge passed them on.
    who = f"the {called(offset.bridge)}" if offset.bridge else listed(offset.nodes)
    about = tuple(Concern(kind="node", name=one) for one in offset.nodes[:3])
    if offset.least_ns < 0:
        sentence = (
            f"The clock of the machine of {who} is at least {off_s:.3g} s ahead of this one: its "
            "messages come before they were sent. Set both by NTP."
        )
    else:
        sentence = (
            f"Messages of {who} come {off_s:.3g} s after they were sent: the clock of their "
            "machine is behind this one, or the network is that slow. Set both by NTP."
        )
    yield Finding(
        code="clock-ahead" if offset.least_ns < 0 else "clock-behind",
        level="error" if off_s > 1 else "warn",
        subject=SUBJECT,
        sentence=sentence,
        evidence=(
            f"the quickest of {offset.samples} samples came {offset.least_ns / 1e9:+.4f} s after "
            f"it was {'passed on' if offset.bridge else 'sent'}, by both clocks",
        ),
        line="timedatectl status",
        about=about,
    )


def set_simulated_time(system: System, node: str, *, value: bool) -> Mend | None:
    """Return the click that sets use_sim_time of a node; None: it takes no parameters."""
    ends = system.services.get(f"{node}/set_parameters")
    if ends is None or not ends.senders or len(node) > NAME_MAX:
        return None
    text = "true" if value else "false"
    command: dict[str, bool | int | float | str] = {
        "type": "set_parameter",
        "node": node,
        "name": "use_sim_time",
        "text": text,
    }
    return Mend(label=f"Set use_sim_time of {node} to {text}", command=command)


def _of_simulated_time(system: System) -> Iterator[Finding]:
    clock = system.topics.get(_CLOCK)
    # A node of rclcpp or rclpy subscribes to /clock exactly when its use_sim_time is true.
    simulated = (
        {one.node.path for one in clock.receivers if not system.is_own(one)}
        if clock
        else set[str]()
    )
    publishers = tuple(dict.fromkeys(one.node.path for one in clock.senders)) if clock else ()
    if simulated and not publishers:
        yield Finding(
            code="no-clock",
            level="error",
            subject=SUBJECT,
            sentence=(
                f"{listed(sorted(simulated))} {'goes' if len(simulated) == 1 else 'go'} by "
                "simulated time (use_sim_time), and nobody publishes /clock: their time stands "
                "still. Start the simulation, or set use_sim_time to false."
            ),
            evidence=(
                f"subscribers of /clock: {listed(sorted(simulated))}",
                "publishers of /clock: 0",
            ),
            mend=_first_mend(system, sorted(simulated), value=False),
            line=f"ros2 param set {short(min(simulated))} use_sim_time false",
            about=(
                Concern(kind="topic", name=_CLOCK),
                *(Concern(kind="parameter", name=one) for one in sorted(simulated)[:3]),
            ),
        )
    if clock and len(publishers) > 1:
        yield Finding(
            code="two-clocks",
            level="warn",
            subject=SUBJECT,
            sentence=f"/clock is published by {listed(publishers)}: time jumps between them.",
            evidence=tuple(
                f"{short(one.node.path)} {place_of(one.node)}" for one in clock.senders[:8]
            ),
            about=(Concern(kind="topic", name=_CLOCK),),
        )
    if publishers:
        yield from _mixed(system, simulated, set(publishers))


def _first_mend(system: System, nodes: list[str], *, value: bool) -> Mend | None:
    """One click for the first of some nodes; once it is mended, the next is offered."""
    mends = (set_simulated_time(system, one, value=value) for one in nodes)
    return next((one for one in mends if one is not None), None)


def _mixed(system: System, simulated: set[str], clocks: set[str]) -> Iterator[Finding]:
    """Nodes that publish data and do not go by the time that is published."""
    publishing = {
        one.node.path
        for name, ends in system.topics.items()
        if name not in _OWN_TOPICS
        for one in ends.senders
        if not system.is_own(one)
    }
    on_wall_time = sorted(publishing - simulated - clocks)
    if on_wall_time:
        yield Finding(
            code="time-mixed",
            level="warn",
            subject=SUBJECT,
            sentence=(
                f"/clock is published, and {listed(on_wall_time)} "
                f"{'does' if len(on_wall_time) == 1 else 'do'} not go by it: stamps of both kinds "
                "of time never fit together. Set use_sim_time to true."
            ),
            evidence=(f"by simulated time: {listed(sorted(simulated)) or 'no node'}",),
            mend=_first_mend(system, on_wall_time, value=True),
            line=f"ros2 param set {short(on_wall_time[0])} use_sim_time true",
            about=tuple(Concern(kind="node", name=one) for one in on_wall_time[:3]),
        )
