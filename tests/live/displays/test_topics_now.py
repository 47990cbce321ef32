from __future__ import annotations

import pytest

from studio.displays.catalogue import display_of_kind
from studio.live.displays.topics_now import TopicsNow
from studio.live.topics.request import Endpoint
from studio.live.topics.source import Topic
from studio.ros.qos import QoSProfile
from tests.support.display_messages import TYPES

SCAN, IMU, TEXT = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Imu", "std_msgs/msg/String"


class Catalogue:
    """Topics by what their publishers send, and what others would receive on them."""

    def __init__(self, sent: dict[str, str], wanted: dict[str, str] | None = None) -> None:
        self.sent, self.wanted = sent, wanted or {}
        self.asked = 0

    def catalogue(self) -> list[Topic]:
        self.asked += 1
        ends = [(name, (end(one),), ()) for name, one in self.sent.items()]
        ends += [(name, (), (end(one),)) for name, one in self.wanted.items()]
        return [
            Topic(name, tuple(one.type_name for one in (*publishers, *others)), publishers, others)
            for name, publishers, others in ends
        ]


def end(type_name: str) -> Endpoint:
    return Endpoint("/talker", False, type_name, "", QoSProfile(depth=1))


@pytest.mark.parametrize(
    ("topic", "sent", "instead"),
    [
        ("/scan", {"/a": SCAN, "/rear/scan": SCAN, "/front/scan": SCAN}, "/front/scan"),
        ("/scan", {"/laser": SCAN, "/_hidden": SCAN, "/imu/scan": IMU}, "/laser"),
        ("", {"/b": SCAN, "/a": SCAN}, "/a"),
        ("/scan", {"/imu": IMU}, ""),
        ("/scan", {}, ""),
    ],
)
def test_the_same_last_name_is_the_best_and_then_the_first(
    topic: str, sent: dict[str, str], instead: str
):
    scan = display_of_kind("LaserScan")(TYPES)
    assert TopicsNow(Catalogue(sent)).instead_of(topic, scan) == instead


def test_a_topic_that_others_only_wait_for_is_none_and_neither_is_any_text_a_robot():
    scan, robot = (display_of_kind(one)(TYPES) for one in ("LaserScan", "RobotModel"))
    assert TopicsNow(Catalogue({}, wanted={"/scan": SCAN})).instead_of("/laser", scan) == ""
    chat = {"/chatter": TEXT}
    assert TopicsNow(Catalogue(chat)).instead_of("/robot_description", robot) == ""
    chat["/arm/robot_description"] = TEXT
    told = TopicsNow(Catalogue(chat)).instead_of("/robot_description", robot)
    assert told == "/arm/robot_description"


def test_the_source_is_asked_once_for_all_displays():
    catalogue, scan = Catalogue({"/laser": SCAN}), display_of_kind("LaserScan")(TYPES)
    topics = TopicsNow(catalogue)
    assert [topics.instead_of(one, scan) for one in ("/scan", "")] == ["/laser"] * 2
    assert catalogue.asked == 1
