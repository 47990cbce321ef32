"""What our player plays, as nodes of a real ROS 2 (rclpy on rmw_zenoh_cpp) hear it."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

import pytest

from studio.ros.qos import QoSProfile
from tests.support.command_line import started, studio
from tests.support.demos import node_at
from tests.support.ros2_peer import real_node, started_program
from tests.support.told_recording import BEGIN_NS, LATCHED, ToldRecording, written
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.network
STRING = "std_msgs/msg/String"
SIMULATED = """
    import rclpy
    from rclpy.parameter import Parameter

    rclpy.init()
    node = rclpy.create_node(
        "simulated", parameter_overrides=[Parameter("use_sim_time", value=True)]
    )
    print("ready", flush=True)
    while node.get_clock().now().nanoseconds == 0:
        rclpy.spin_once(node)
    print(node.get_clock().now().nanoseconds, flush=True)
"""


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    recording = ToldRecording()
    recording.add_topic("/number", STRING, QoSProfile(depth=10))
    recording.add_topic("/map", STRING, LATCHED)
    recording.tell("/map", 0, data="map")
    for at in range(20):
        recording.tell("/number", at * 10, data=str(at))
    return written(recording, tmp_path_factory.mktemp("bags") / "bag1")


def test_b1_real_nodes_hear_a_bag_and_late_ones_what_is_latched(endpoint: str, bag: Path):
    early = ("sub", "--topic", "/number", "--depth", "100", "--count", "0", "--name", "early")
    late = ("sub", "--topic", "/map", "--durability", "transient_local", "--name", "late")
    resume = ("service", "call", "/rosbag2_player/resume", "rosbag2_interfaces/srv/Resume")
    with node_at(endpoint) as ours, real_node(endpoint, *early) as real:
        wait_until("it is there", lambda: ours.count_subscribers("/number") == 1)
        with started(
            endpoint, "bag", "play", str(bag), "--start-paused", "-m", "/map:=/plan"
        ) as one:
            one.wait_for("Playback until timestamp")
            wait_until("it is remapped", lambda: ours.count_publishers("/plan") == 1)
            assert studio(*resume, "--connect", endpoint).code == 0
            assert one.wait() == 0
        wait_until("all came", lambda: len(real.all_said("message")) == 20)
        assert [said["data"] for said in real.all_said("message")] == [str(at) for at in range(20)]
        with started(endpoint, "bag", "play", str(bag), "--loop", "-d", "1") as player:
            player.wait_for("Playback until timestamp")
            with real_node(endpoint, *late) as latecomer:
                latecomer.wait_said("message", data="map")


def test_a_real_node_with_use_sim_time_follows_the_clock_of_a_bag(
    endpoint: str, bag: Path, tmp_path: Path
):
    file = tmp_path / "simulated.py"
    file.write_text(textwrap.dedent(SIMULATED))
    program = started_program(endpoint, file)
    try:
        assert program.stdout is not None
        assert program.stdout.readline() == "ready\n"
        with started(endpoint, "bag", "play", str(bag), "--clock", "50", "--start-paused"):
            assert int(program.stdout.readline()) == BEGIN_NS
    finally:
        program.kill()
        program.communicate()
