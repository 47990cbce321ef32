"""ActionQos: the quality of service of the parts of an action."""

from __future__ import annotations

from dataclasses import dataclass

from studio.ros.qos import QoSProfile

FEEDBACK_QOS = QoSProfile(depth=10)


@dataclass(frozen=True, slots=True)
class ActionQos:
    """One profile for each part; those of both ends are to match."""

    goal: QoSProfile
    result: QoSProfile
    cancel: QoSProfile
    feedback: QoSProfile
    status: QoSProfile
