"""ServiceEnd: what the server and the client of a service have alike."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.ros import strictness
from studio.ros.node.work import Work

if TYPE_CHECKING:
    from studio.ros.node.base import Endpoint
    from studio.ros.node.work import CallbackGroup
    from studio.ros.qos import QoSProfile
    from studio.ros.types.library import ServiceKind


class ServiceEnd(Work):
    """One end of a service.

    Attributes:
        given_name: The name as it was given, before it was resolved.
    """

    def __init__(self, endpoint: Endpoint, srv_type: ServiceKind, group: CallbackGroup) -> None:
        super().__init__(group)
        self.endpoint = endpoint
        self.srv_type = srv_type
        self.given_name = ""

    @property
    def service_name(self) -> str:
        """The full name of the service."""
        return self.endpoint.token.name

    @property
    def srv_name(self) -> str:
        """The name as it was given in a user's program, as rclpy has it; else the full one."""
        is_told = strictness.is_begun() and self.given_name
        return self.given_name if is_told else self.service_name

    @property
    def qos_profile(self) -> QoSProfile:
        """Its QoS."""
        return self.endpoint.token.qos

    def configure_introspection(
        self, clock: object, service_event_qos_profile: object, introspection_state: int
    ) -> None:
        """Refuse but to be off: events of calls are not published here.

        Raises:
            NotImplementedError: The state is METADATA or CONTENTS.
        """
        del clock, service_event_qos_profile
        if not introspection_state:
            return
        raise NotImplementedError(
            f"The studio publishes no events of the service {self.service_name}: leave out "
            "configure_introspection, or run it where ROS is installed."
        )
