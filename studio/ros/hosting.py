"""What of a node those need that serve something in its name."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.qos import QoSProfile


class Host(Protocol):
    """A node that can publish and serve already."""

    def create_service(
        self,
        srv_type: Any,  # noqa: ANN401
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = ...,
    ) -> Any:  # noqa: ANN401
        """Serve; the callback fills the response and gives it back."""
        ...

    def create_publisher(
        self,
        msg_type: Any,  # noqa: ANN401
        topic: str,
        qos_profile: QoSProfile | int,
    ) -> Any:  # noqa: ANN401
        """Publish."""
        ...

    def get_fully_qualified_name(self) -> str:
        """Namespace and name."""
        ...

    def get_clock(self) -> Any:  # noqa: ANN401
        """Tell the time."""
        ...

    def get_logger(self) -> Any:  # noqa: ANN401
        """Say what went wrong."""
        ...
