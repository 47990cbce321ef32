"""Wheel: a publisher of velocities that says zero before it is closed.

Imports Zenoh, by way of ros: the desk imports it when it is used.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, Final

from studio.live.panels.requests import wire_name
from studio.ros.type_lookup import known_message
from studio.ros.types.convert import from_dict

if TYPE_CHECKING:
    from studio.live.connection.link import WireLink

SPEED_MAX: Final = 100.0
"""m/s and rad/s: nothing that is driven by hand is faster."""
_TWIST: Final = "geometry_msgs/msg/Twist"
_STAMPED: Final = "geometry_msgs/msg/TwistStamped"


class Wheel:
    """What one driver holds; made, turned and closed in threads, one at a time.

    Raises:
        StudioError: The topic cannot be named so, or its type is not known.
    """

    def __init__(self, link: WireLink, topic: str, stamped: bool) -> None:  # noqa: FBT001
        name = wire_name(topic)
        why: list[str] = []
        self.stamped = stamped
        self._kind = known_message(link.node, name, _STAMPED if stamped else _TWIST, why.append)
        self._link = link
        self._publisher = link.node.create_publisher(self._kind, name, 10)

    @property
    def is_reached(self) -> bool:
        """Whether the router is there."""
        return self._link.is_connected

    @property
    def is_heard(self) -> bool:
        """Whether the router is there, and somebody who hears it."""
        return self.is_reached and self._publisher.get_subscription_count() > 0

    def steer(self, x_m_s: float, y_m_s: float, yaw_rad_s: float) -> None:
        """Publish a velocity, each part of it no faster than `SPEED_MAX`."""
        x, y, yaw = (max(-SPEED_MAX, min(part, SPEED_MAX)) for part in (x_m_s, y_m_s, yaw_rad_s))
        twist: dict[str, Any] = {"linear": {"x": x, "y": y}, "angular": {"z": yaw}}
        values = {"header": "auto", "twist": twist} if self.stamped else twist
        self._publisher.publish(from_dict(self._kind, values, now_ns=time.time_ns()))

    def close(self) -> None:
        """Publish that it stands still, then nothing any more."""
        try:
            self.steer(0.0, 0.0, 0.0)
        finally:
            self._link.node.destroy_publisher(self._publisher)
