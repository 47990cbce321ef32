"""What may be given as the type of a service: the value that is imported, or a class like it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue


class ServiceKind(Protocol):
    """A service as `studio.ros.messages` gives it: its name, and the classes of its two parts."""

    @property
    def name(self) -> str:
        """The full name, `std_srvs/srv/Trigger`."""
        ...

    @property
    def Request(self) -> type[MessageValue]:  # noqa: N802  # rclpy's name
        """The class of requests."""
        ...

    @property
    def Response(self) -> type[MessageValue]:  # noqa: N802  # rclpy's name
        """The class of responses."""
        ...
