"""What a relay does, in the text form that Prometheus reads."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from studio.server.relays.room import Room


class Crowded(Protocol):
    """The connections of browsers."""

    sent_bytes: int


class Measured(Protocol):
    """A relay."""

    @property
    def rooms(self) -> Mapping[str, Room]:
        """By name."""
        ...

    @property
    def crowd(self) -> Crowded | None:
        """Of all rooms."""
        ...


class _Metric(NamedTuple):
    name: str
    kind: str
    help: str
    value: Callable[[Room], float]


_METRICS: Final = (
    _Metric("origin_up", "gauge", "Whether the studio is there.", lambda one: one.is_there),
    _Metric("people", "gauge", "Persons with an open page.", lambda one: one.people),
    _Metric("pages", "gauge", "Open pages.", lambda one: one.pages),
    _Metric(
        "frames_total",
        "counter",
        "Frames that came from the studio, of all lanes.",
        lambda one: one.frame_count,
    ),
    _Metric(
        "received_bytes_total",
        "counter",
        "Bytes that came from the studio.",
        lambda one: one.received_bytes,
    ),
    _Metric(
        "sent_bytes_total",
        "counter",
        "Bytes that went to the studio.",
        lambda one: one.sent_bytes,
    ),
    _Metric(
        "refused_total",
        "counter",
        "Messages of the studio's line that were forged, sent again or out of order.",
        lambda one: one.refused,
    ),
    _Metric(
        "lag_seconds",
        "gauge",
        "Time from here to the studio and back.",
        lambda one: one.round_trip_s,
    ),
)


def metrics(relay: Measured) -> str:
    """Return all metrics of a relay."""
    lines: list[str] = []
    for one in _METRICS:
        name = f"studio_relay_{one.name}"
        lines += [f"# HELP {name} {one.help}", f"# TYPE {name} {one.kind}"]
        lines += [
            f'{name}{{room="{room.name}"}} {float(one.value(room))}'
            for room in relay.rooms.values()
        ]
    browsers = relay.crowd.sent_bytes if relay.crowd else 0
    name = "studio_relay_browser_bytes_total"
    lines += [
        f"# HELP {name} Bytes that went to browsers by websockets, of all rooms.",
        f"# TYPE {name} counter",
        f"{name} {browsers}",
        "# HELP studio_relay_rooms Rooms that this relay knows.",
        "# TYPE studio_relay_rooms gauge",
        f"studio_relay_rooms {len(relay.rooms)}",
    ]
    return "\n".join(lines) + "\n"
