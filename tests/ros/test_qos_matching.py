from __future__ import annotations

import pytest

from studio.ros.duration import Duration
from studio.ros.qos import (
    DurabilityPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_best_available,
    qos_profile_sensor_data,
    why_unmatched,
)

PLAIN = QoSProfile(depth=10)


@pytest.mark.parametrize(
    ("offered", "wished"),
    [
        (PLAIN, PLAIN),
        (PLAIN, qos_profile_sensor_data),
        (QoSProfile(durability=DurabilityPolicy.TRANSIENT_LOCAL), PLAIN),
        (qos_profile_sensor_data, qos_profile_best_available),
        (QoSProfile(deadline=Duration(seconds=1)), QoSProfile(deadline=Duration(seconds=2))),
        (QoSProfile(liveliness=LivelinessPolicy.MANUAL_BY_TOPIC), PLAIN),
    ],
)
def test_an_offer_that_is_as_good_as_the_wish_matches(offered: QoSProfile, wished: QoSProfile):
    assert why_unmatched(offered, wished) == []


@pytest.mark.parametrize(
    ("offered", "wished", "word"),
    [
        (qos_profile_sensor_data, PLAIN, "best effort"),
        (PLAIN, QoSProfile(durability=DurabilityPolicy.TRANSIENT_LOCAL), "volatile"),
        (PLAIN, QoSProfile(deadline=Duration(seconds=2)), "deadline is none"),
        (
            QoSProfile(deadline=Duration(seconds=3)),
            QoSProfile(deadline=Duration(seconds=2)),
            "deadline is 3 s, the subscription wants 2 s",
        ),
        (PLAIN, QoSProfile(liveliness=LivelinessPolicy.MANUAL_BY_TOPIC), "by topic"),
        (PLAIN, QoSProfile(liveliness_lease_duration=Duration(seconds=1)), "lease"),
    ],
)
def test_each_reason_is_told_in_words(offered: QoSProfile, wished: QoSProfile, word: str):
    (reason,) = why_unmatched(offered, wished)
    assert word in reason


def test_all_reasons_are_told_at_once():
    wished = QoSProfile(
        reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL
    )
    assert len(why_unmatched(qos_profile_sensor_data, wished)) == 2
