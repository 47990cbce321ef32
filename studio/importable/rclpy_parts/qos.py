"""The module rclpy.qos: profiles, as strict as rclpy's about what they are made of."""

from __future__ import annotations

from enum import Enum, IntEnum
from typing import TYPE_CHECKING, Any, Final

from studio.ros.duration import Duration
from studio.ros.node.qos_overriding_options import QoSPolicyKind
from studio.ros.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    ReliabilityPolicy,
    qos_profile_action_status_default,
    qos_profile_best_available,
    qos_profile_parameter_events,
    qos_profile_parameters,
    qos_profile_sensor_data,
    qos_profile_services_default,
    qos_profile_system_default,
    why_unmatched,
)
from studio.ros.qos import QoSProfile as StudioProfile

if TYPE_CHECKING:
    from studio.ros.qos import QoSProfile as AnyProfile

__all__ = [
    "DeadlineBestAvailable", "DurabilityPolicy", "HistoryPolicy", "InvalidQoSProfileException",
    "LivelinessLeaseDurationeBestAvailable", "LivelinessPolicy", "QoSCompatibility",
    "QoSPolicyEnum", "QoSPresetProfiles", "QoSProfile", "ReliabilityPolicy",
    "qos_check_compatible", "qos_policy_name_from_kind", "qos_profile_action_status_default",
    "qos_profile_best_available", "qos_profile_default", "qos_profile_parameter_events",
    "qos_profile_parameters", "qos_profile_sensor_data", "qos_profile_services_default",
    "qos_profile_system_default", "qos_profile_unknown",
]  # fmt: skip

DeadlineBestAvailable: Final = Duration(seconds=9223372036, nanoseconds=854775806)
LivelinessLeaseDurationeBestAvailable: Final = DeadlineBestAvailable
QoSPolicyEnum = IntEnum
_FIELDS: Final = frozenset(
    {"history", "depth", "reliability", "durability", "lifespan", "deadline", "liveliness",
     "liveliness_lease_duration", "avoid_ros_namespace_conventions"}
)  # fmt: skip


class InvalidQoSProfileException(Exception):  # noqa: N818
    """A profile is made of what makes none."""


class QoSProfile(StudioProfile):
    """A profile that says its history or its depth; policies may be numbers."""

    __slots__ = ()

    def __init__(self, **policies: Any) -> None:  # noqa: ANN401
        unknown = sorted(set(policies) - _FIELDS)
        assert not unknown, f"Passed invalid parameters: {', '.join(unknown)}"
        if "history" not in policies and "depth" not in policies:
            raise InvalidQoSProfileException("History and/or depth settings are required.")
        if policies.get("history", HistoryPolicy.KEEP_LAST) == HistoryPolicy.KEEP_LAST and (
            "depth" not in policies
        ):
            raise InvalidQoSProfileException("History set to KEEP_LAST without a depth setting.")
        for name, kind in (
            ("history", HistoryPolicy),
            ("reliability", ReliabilityPolicy),
            ("durability", DurabilityPolicy),
            ("liveliness", LivelinessPolicy),
        ):
            if name in policies:
                policies[name] = kind(policies[name])
        assert isinstance(policies.get("depth", 0), int)
        super().__init__(**policies)


qos_profile_default: Final = StudioProfile(depth=10)
qos_profile_unknown: Final = StudioProfile(
    history=HistoryPolicy.UNKNOWN,
    reliability=ReliabilityPolicy.UNKNOWN,
    durability=DurabilityPolicy.UNKNOWN,
    liveliness=LivelinessPolicy.UNKNOWN,
)


class QoSPresetProfiles(Enum):
    """Profiles by their names."""

    UNKNOWN = qos_profile_unknown
    DEFAULT = qos_profile_default
    SYSTEM_DEFAULT = qos_profile_system_default
    SENSOR_DATA = qos_profile_sensor_data
    SERVICES_DEFAULT = qos_profile_services_default
    PARAMETERS = qos_profile_parameters
    PARAMETER_EVENTS = qos_profile_parameter_events
    ACTION_STATUS_DEFAULT = qos_profile_action_status_default
    BEST_AVAILABLE = qos_profile_best_available

    @classmethod
    def short_keys(cls) -> list[str]:
        """Return the names as command lines take them."""
        return [name.lower() for name in cls.__members__]

    @classmethod
    def get_from_short_key(cls, name: str) -> AnyProfile:
        """Return a profile by its short name.

        Raises:
            KeyError: There is none.
        """
        return cls[name.upper()].value


class QoSCompatibility(IntEnum):
    """Whether two profiles match."""

    OK = 0
    WARNING = 1
    ERROR = 2


def qos_check_compatible(
    publisher_qos: AnyProfile, subscription_qos: AnyProfile
) -> tuple[QoSCompatibility, str]:
    """Return whether a publisher and a subscription match on DDS, and why not."""
    reasons = why_unmatched(publisher_qos, subscription_qos)
    if reasons:
        return QoSCompatibility.ERROR, "; ".join(f"ERROR: {one}" for one in reasons)
    return QoSCompatibility.OK, ""


def qos_policy_name_from_kind(policy_kind: QoSPolicyKind | int) -> str:
    """Return the name of a policy."""
    return QoSPolicyKind(policy_kind).name
