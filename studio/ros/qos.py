"""Quality of service: profiles by rclpy's names, their form in tokens, and which of them match."""

from __future__ import annotations

import copy
from dataclasses import dataclass, field
from enum import IntEnum

from studio.errors import TokenError
from studio.ros.duration import INFINITE, NANOSECONDS, Duration

# What rmw_zenoh takes for a depth of 0, and leaves out of tokens.
DEPTH_DEFAULT = 42
_INT_MAX = 2**63 - 1
_INT_DIGITS_MAX = len(str(_INT_MAX))


class ReliabilityPolicy(IntEnum):
    """Whether a lost sample is sent again."""

    SYSTEM_DEFAULT = 0
    RELIABLE = 1
    BEST_EFFORT = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class DurabilityPolicy(IntEnum):
    """Whether samples are kept for those who come late."""

    SYSTEM_DEFAULT = 0
    TRANSIENT_LOCAL = 1
    VOLATILE = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class HistoryPolicy(IntEnum):
    """Number of samples kept: the last `depth`, or all."""

    SYSTEM_DEFAULT = 0
    KEEP_LAST = 1
    KEEP_ALL = 2
    UNKNOWN = 3


class LivelinessPolicy(IntEnum):
    """Who asserts that a publisher is alive."""

    SYSTEM_DEFAULT = 0
    AUTOMATIC = 1
    MANUAL_BY_TOPIC = 3
    UNKNOWN = 4
    BEST_AVAILABLE = 5


@dataclass(slots=True, kw_only=True)
class QoSProfile:
    """What one side offers or requests; a zero duration stands for none, as in rclpy."""

    history: HistoryPolicy = HistoryPolicy.KEEP_LAST
    depth: int = 0
    reliability: ReliabilityPolicy = ReliabilityPolicy.RELIABLE
    durability: DurabilityPolicy = DurabilityPolicy.VOLATILE
    lifespan: Duration = field(default_factory=Duration)
    deadline: Duration = field(default_factory=Duration)
    liveliness: LivelinessPolicy = LivelinessPolicy.AUTOMATIC
    liveliness_lease_duration: Duration = field(default_factory=Duration)
    avoid_ros_namespace_conventions: bool = False


def as_profile(qos: QoSProfile | int) -> QoSProfile:
    """Return a new profile, made of a profile or of a depth alone."""
    if isinstance(qos, int):
        return QoSProfile(depth=qos)
    if not isinstance(qos, QoSProfile):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise TypeError(f"Expected QoSProfile or int, but received {type(qos)!r}")
    return copy.copy(qos)


def qos_text(qos: QoSProfile) -> str:
    """Write a profile as tokens carry it: what equals the default is left empty."""
    fields = [
        _number(_or(qos.reliability, ReliabilityPolicy.RELIABLE), ReliabilityPolicy.RELIABLE),
        _number(_or(qos.durability, DurabilityPolicy.VOLATILE), DurabilityPolicy.VOLATILE),
        _number(_or(qos.history, HistoryPolicy.KEEP_LAST), HistoryPolicy.KEEP_LAST)
        + ","
        + _number(_or(qos.depth, DEPTH_DEFAULT), DEPTH_DEFAULT),
        _duration_text(qos.deadline),
        _duration_text(qos.lifespan),
        _number(_or(qos.liveliness, LivelinessPolicy.AUTOMATIC), LivelinessPolicy.AUTOMATIC)
        + ","
        + _duration_text(qos.liveliness_lease_duration),
    ]
    return ":".join(fields)


def parse_qos(text: str) -> QoSProfile:
    """Read the QoS of a token; what is left empty is the default, more fields are passed over.

    Raises:
        TokenError: A field is missing, or no number that it may be.
    """
    fields = [part.split(",") for part in text.split(":")]
    if len(fields) < 6 or any(
        len(parts) < least for parts, least in zip(fields[2:6], (2, 2, 2, 3), strict=True)
    ):
        raise TokenError(text, "its QoS has too few fields")
    reliability, durability, history, deadline, lifespan, liveliness = fields[:6]
    try:
        return QoSProfile(
            reliability=ReliabilityPolicy(_value(reliability[0], ReliabilityPolicy.RELIABLE)),
            durability=DurabilityPolicy(_value(durability[0], DurabilityPolicy.VOLATILE)),
            history=HistoryPolicy(_value(history[0], HistoryPolicy.KEEP_LAST)),
            depth=_value(history[1], DEPTH_DEFAULT),
            deadline=_duration(deadline),
            lifespan=_duration(lifespan),
            liveliness=LivelinessPolicy(_value(liveliness[0], LivelinessPolicy.AUTOMATIC)),
            liveliness_lease_duration=_duration(liveliness[1:]),
        )
    except ValueError as error:
        raise TokenError(text, f"its QoS has a field that is wrong ({error})") from None


