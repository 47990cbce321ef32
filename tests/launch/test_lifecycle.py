from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.launch.lifecycle import LifecycleNodes
from studio.ros.client import DurabilityPolicy, QoSProfile
from tests.support.command_line import started
from tests.support.demos import heard, node_at
from tests.support.wire import free_endpoint, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from tests.support.demos import RunningDemo

pytestmark = pytest.mark.network

_FILE = """\
from launch import LaunchDescription
from launch.actions import EmitEvent, ExecuteProcess, LogInfo, RegisterEventHandler
from launch.event_handlers import OnProcessIO
from launch.events import matches_action
from launch_ros.actions import LifecycleNode, Node
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from lifecycle_msgs.msg import Transition

def generate_launch_description():
    talker = LifecycleNode(package='lifecycle', executable='lifecycle_talker', name='managed',
                           namespace='ns', output='screen')
    writer = ExecuteProcess(cmd=['sh', '-c', 'echo to out; echo to err >&2'])
    def change(number):
        return EmitEvent(event=ChangeState(
            lifecycle_node_matcher=matches_action(talker), transition_id=number))
    return LaunchDescription([
        RegisterEventHandler(OnProcessIO(
            target_action=writer,
            on_stdout=lambda event: [LogInfo(msg='out is ' + event.text.decode())],
            on_stderr=lambda event: [LogInfo(msg='err is ' + event.text.decode())])),
        RegisterEventHandler(OnStateTransition(
            target_lifecycle_node=talker, start_state='configuring', goal_state='inactive',
            entities=[LogInfo(msg='managed is inactive'), change(Transition.TRANSITION_ACTIVATE)])),
        RegisterEventHandler(OnStateTransition(
            target_lifecycle_node=talker, goal_state='active',
            entities=[LogInfo(msg='managed is active'),
                      change(Transition.TRANSITION_CONFIGURE)])),
        writer, talker, change(Transition.TRANSITION_CONFIGURE),
        Node(package='tf2_ros', executable='static_transform_publisher',
             arguments=['--z', '0.5', '--frame-id', 'base', '--child-frame-id', 'laser']),
    ])
"""


@pytest.fixture(scope="module")
def endpoint() -> str:
    return free_endpoint()


@pytest.fixture(scope="module")
def launch(endpoint: str, tmp_path_factory: pytest.TempPathFactory) -> Generator[RunningDemo]:
    file = tmp_path_factory.mktemp("launch") / "a.launch.py"
    file.write_text(_FILE)
    with started(endpoint, "launch", str(file)) as one:
        yield one
        assert one.stop() == 0


def test_transitions_are_asked_for_and_followed(launch: RunningDemo):
    launch.wait_for("managed is active")
    printed = launch.printed
    assert printed.index("on_configure() is called") < printed.index("on_activate() is called")
    assert "managed is inactive" in printed


def test_a_transition_that_is_not_made_is_said(launch: RunningDemo):
    launch.wait_for("/ns/managed did not make the transition 1")


def test_what_a_process_writes_is_told_by_its_stream(launch: RunningDemo):
    launch.wait_for("out is to out")
    launch.wait_for("err is to err")


def test_a_static_transform_of_a_launch_is_heard(launch: RunningDemo, endpoint: str):
    launch.wait_for("static_transform_publisher-")
    kept = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    with node_at(endpoint) as node:
        messages = heard(node, "tf2_msgs/msg/TFMessage", "/tf_static", kept)
        wait_until("the transform", lambda: bool(messages))
    (transform,) = messages[0].transforms
    assert (transform.header.frame_id, transform.child_frame_id) == ("base", "laser")
    assert transform.transform.translation.z == 0.5


def test_a_node_that_nobody_asks_for_is_never_made():
    nodes = LifecycleNodes({}, lambda _: None)
    nodes.close()
