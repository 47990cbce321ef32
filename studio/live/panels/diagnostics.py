"""DiagnosticsDesk: hears `/diagnostics` while somebody looks, and keeps the newest of each part."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.live.panels.heard_topic import HeardTopic
from studio.protocol.commands import Commands, Scope
from studio.protocol.diagnostics import (
    DiagnosticsAnswer,
    DiagnosticValue,
    DiagnosticView,
    GetDiagnostics,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.live.connection.desk import WireDesk
    from studio.live.connection.link import WireLink
    from studio.ros.types.classes import MessageValue

PARTS_MAX: Final = 1_000
VALUES_MAX: Final = 100
_TEXT_MAX: Final = 1_000


@dataclass(frozen=True, slots=True)
class _Said:
    """What a part said, and when it came."""

    view: DiagnosticView
    at_s: float


class Parts:
    """The newest of each part; filled by the thread of the link, read by the loop."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._said: dict[str, _Said] = {}
        self._left_out: set[str] = set()

    def take(self, array: MessageValue) -> None:
        """Keep a `diagnostic_msgs/msg/DiagnosticArray`."""
        now_s = self._clock()
        with self._lock:
            for status in array.status:
                name = status.name[:_TEXT_MAX]
                if name in self._said or len(self._said) < PARTS_MAX:
                    self._said[name] = _Said(_view(status), now_s)
                elif len(self._left_out) < PARTS_MAX:
                    self._left_out.add(name)

    def views(self) -> tuple[tuple[DiagnosticView, ...], int]:
        """All parts in order, and how many there was no room for."""
        now_s = self._clock()
        with self._lock:
            said = sorted(self._said.items())
            more = len(self._left_out)
        views = (
            one.view.model_copy(update={"age_s": round(now_s - one.at_s, 1)}) for _, one in said
        )
        return tuple(views), more


class DiagnosticsDesk:
    """Begins anew with each connection: what another robot said is not shown beside this one's."""

    def __init__(self, wire: WireDesk) -> None:
        self._parts = Parts()
        self._topic = HeardTopic(wire, self._hear)
        self.let_go = self._topic.let_go

    async def diagnostics(self, command: GetDiagnostics) -> DiagnosticsAnswer:
        """Tell how all parts are."""
        await self._topic.listen()
        parts, more = self._parts.views()
        return DiagnosticsAnswer(
            request=command.request, connected=self._topic.is_heard, parts=parts, more=more
        )

    def _hear(self, link: WireLink) -> Callable[[], None]:
        from studio.ros.qos import QoSProfile  # noqa: PLC0415

        parts = self._parts = Parts()
        kind = "diagnostic_msgs/msg/DiagnosticArray"
        return link.subscribe(kind, "/diagnostics", parts.take, QoSProfile(depth=100))


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


COMMANDS: Final = Commands[DiagnosticsDesk](Scope.ROS)
COMMANDS.viewer(GetDiagnostics, lambda one, c, _: one.diagnostics(c))
