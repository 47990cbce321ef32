"""`studio demo` with its node: the rover drives while its page is served."""

from __future__ import annotations

import json
import signal
from typing import TYPE_CHECKING

import pytest

from studio.ros.client import DurabilityPolicy, QoSProfile
from tests.support.demos import heard, node_at
from tests.support.server import running_studio
from tests.support.wire import free_endpoint, running_router, wait_until

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.network
KEPT = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def test_the_rover_drives_with_the_arguments_of_the_page_and_ends_with_it(tmp_path: Path):
    with running_router() as router, node_at(router) as node:
        odometry = heard(node, "nav_msgs/msg/Odometry", "/odom")
        models = heard(node, "std_msgs/msg/String", "/robot_description", KEPT)
        words = ["demo", "--connect", router, "arm:=false"]
        with running_studio(words, tmp_path / "data", moving=True) as studio:
            wait_until("it drives", lambda: len(odometry) > 1 and odometry[-1].pose.pose.position.x)
            wait_until("its model", lambda: bool(models))
            assert "arm_roll_joint" not in models[0].data
            code, seconds = studio.stop(signal.SIGINT)
            assert code in {0, 130}
            assert seconds < 5.0
        wait_until("it has left", lambda: len(node.graph.nodes()) == 1)


def test_where_no_router_may_be_started_the_page_is_served_and_the_reason_is_said(tmp_path: Path):
    words = ["demo", "--connect", free_endpoint(), "--router", "off"]
    with running_studio(words, tmp_path / "data", moving=True) as studio:
        wait_until("the reason", lambda: "No Zenoh router answers" in studio.stderr)
        with studio.client() as client:
            assert client.get("/").status_code == 200
        assert "Traceback" not in studio.stderr


def test_the_studio_joins_its_rover_by_itself(tmp_path: Path):
    words = ["demo", "--connect", free_endpoint()]
    with (
        running_studio(words, tmp_path / "data", moving=True) as studio,
        studio.websocket("/control") as lane,
    ):
        events = (json.loads(one) for one in lane if isinstance(one, str))
        told = (one for one in events if one["type"] == "wire_state")
        assert next(one for one in told if "/rover" in one["nodes"])["state"] == "connected"
