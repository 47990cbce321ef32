"""WrenchDisplay: a force and a torque as arrows."""

from __future__ import annotations

import math
from typing import Any

from studio.displays.display import TopicRole
from studio.displays.pose_look import switch
from studio.displays.vector_display import VectorDisplay
from studio.displays.vector_look import Names, vector_properties

_NAMES = Names("Force", "Torque")
_ACCEPT = "Accept NaN Values"


class WrenchDisplay(VectorDisplay):
    """Draws the last wrenches."""

    KIND = "Wrench"
    DOC = "A force and a torque, as a sensor at a wrist feels them."
    TOPICS = (TopicRole("", ("geometry_msgs/msg/WrenchStamped",), newest_only=False),)
    PROPERTIES = (
        *vector_properties(_NAMES),
        switch(_ACCEPT, "Whether numbers that are none count as 0.", on=False),
    )
    NAMES = _NAMES

    def parts(self, message: Any) -> tuple[Any, Any]:  # noqa: ANN401 - messages
        """The force and the torque."""
        wrench = message.wrench
        if self.values[_ACCEPT]:
            _put_zeros(wrench.force)
            _put_zeros(wrench.torque)
        return wrench.force, wrench.torque


def _put_zeros(vector: Any) -> None:  # noqa: ANN401 - a message
    """Put 0 where a number is none; what is infinite stays, as in RViz."""
    for name in "xyz":
        if math.isnan(getattr(vector, name)):
            setattr(vector, name, 0.0)
