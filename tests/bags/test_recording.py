from __future__ import annotations

import pytest

from studio.bags.recording import KEPT_MAX, RecordedTopic, latched_count
from studio.ros.qos import DurabilityPolicy, HistoryPolicy, QoSProfile

LATCHED = DurabilityPolicy.TRANSIENT_LOCAL


def latched(depth: int, history: HistoryPolicy = HistoryPolicy.KEEP_LAST) -> QoSProfile:
    return QoSProfile(depth=depth, history=history, durability=LATCHED)


@pytest.mark.parametrize(
    ("qos", "count"),
    [
        ([latched(1)], 1),
        ([latched(1), latched(3)], 4),  # those of two publishers
        ([latched(0, HistoryPolicy.KEEP_ALL)], KEPT_MAX),
        ([latched(800), latched(800)], KEPT_MAX),
        ([latched(0, HistoryPolicy.UNKNOWN)], 10),  # as recorded with DDS
        ([], 10),
    ],
)
def test_a_late_subscriber_gets_what_the_publishers_of_a_latched_topic_keep(
    qos: list[QoSProfile], count: int
):
    assert latched_count(RecordedTopic("/map", "nav_msgs/msg/OccupancyGrid", qos=(*qos,))) == count


@pytest.mark.parametrize("qos", [(), (latched(1),)])
def test_of_static_transforms_all_are_given_that_may_be(qos: tuple[QoSProfile, ...]):
    topic = RecordedTopic("/tf_static", "tf2_msgs/msg/TFMessage", qos=qos)
    assert latched_count(topic) == KEPT_MAX
