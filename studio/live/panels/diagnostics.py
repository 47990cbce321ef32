"""The newest status of each part of a robot, from `/diagnostics`."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.live.topics.request import Request
from studio.live.topics.source import decoder
from studio.protocol.commands import Commands, Scope
from studio.protocol.diagnostics import (
    DiagnosticsAnswer,
    DiagnosticValue,
    DiagnosticView,
    GetDiagnostics,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.live.topics.source import TopicSource
    from studio.live.topics.subscription import Subscription
    from studio.ros.node.samples import RawSample
    from studio.ros.types.classes import MessageValue

PARTS_MAX: Final = 1_000
VALUES_MAX: Final = 100
_TEXT_MAX: Final = 1_000
_TYPE: Final = "diagnostic_msgs/msg/DiagnosticArray"
_REQUEST: Final = Request("/diagnostics", (_TYPE,), depth=100, as_known_here=True)


@dataclass(frozen=True, slots=True)
class _Report:
    """The newest status of a part, and when it came."""

    view: DiagnosticView
    at_s: float


class Parts:
    """The newest status of each part; thread-safe."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._reports: dict[str, _Report] = {}
        self._left_out: set[str] = set()
        self._epoch = 0

    def keep_epoch(self, epoch: int) -> None:
        """Forget what came in another epoch."""
        with self._lock:
            if epoch != self._epoch:
                self._epoch = epoch
                self._reports.clear()
                self._left_out.clear()

    def take(self, array: MessageValue, at_s: float | None = None) -> None:
        """Keep a `diagnostic_msgs/msg/DiagnosticArray` that came at a time; None: now."""
        now_s = self._clock() if at_s is None else at_s
        with self._lock:
            for status in array.status:
                name = status.name[:_TEXT_MAX]
                if name in self._reports or len(self._reports) < PARTS_MAX:
                    self._reports[name] = _Report(_view(status), now_s)
                elif len(self._left_out) < PARTS_MAX:
                    self._left_out.add(name)

    def views(self) -> tuple[tuple[DiagnosticView, ...], int]:
        """Return all parts in order, and how many were left out for want of room."""
        now_s = self._clock()
        with self._lock:
            reports = sorted(self._reports.items())
            more = len(self._left_out)
        views = (
            one.view.model_copy(update={"age_s": round(now_s - one.at_s, 1)}) for _, one in reports
        )
        return tuple(views), more


class PartDiagnostics:
    """Starts again with each connection: parts of one robot are not shown beside another's.

    Args:
        source: Where topics come from.
        changed: Called when something came, in a thread of the source.
    """

    def __init__(self, source: TopicSource, changed: Callable[[], object] | None = None) -> None:
        self._source, self._changed = source, changed
        self._parts = Parts(time.monotonic if source.is_live else lambda: source.now_ns / 1e9)
        self._decode = decoder(source, _TYPE)
        self._subscription: Subscription | None = None

    def diagnostics(self, command: GetDiagnostics) -> DiagnosticsAnswer:
        """Return how all parts are; they are received from the first call on."""
        connected = self._source.connection != "none"
        if connected:
            self._parts.keep_epoch(self._source.epoch)
        if self._subscription is None:
            self._subscription = self._source.subscribe(_REQUEST, take=self._take)
        parts, more = self._parts.views()
        return DiagnosticsAnswer(
            request=command.request, connected=connected, parts=parts, more=more
        )

    def close(self) -> None:
        """Receive no more."""
        if self._subscription is not None:
            self._subscription.close()

    def _take(self, sample: RawSample) -> None:
        self._parts.keep_epoch(self._source.epoch)
        at_s = None if self._source.is_live else sample.received_ns / 1e9
        self._parts.take(self._decode(sample), at_s)
        if self._changed is not None:
            self._changed()


def _view(status: MessageValue) -> DiagnosticView:
    return DiagnosticView(
        name=status.name[:_TEXT_MAX],
        hardware=status.hardware_id[:_TEXT_MAX],
        level=status.level,
        message=status.message[:_TEXT_MAX],
        values=tuple(
            DiagnosticValue(key=one.key[:_TEXT_MAX], value=one.value[:_TEXT_MAX])
            for one in status.values[:VALUES_MAX]
        ),
        age_s=0.0,
    )


COMMANDS: Final = Commands[PartDiagnostics](Scope.ROS)
COMMANDS.viewer(GetDiagnostics, lambda one, c, _: one.diagnostics(c), same_for_all=True)