def _or(value: int, default: int) -> int:
    return value or default


def _number(value: int, default: int) -> str:
    return "" if value == default else str(int(value))


def _duration_text(span: Duration) -> str:
    whole = span if span.nanoseconds else INFINITE
    seconds, rest = divmod(whole.nanoseconds, NANOSECONDS)
    seconds_default, rest_default = divmod(INFINITE.nanoseconds, NANOSECONDS)
    return f"{_number(seconds, seconds_default)},{_number(rest, rest_default)}"


def _value(text: str, default: int) -> int:
    if not text:
        return default
    if not (text.isascii() and text.isdigit()) or len(text) > _INT_DIGITS_MAX:
        raise ValueError(f'"{text[:30]}" is no whole number from 0 on')
    if (number := int(text)) > _INT_MAX:
        raise ValueError(f"{text} is more than any field holds")
    return number


def _duration(parts: list[str]) -> Duration:
    seconds_default, rest_default = divmod(INFINITE.nanoseconds, NANOSECONDS)
    seconds = _value(parts[0], seconds_default)
    total_ns = seconds * NANOSECONDS + _value(parts[1], rest_default)
    return Duration() if total_ns >= INFINITE.nanoseconds else Duration(nanoseconds=total_ns)


qos_profile_sensor_data = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
qos_profile_services_default = QoSProfile(depth=10)
qos_profile_parameters = QoSProfile(depth=1000)
qos_profile_parameter_events = QoSProfile(depth=1000)
qos_profile_action_status_default = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
qos_profile_rosout_default = QoSProfile(
    depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL, lifespan=Duration(seconds=10)
)
qos_profile_system_default = QoSProfile(
    history=HistoryPolicy.SYSTEM_DEFAULT,
    reliability=ReliabilityPolicy.SYSTEM_DEFAULT,
    durability=DurabilityPolicy.SYSTEM_DEFAULT,
    liveliness=LivelinessPolicy.SYSTEM_DEFAULT,
)
qos_profile_best_available = QoSProfile(
    depth=10,
    reliability=ReliabilityPolicy.BEST_AVAILABLE,
    durability=DurabilityPolicy.BEST_AVAILABLE,
    liveliness=LivelinessPolicy.BEST_AVAILABLE,
)


def why_unmatched(offered: QoSProfile, requested: QoSProfile) -> list[str]:
    """Return what keeps a publisher and a subscription from matching; empty when they match.

    Zenoh itself delivers the samples either way, so this explains counts and warnings, and what
    would happen to the same nodes on DDS.
    """
    return [
        *_reliability(offered, requested),
        *_durability(offered, requested),
        *_deadline(offered, requested),
        *_liveliness(offered, requested),
    ]


def _reliability(offered: QoSProfile, requested: QoSProfile) -> list[str]:
    if (
        offered.reliability is ReliabilityPolicy.BEST_EFFORT
        and requested.reliability is ReliabilityPolicy.RELIABLE
    ):
        return ["the publisher is best effort, the subscription wants reliable"]
    return []


def _durability(offered: QoSProfile, requested: QoSProfile) -> list[str]:
    if (
        offered.durability is DurabilityPolicy.VOLATILE
        and requested.durability is DurabilityPolicy.TRANSIENT_LOCAL
    ):
        return ["the publisher is volatile, the subscription wants transient local"]
    return []


def _deadline(offered: QoSProfile, requested: QoSProfile) -> list[str]:
    return _later("deadline", offered.deadline, requested.deadline)


def _liveliness(offered: QoSProfile, requested: QoSProfile) -> list[str]:
    found = _later(
        "liveliness lease", offered.liveliness_lease_duration, requested.liveliness_lease_duration
    )
    if (
        offered.liveliness is LivelinessPolicy.AUTOMATIC
        and requested.liveliness is LivelinessPolicy.MANUAL_BY_TOPIC
    ):
        found.append("the publisher's liveliness is automatic, the subscription wants it by topic")
    return found


def _later(what: str, offered: Duration, requested: Duration) -> list[str]:
    offered_ns = offered.nanoseconds or INFINITE.nanoseconds
    requested_ns = requested.nanoseconds or INFINITE.nanoseconds
    if offered_ns <= requested_ns:
        return []
    text = "none" if offered_ns == INFINITE.nanoseconds else f"{offered_ns / 1e9:g} s"
    return [f"the publisher's {what} is {text}, the subscription wants {requested_ns / 1e9:g} s"]
