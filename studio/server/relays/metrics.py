"""What a relay does, in the text form that Prometheus reads."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Protocol

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


_METRICS: Final[tuple[tuple[str, str, str, Callable[[Room], float]], ...]] = (
    ("origin_up", "gauge", "Whether the studio is there.", lambda one: one.is_there),
    ("people", "gauge", "Persons with an open page.", lambda one: one.people),
    ("pages", "gauge", "Open pages.", lambda one: one.pages),
    (
        "frames_total",
        "counter",
        "Frames that came from the studio, of all lanes.",
        lambda one: one.frame_count,
    ),
    (
        "received_bytes_total",
        "counter",
        "Bytes that came from the studio.",
        lambda one: one.received_bytes,
    ),
    (
        "sent_bytes_total",
        "counter",
        "Bytes that went to the studio.",
        lambda one: one.sent_bytes,
    ),
    (
        "refused_total",
        "counter",
        "Messages of the studio's line that were forged, sent again or out of order.",
        lambda one: one.refused,
    ),
    (
        "lag_seconds",
        "gauge",
        "Time from here to the studio and back.",
        lambda one: one.round_trip_s,
    ),
)
"""Name, kind, help, and the value of a room."""


def metrics(relay: Measured) -> str:
    """Return all metrics of a relay."""
    lines: list[str] = []
    for short, kind, told, value in _METRICS:
        name = f"studio_relay_{short}"
        lines += [f"# HELP {name} {told}", f"# TYPE {name} {kind}"]
        lines += [
            f'{name}{{room="{room.name}"}} {float(value(room))}' for room in relay.rooms.values()
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
