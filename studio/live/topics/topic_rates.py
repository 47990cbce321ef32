"""TopicRates: rates, sizes and ages of the messages of topics, measured while asked for."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.ros.node.topic_statistics import Flow

TOPICS_MAX: Final = 200
"""Measured at once; of those that are asked for beyond, nothing is known."""
KEPT_S: Final = 5.0
"""So long a topic is measured after a request: users ask every second or so."""
BYTES_MAX: Final = 64_000_000
"""Limit per second of all topics together: beyond it the heaviest pause."""
_REST_S: Final = 8.0
_MEASURED_S: Final = 2.0
"""A topic is measured at least so long before it rests."""


class Meter(Protocol):
    """Counts the messages of a topic of any type, and ends once nobody asks."""

    @property
    def is_open(self) -> bool:
        """Whether it still counts."""
        ...

    def flow(self) -> Flow:
        """Return what comes; it goes on counting for a while."""
        ...

    def close(self) -> None:
        """Count no more; again is harmless."""
        ...


@dataclass(slots=True)
class _Measured:
    """A topic that is measured, and how it came when that was asked last."""

    meter: Meter
    flow: Flow
    began_s: float = field(default_factory=time.monotonic)


@dataclass(frozen=True, slots=True)
class _Rest:
    """The last flow of a topic whose measuring pauses because it is heavy."""

    flow: Flow
    until_s: float


class TopicRates:
    """Measures topics on request; requests for the same topic share one meter.

    Nothing is measured before the first request, nor for longer than `KEPT_S` after the last.
    Thread-safe.

    Args:
        measure: Starts to count a topic, until nobody asked for so many seconds; returns None if
            the source has ended or nobody publishes it.
        bytes_max: Limit per second of all topics together; None: `BYTES_MAX`.
    """

    def __init__(
        self, measure: Callable[[str, float], Meter | None], bytes_max: int | None = None
    ) -> None:
        self._measure, self._bytes_max = measure, bytes_max
        self._lock = threading.Lock()
        self._measured: dict[str, _Measured] = {}
        self._resting: dict[str, _Rest] = {}

    @property
    def measured(self) -> tuple[str, ...]:
        """Topics that are measured at this moment."""
        return tuple(name for name, one in tuple(self._measured.items()) if one.meter.is_open)

    def flows(self, topics: Iterable[str]) -> dict[str, Flow]:
        """Return the flows of topics; one asked for the first time has nothing measured yet.

        Topics that nobody publishes are left out, and those beyond the limits.
        """
        with self._lock:
            self._forget()
            flows = {name: flow for name in topics if (flow := self._flow(name)) is not None}
            self._spare()
            return flows

    def clear(self) -> None:
        """Measure nothing, and forget what was measured: it is of another connection."""
        with self._lock:
            measured, self._measured = self._measured, {}
            self._resting.clear()
            for one in measured.values():
                one.meter.close()

    def _forget(self) -> None:
        """Drop those that ended by themselves, and wake those that rested enough."""
        now_s = time.monotonic()
        self._measured = {name: one for name, one in self._measured.items() if one.meter.is_open}
        self._resting = {name: one for name, one in self._resting.items() if now_s < one.until_s}

    def _flow(self, topic: str) -> Flow | None:
        if rest := self._resting.get(topic):
            return rest.flow
        measured = self._measured.get(topic)
        if measured is not None:
            measured.flow = measured.meter.flow()
        elif len(self._measured) < TOPICS_MAX and (meter := self._measure(topic, KEPT_S)):
            measured = self._measured[topic] = _Measured(meter, meter.flow())
        return measured and measured.flow

    def _spare(self) -> None:
        """Let the heaviest rest while all together are too heavy."""
        now_s = time.monotonic()
        bytes_max = BYTES_MAX if self._bytes_max is None else self._bytes_max
        total = sum(one.flow.bytes_per_s for one in self._measured.values())
        heaviest = sorted(self._measured, key=lambda name: -self._measured[name].flow.bytes_per_s)
        for name in heaviest:
            if total <= bytes_max:
                return
            one = self._measured[name]
            # Of one that is too new to rest, lighter ones are not to blame.
            total -= one.flow.bytes_per_s
            if now_s - one.began_s >= _MEASURED_S:
                one.meter.close()
                self._resting[name] = _Rest(one.flow, now_s + _REST_S)
