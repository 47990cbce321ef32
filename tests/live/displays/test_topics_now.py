from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.displays.catalogue import display_of_kind
from studio.live.displays.topics_now import TopicsNow
from tests.support.display_messages import TYPES
from tests.support.heard_topics import publisher

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.ros.graph.endpoints import GraphEndpoint

SCAN, IMU, TEXT = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Imu", "std_msgs/msg/String"


class Graph:
    """Topics by what their publishers send, and what others would hear on them."""

    def __init__(self, sent: dict[str, str], heard: dict[str, str] | None = None) -> None:
        self.sent, self.heard = sent, heard or {}
        self.asked = 0

    def topics(self) -> Sequence[tuple[str, Sequence[str]]]:
        self.asked += 1
        return [*((name, (one,)) for name, one in (self.sent | self.heard).items())]

    def publishers(self, topic: str) -> Sequence[GraphEndpoint]:
        return [publisher(self.sent[topic])] if topic in self.sent else []


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
    assert TopicsNow(Graph(sent)).instead_of(topic, scan) == instead


def test_a_topic_that_others_only_wait_for_is_none_and_neither_is_any_text_a_robot():
    scan, robot = (display_of_kind(one)(TYPES) for one in ("LaserScan", "RobotModel"))
    assert TopicsNow(Graph({}, heard={"/scan": SCAN})).instead_of("/laser", scan) == ""
    chat = {"/chatter": TEXT}
    assert TopicsNow(Graph(chat)).instead_of("/robot_description", robot) == ""
    chat["/arm/robot_description"] = TEXT
    told = TopicsNow(Graph(chat)).instead_of("/robot_description", robot)
    assert told == "/arm/robot_description"


def test_the_graph_is_asked_once_for_all_displays():
    graph, scan = Graph({"/laser": SCAN}), display_of_kind("LaserScan")(TYPES)
    topics = TopicsNow(graph)
    assert [topics.instead_of(one, scan) for one in ("/scan", "")] == ["/laser"] * 2
    assert graph.asked == 1
