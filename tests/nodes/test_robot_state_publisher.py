"""D8: robot_state_publisher as a process, heard by a node of the test over a real router."""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING, Any

import pytest

from studio.nodes.robot_state_publisher import LATCHED
from studio.ros.messages import message
from tests.support.demos import call, heard, node_at, running
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from studio.ros.client import Node
    from tests.support.demos import RunningDemo

pytestmark = pytest.mark.network

URDF = """<robot name="arm">
  <link name="base"/><link name="upper"/><link name="tip"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="mount" type="fixed"><parent link="upper"/><child link="tip"/>
    <origin xyz="0.5 0 0"/></joint>
</robot>"""
TF = "tf2_msgs/msg/TFMessage"


@pytest.fixture
def tester(endpoint: str) -> Generator[Node]:
    with node_at(endpoint) as node:
        yield node


@pytest.fixture
def publisher(endpoint: str, tmp_path: Path) -> Generator[RunningDemo]:
    file = tmp_path / "arm.urdf"
    file.write_text(URDF)
    words = [sys.executable, "-m", "studio.nodes.robot_state_publisher", str(file)]
    with running(words, endpoint) as started:
        yield started


def joint_states(tester: Node, position: float) -> None:
    """Tell a joint state until the test is over, as a robot does."""
    kind = message("sensor_msgs/msg/JointState")
    out = tester.create_publisher(kind, "joint_states", 10)

    def tell() -> None:
        state = kind(name=["shoulder"], position=[position])
        state.header.stamp = tester.get_clock().now().to_msg()
        out.publish(state)

    tester.create_timer(0.05, tell)


def transforms(messages: list[Any]) -> dict[str, Any]:
    return {one.child_frame_id: one for told in messages for one in told.transforms}


@pytest.mark.usefixtures("publisher")
def test_d8_a_late_subscriber_gets_the_description_and_both_topics_of_tf(tester: Node):
    joint_states(tester, 0.4)
    descriptions = heard(tester, "std_msgs/msg/String", "/robot_description", LATCHED)
    static, moving = heard(tester, TF, "/tf_static", LATCHED), heard(tester, TF, "/tf")
    wait_until("all three topics", lambda: bool(descriptions and static and moving))
    assert descriptions[0].data == URDF
    fixed = transforms(static)["tip"]
    assert (fixed.header.frame_id, fixed.transform.translation.x) == ("upper", 0.5)
    turned = transforms(moving)["upper"].transform.rotation
    assert (turned.z, turned.w) == pytest.approx((math.sin(0.2), math.cos(0.2)))
    latecomer = heard(tester, "std_msgs/msg/String", "/robot_description", LATCHED)
    wait_until("it is told to one who comes later", lambda: bool(latecomer))


@pytest.mark.usefixtures("publisher")
def test_d8_the_description_can_be_set_and_one_that_is_none_is_refused(tester: Node):
    descriptions = heard(tester, "std_msgs/msg/String", "/robot_description", LATCHED)
    wait_until("the first description", lambda: bool(descriptions))
    name = "/robot_state_publisher/set_parameters"
    changed = URDF.replace("0.5", "0.75")
    answers = [
        call(tester, "rcl_interfaces/srv/SetParameters", name, parameters=[parameter(text)])
        for text in ("<robot/>", changed)
    ]
    refused, taken = (answer.results[0] for answer in answers)
    assert (refused.successful, taken.successful) == (False, True)
    assert "no link" in refused.reason
    wait_until("the new description", lambda: descriptions[-1].data == changed)


def parameter(text: str) -> Any:  # noqa: ANN401
    value = message("rcl_interfaces/msg/ParameterValue")(type=4, string_value=text)
    return message("rcl_interfaces/msg/Parameter")(name="robot_description", value=value)


def test_frames_have_the_prefix_that_is_given(endpoint: str, tester: Node, tmp_path: Path):
    file = tmp_path / "arm.urdf"
    file.write_text(URDF)
    module = "studio.nodes.robot_state_publisher"
    words = [sys.executable, "-m", module, str(file), "--ros-args", "-p", "frame_prefix:=r1/"]
    static = heard(tester, TF, "/tf_static", LATCHED)
    with running(words, endpoint):
        wait_until("the fixed frame", lambda: "r1/tip" in transforms(static))
    assert transforms(static)["r1/tip"].header.frame_id == "r1/upper"


def test_d9_joint_state_publisher_tells_the_robot_of_the_topic(endpoint: str, tester: Node):
    text = message("std_msgs/msg/String")
    tester.create_publisher(text, "/robot_description", LATCHED).publish(text(data=URDF))
    states = heard(tester, "sensor_msgs/msg/JointState", "/joint_states")
    with running([sys.executable, "-m", "studio.nodes.joint_state_publisher"], endpoint):
        wait_until("three joint states", lambda: len(states) >= 3)
    assert (states[0].name, states[0].position.tolist()) == (["shoulder"], [0.0])
