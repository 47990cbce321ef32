"""What nodes of a real ROS 2 (rclpy on rmw_zenoh_cpp) publish, recorded, as others read it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from rosbags.rosbag2 import Reader

from tests.support.command_line import started
from tests.support.demos import node_at
from tests.support.ros2_peer import real_node
from tests.support.wire import wait_until
from tests.support.written_bags import kept_in_mcap, told_by_mcap, told_by_rosbags

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.network


def test_b1_a_bag_of_real_nodes_has_what_they_published(endpoint: str, tmp_path: Path):
    bag = tmp_path / "bag"
    words = ("bag", "record", "-e", "^/(told|kept)$", "-o", str(bag))
    told = ("--topic", "/told", "--count", "50", "--period", "0.02", "--name", "talker", "--wait")
    kept = ("--topic", "/kept", "--count", "1", "--durability", "transient_local", "--depth", "1")
    with node_at(endpoint) as ours, real_node(endpoint, "pub", *kept):
        wait_until("it is there", lambda: ours.count_publishers("/kept") == 1)
        with started(endpoint, *words) as recording:
            recording.wait_for("Subscribed to topic '/kept'")
            with real_node(endpoint, "pub", *told) as talker:
                recording.wait_for("Subscribed to topic '/told'")
                wait_until("all was said", lambda: len(talker.all_said("pub")) == 50)
                wait_until("all is written", lambda: len(kept_in_mcap(bag / "bag_0.mcap")) == 51)
                recording.stop()
    with Reader(bag) as reader:
        found = {one.topic: one for one in reader.connections}
        assert found["/told"].msgtype == "std_msgs/msg/String"
        assert found["/told"].digest.startswith("RIHS01_")
    assert told_by_mcap(bag / "bag_0.mcap") == told_by_rosbags(bag)
    words = [(topic, data[8:].rstrip(b"\0").decode()) for topic, _, data in told_by_rosbags(bag)]
    said = [f"from rclpy {number}" for number in range(50)]
    assert [word for topic, word in words if topic == "/told"] == said
    assert [word for topic, word in words if topic == "/kept"] == ["from rclpy 0"]
