"""ClockWatch: notices when the time on /clock begins again, as of a simulation or a bag."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.errors import CdrError
from studio.live.topics.request import Request
from studio.ros.cdr import codec_of
from studio.ros.duration import NANOSECONDS
from studio.ros.messages import shared_types

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.node.samples import RawSample

_TYPE: Final = "rosgraph_msgs/msg/Clock"
CLOCK: Final = Request(
    "/clock", (_TYPE,), newest_only=True, latched=False, usually=(False, False), as_known_here=True
)
_JITTER_NS: Final = 100_000_000
"""A publisher with several threads may send times that much out of order."""
_PUBLISHERS_MAX: Final = 16


class ClockWatch:
    """Takes the messages of /clock, in one thread, and notices when time jumps back.

    Each publisher is compared with itself: two that publish different times do not jump.

    Args:
        jumped: Called with the new time and the one before, ns, when time went back.
    """

    def __init__(self, jumped: Callable[[int, int], None]) -> None:
        self._jumped = jumped
        self._codec = codec_of(shared_types().message(_TYPE))
        self._last_ns: dict[bytes, int] = {}
        self.now_ns: int | None = None
        """The time that came last; None: none came yet. Written by the thread of `take`."""

    def take(self, sample: RawSample) -> None:
        """Take one message; what is none is left out."""
        try:
            clock = self._codec.decode(sample.payload).clock
        except CdrError:
            return
        now_ns = clock.sec * NANOSECONDS + clock.nanosec
        gid = sample.attachment.gid
        before_ns = self._last_ns.pop(gid, now_ns)
        if len(self._last_ns) >= _PUBLISHERS_MAX:
            del self._last_ns[next(iter(self._last_ns))]
        if now_ns < before_ns - _JITTER_NS:
            self._jumped(now_ns, before_ns)
        elif now_ns < before_ns:
            now_ns = before_ns
        self._last_ns[gid] = self.now_ns = now_ns
