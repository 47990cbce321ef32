"""What `ros2 bag play` can be told: what is played, from where to where, how fast, and so on."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from studio.nodes.bag_player.offers import Choice
from studio.ros.qos import QoSProfile

if TYPE_CHECKING:
    from collections.abc import Mapping

READ_AHEAD: Final = 1_000


@dataclass(frozen=True, slots=True)
class PlayOptions:
    """As the options of `ros2 bag play`; times in ns.

    Attributes:
        rate: Seconds of the recording in a second, above 0.
        delay_ns: Before each round.
        start_offset_ns: From the beginning of the recording.
        duration_ns: Of what is played; None: to the end.
        until_ns: Since the Unix epoch; of this and the duration the later one counts.
        read_ahead: How many messages are read before they are due.
        clock_hz: How often `/clock` is published; 0: not so.
        clock_topics: `/clock` is published before each message of these; empty: of all; None: not
            so.
        overrides: What is offered in place of what was recorded, by topic.
    """

    choice: Choice = field(default_factory=Choice)
    rate: float = 1.0
    is_looping: bool = False
    starts_paused: bool = False
    delay_ns: int = 0
    start_offset_ns: int = 0
    duration_ns: int | None = None
    until_ns: int | None = None
    read_ahead: int = READ_AHEAD
    clock_hz: float = 0.0
    clock_topics: tuple[str, ...] | None = None
    overrides: Mapping[str, QoSProfile] = field(default_factory=dict[str, QoSProfile])

    @property
    def publishes_clock(self) -> bool:
        """Whether the player tells the time."""
        return self.clock_hz > 0 or self.clock_topics is not None

    def end_ns(self, begin_ns: int) -> int | None:
        """Return the last time that is played; None: to the end of the recording."""
        given = [] if self.until_ns is None else [self.until_ns]
        if self.duration_ns is not None:
            given.append(begin_ns + self.duration_ns if self.duration_ns else 0)
        return max(given, default=None)
