"""Surroundings: told once, they are seen whenever somebody comes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.course.rover.round_trip import RoundTrip
from studio.course.rover.surroundings import Surroundings
from studio.displays.display import Received
from studio.displays.markers.display import MarkerArrayDisplay
from studio.nodes.robot_state_publisher import LATCHED
from studio.ros.cdr import codec_of
from studio.ros.messages import message
from tests.support.demos import heard, node_at
from tests.support.display_messages import NOW_NS, TYPES
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from studio.displays.drawing import Drawing
    from studio.ros.client import Node

pytestmark = pytest.mark.network
MARKERS = "visualization_msgs/msg/MarkerArray"


def drawn(node: Node) -> Drawing:
    told = heard(node, MARKERS, "/markers", LATCHED)
    wait_until("the markers", lambda: bool(told))
    display = MarkerArrayDisplay(TYPES)
    cdr = bytes(codec_of(message(MARKERS)).encode(told[0]))
    display.take(Received(MARKERS, cdr, NOW_NS))
    return display.draw(NOW_NS)


def test_who_comes_late_sees_the_markers_where_the_map_is_now(endpoint: str):
    with node_at(endpoint, "rover") as rover, node_at(endpoint, "late") as late:
        Surroundings(rover, RoundTrip())
        found = drawn(late)
    assert found
    assert {(one.frame, one.follows) for one in found.values()} == {("map", True)}
