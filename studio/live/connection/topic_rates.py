"""TopicRates: how often, how large and how old what others publish is, while somebody looks."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from studio.ros.node.topic_statistics import Flow, TopicStatistics
from studio.ros.tokens import EndpointKind

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.ros.node.context import Context

TOPICS_MAX: Final = 200
"""Heard at once; of those that are asked for beyond, nothing is known."""
KEPT_S: Final = 5.0
"""A topic is heard so long after somebody asked: whoever looks asks every second or so."""
BYTES_MAX: Final = 64_000_000
"""In a second, of all that are heard: the heaviest beyond it rest."""
_REST_S: Final = 8.0
_MEASURED_S: Final = 2.0
"""A topic is heard at least so long before it rests."""


@dataclass(slots=True)
class _Heard:
    """A topic that is heard, and how it came when that was asked last."""

    tally: TopicStatistics
    flow: Flow = field(default_factory=Flow)
    began_s: float = field(default_factory=time.monotonic)


@dataclass(frozen=True, slots=True)
class _Rest:
    """How a topic came that is not heard for a while, for it is heavy."""

    flow: Flow
    until_s: float


class TopicRates:
    """Hears topics for those who ask; all who ask for one topic share what is heard of it.

    Nothing is subscribed before the first question, nor for longer than `KEPT_S` after the last.
    Types need not be known, and no subscription is seen by others. Any thread may ask.
    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self._lock = threading.Lock()
        self._heard: dict[str, _Heard] = {}
        self._resting: dict[str, _Rest] = {}

    @property
    def heard(self) -> tuple[str, ...]:
        """Topics that are heard at this moment."""
        return tuple(name for name, one in tuple(self._heard.items()) if one.tally.is_open)

    def look(self, topics: Iterable[str]) -> dict[str, Flow]:
        """How these come; of one that nobody asked for before, nothing is known yet.

        Those that nobody publishes are left out, and those for which there is no room.
        """
        with self._lock:
            self._forget()
            flows = {name: flow for name in topics if (flow := self._flow(name)) is not None}
            self._spare()
            return flows

    def _forget(self) -> None:
        """Drop those that ended by themselves, and wake those that rested enough."""
        now_s = time.monotonic()
        self._heard = {name: one for name, one in self._heard.items() if one.tally.is_open}
        self._resting = {name: one for name, one in self._resting.items() if now_s < one.until_s}

    def _flow(self, topic: str) -> Flow | None:
        if rest := self._resting.get(topic):
            return rest.flow
        heard = self._heard.get(topic)
        if heard is None:
            if len(self._heard) >= TOPICS_MAX or not self._is_published(topic):
                return None
            heard = self._heard[topic] = _Heard(TopicStatistics(self._context, topic, KEPT_S))
        heard.flow = heard.tally.flow()
        return heard.flow

    def _is_published(self, topic: str) -> bool:
        """False of what is no name of a topic at all, such as one with wildcards."""
        return self._context.graph.count(EndpointKind.PUBLISHER, topic) > 0

    def _spare(self) -> None:
        """Let the heaviest rest while all together are too heavy."""
        now_s = time.monotonic()
        total = sum(one.flow.bytes_per_s for one in self._heard.values())
        heaviest = sorted(self._heard, key=lambda name: -self._heard[name].flow.bytes_per_s)
        for name in heaviest:
            if total <= BYTES_MAX:
                return
            one = self._heard[name]
            if now_s - one.began_s >= _MEASURED_S:
                total -= one.flow.bytes_per_s
                one.tally.close()
                self._resting[name] = _Rest(one.flow, now_s + _REST_S)
