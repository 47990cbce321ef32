"""LogDesk: hears `/rosout` from the first time that somebody looks, as long as it is connected."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.live.panels.heard_topic import HeardTopic
from studio.live.panels.log_ring import LogRing
from studio.protocol.commands import Commands, Scope
from studio.protocol.logs import GetLog, LogAnswer
from studio.ros.names import logger_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.live.connection.desk import WireDesk
    from studio.live.connection.link import WireLink
    from studio.protocol.logs import LogLine


class LogDesk:
    """Keeps what was said for whoever comes later, also after the connection has ended."""

    def __init__(self, wire: WireDesk) -> None:
        self._ring = LogRing()
        self._topic = HeardTopic(wire, self._hear)
        self.let_go = self._topic.let_go

    async def log(self, command: GetLog) -> LogAnswer:
        """Tell what was said after a line; nothing new comes while there is no connection."""
        await self._topic.listen()
        lines, first, last = self._ring.after(command.after)
        return LogAnswer(
            request=command.request,
            connected=self._topic.is_heard,
            lines=lines,
            first=first,
            last=last,
        )

    async def listen(self) -> int:
        """Hear it from now on; gives the number of the newest line, 0 without one."""
        await self._topic.listen()
        return self._ring.last

    def newest_warning(self, nodes: Iterable[str], *, after: int, since_s: float) -> LogLine | None:
        """Give the newest warning or error of some nodes, by their paths, as `LogRing` does."""
        loggers = [logger_name(path) for path in nodes]
        return self._ring.newest_warning(loggers, after=after, since_s=since_s)

    def _hear(self, link: WireLink) -> Callable[[], None]:
        """Hear it as it is sent: nodes keep what they said for those who come late."""
        from studio.ros.node.logger import ROSOUT  # noqa: PLC0415 - imports zenoh
        from studio.ros.qos import qos_profile_rosout_default  # noqa: PLC0415

        qos = qos_profile_rosout_default
        return link.subscribe("rcl_interfaces/msg/Log", ROSOUT, self._ring.take, qos)


COMMANDS: Final = Commands[LogDesk](Scope.ROS)
COMMANDS.viewer(GetLog, lambda one, c, _: one.log(c))
