"""Whether a publisher's offer meets a subscription's wish, in words, as DDS would judge it."""

from __future__ import annotations

from studio.ros.duration import INFINITE, Duration
from studio.ros.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy


def why_unmatched(offered: QoSProfile, wished: QoSProfile) -> list[str]:
    """Say what keeps a publisher and a subscription apart; empty when they match.

    Zenoh itself carries the samples either way, so that this explains counts and warnings,
    and what would happen to the same nodes on DDS.
    """
    return [
        *_reliability(offered, wished),
        *_durability(offered, wished),
        *_deadline(offered, wished),
        *_liveliness(offered, wished),
    ]


def _reliability(offered: QoSProfile, wished: QoSProfile) -> list[str]:
    if (
        offered.reliability is ReliabilityPolicy.BEST_EFFORT
        and wished.reliability is ReliabilityPolicy.RELIABLE
    ):
        return ["the publisher is best effort, the subscription wants reliable"]
    return []


def _durability(offered: QoSProfile, wished: QoSProfile) -> list[str]:
    if (
        offered.durability is DurabilityPolicy.VOLATILE
        and wished.durability is DurabilityPolicy.TRANSIENT_LOCAL
    ):
        return ["the publisher is volatile, the subscription wants transient local"]
    return []


def _deadline(offered: QoSProfile, wished: QoSProfile) -> list[str]:
    return _later("deadline", offered.deadline, wished.deadline)


def _liveliness(offered: QoSProfile, wished: QoSProfile) -> list[str]:
    found = _later(
        "liveliness lease", offered.liveliness_lease_duration, wished.liveliness_lease_duration
    )
    if (
        offered.liveliness is LivelinessPolicy.AUTOMATIC
        and wished.liveliness is LivelinessPolicy.MANUAL_BY_TOPIC
    ):
        found.append("the publisher's liveliness is automatic, the subscription wants it by topic")
    return found


def _later(what: str, offered: Duration, wished: Duration) -> list[str]:
    offered_ns = offered.nanoseconds or INFINITE.nanoseconds
    wished_ns = wished.nanoseconds or INFINITE.nanoseconds
    if offered_ns <= wished_ns:
        return []
    said = "none" if offered_ns == INFINITE.nanoseconds else f"{offered_ns / 1e9:g} s"
    return [f"the publisher's {what} is {said}, the subscription wants {wished_ns / 1e9:g} s"]
