from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from studio.system import is_running
from tests.support.command_line import started
from tests.support.greedy import CASES
from tests.support.launch_files import package_at
from tests.support.patience import ended_within
from tests.support.wire import PATIENCE_S, free_endpoint, wait_until

if TYPE_CHECKING:
    from studio.launch.watchdog import Limits

pytestmark = pytest.mark.network

_NODE = """\
import sys
import rclpy
from rclpy.node import Node

def main():
    rclpy.init()
    node = Node('as_written')
    node.declare_parameter('who', 'nobody')
    node.declare_parameter('n.deep', 0)
    node.get_logger().info(f"who={node.get_parameter('who').value} "
        f"deep={node.get_parameter('n.deep').value} name={node.get_fully_qualified_name()} "
        f"topic={node.resolve_topic_name('a')}")
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
"""
_HEAD = """\
from launch import LaunchDescription
from launch.actions import *
from launch.event_handlers import *
from launch_ros.actions import Node
def generate_launch_description():
"""


def _launch_file(folder: Path, body: str) -> str:
    file = folder / "a.launch.py"
    file.write_text(_HEAD + body)
    return str(file)


def test_a_node_of_the_workspace_gets_its_name_parameters_and_remaps(tmp_path: Path):
    text = _HEAD + (
        "    return LaunchDescription([Node(package='mine', executable='one', name='given',\n"
        "        namespace='ns', remappings=[('a', 'b')],\n"
        "        parameters=[{'who': 'me: you', 'n': {'deep': 4}}])])\n"
    )
    package_at(tmp_path / "src", "mine", {"launch/a.launch.py": text, "mine/one.py": _NODE}, "one")
    words = ("launch", "mine", "a.launch.py", "--package-path", str(tmp_path / "src"))
    with started(free_endpoint(), *words) as launch:
        launch.wait_for("who=me: you deep=4 name=/ns/given topic=/ns/b")
        assert "[INFO] [one-1]: process started with pid [" in launch.printed
        assert launch.stop() == 0
    assert "[INFO] [one-1]: process has finished cleanly" in launch.printed


def test_events_timers_and_respawn_do_what_the_launch_file_says(tmp_path: Path):
    file = _launch_file(
        tmp_path,
        """\
    a = ExecuteProcess(cmd=['sh', '-c', 'echo again; exit 3'], name='a', output='screen',
                       respawn=True, respawn_delay=0.1, respawn_max_retries=1)
    b = ExecuteProcess(cmd=['sleep', '100'], name='b')
    return LaunchDescription([a, b,
        RegisterEventHandler(OnProcessStart(target_action=b, on_start=[LogInfo(msg='b runs')])),
        RegisterEventHandler(OnProcessExit(target_action=a,
            on_exit=lambda event, context: LogInfo(msg=f'a gave {event.returncode}'))),
        RegisterEventHandler(OnShutdown(on_shutdown=[LogInfo(msg='good bye')])),
        TimerAction(period=1.0, actions=[Shutdown(reason='enough')]),
        Node(package='gazebo_ros', executable='gz')])
""",
    )
    with started(free_endpoint(), "launch", file) as launch:
        assert launch.wait() == 0
    printed = launch.printed
    assert printed.count("again\n") == 2
    assert printed.count("a gave 3") == 2
    for part in (
        "b runs",
        "process has died [pid ",
        "exit code 3, cmd '",
        "the launch ends: enough",
        "good bye",
        "gazebo_ros gz is not started: the studio has no physics",
    ):
        assert part in printed, part


def test_a_handlers_function_gives_one_action_several_or_none(tmp_path: Path):
    file = _launch_file(
        tmp_path,
        """\
    a = ExecuteProcess(cmd=['sh', '-c', 'echo out; echo err >&2'])
    return LaunchDescription([
        RegisterEventHandler(OnProcessIO(target_action=a,
            on_stdout=lambda event: LogInfo(msg='one ' + event.text.decode().strip()),
            on_stderr=lambda event: [LogInfo(msg='two'), LogInfo(msg='three')],
            on_output=lambda event: None)),
        RegisterEventHandler(OnProcessStart(on_start=lambda event, context: None)), a])
""",
    )
    with started(free_endpoint(), "launch", file) as launch:
        assert launch.wait() == 0
    for part in ("]: one out\n", "]: two\n", "]: three\n"):
        assert part in launch.printed, launch.printed


@pytest.mark.parametrize(
    "handler",
    [
        "OnProcessIO(on_stdout=lambda event: 3)",
        "OnProcessIO(on_stdout=lambda event: event.nothing)",
        "OnProcessExit(on_exit=lambda event, context: [3])",
        "OnProcessExit(target_action=lambda action: action.nothing, on_exit=[])",
    ],
)
def test_what_fails_in_a_handler_is_said_with_its_line(tmp_path: Path, handler: str):
    file = _launch_file(
        tmp_path,
        "    return LaunchDescription([ExecuteProcess(cmd=['echo', 'a']),\n"
        f"        RegisterEventHandler({handler})])\n",
    )
    with started(free_endpoint(), "launch", file) as launch:
        assert launch.wait() == 1
    assert f"{file}:7: " in launch.printed


def test_a_file_of_parameters_that_nobody_can_make_is_left_out_with_one_warning(tmp_path: Path):
    text = (
        "from nav2_common.launch import SomethingNew\n" + _HEAD + "    return LaunchDescription(["
        "Node(package='demo_nodes_py', executable='talker', respawn=True,\n"
        "        parameters=[SomethingNew(), [SomethingNew(), '/a.yaml']])])\n"
    )
    file = tmp_path / "a.launch.py"
    file.write_text(text)
    with started(free_endpoint(), "launch", "-a", str(file)) as launch:
        launch.wait_for("Publishing")
        assert launch.stop() == 0
    assert launch.printed.count("not supported: the file of parameters") == 1
    assert launch.printed.count("SomethingNew in nav2_common.launch") == 1


def test_a_file_beside_the_launch_file_is_no_module_as_in_ros(tmp_path: Path):
    (tmp_path / "beside_it.py").write_text("X = 1\n")
    file = tmp_path / "a.launch.py"
    file.write_text("from beside_it import X\n" + _HEAD + "    return LaunchDescription([])\n")
    with started(free_endpoint(), "launch", str(file)) as launch:
        assert launch.wait() == 1
    assert f"{file}:1: ModuleNotFoundError: No module named 'beside_it'" in launch.printed


def test_exec_name_names_a_process_and_not_its_node(tmp_path: Path):
    file = _launch_file(
        tmp_path,
        "    return LaunchDescription([Node(package='demo_nodes_py', executable='talker',\n"
        "        name='node_name', exec_name='label', output='screen')])\n",
    )
    with started(free_endpoint(), "launch", file) as launch:
        launch.wait_for("[node_name]: Publishing")
        assert launch.stop() == 0
    assert "[INFO] [label-1]: process started with pid [" in launch.printed


def test_who_dies_of_ctrl_c_has_died(tmp_path: Path):
    program = tmp_path / "a.py"
    program.write_text("import time\nprint('up', flush=True)\ntime.sleep(1000)\n")
    file = _launch_file(
        tmp_path,
        "    return LaunchDescription([ExecuteProcess(name='one', output='screen',\n"
        f"        cmd=[{sys.executable!r}, {str(program)!r}])])\n",
    )
    with started(free_endpoint(), "launch", file) as launch:
        launch.wait_for("up")
        assert launch.stop() == 0
    assert "KeyboardInterrupt" in launch.printed
    assert "[ERROR] [one-1]: process has died [pid " in launch.printed
    assert f"{program}']." in launch.printed
    assert "finished cleanly" not in launch.printed


def test_the_end_of_a_required_node_ends_all(tmp_path: Path):
    file = _launch_file(
        tmp_path,
        "    return LaunchDescription([ExecuteProcess(cmd=['sleep', '100']),\n"
        "        ExecuteProcess(cmd=['true'], on_exit=Shutdown(reason='it is done'))])\n",
    )
    with started(free_endpoint(), "launch", file) as launch:
        assert launch.wait() == 0
    assert "the launch ends: it is done" in launch.printed


def test_who_does_not_end_by_ctrl_c_is_terminated_and_then_killed(tmp_path: Path):
    stubborn = "trap '' INT TERM; echo ready; while :; do sleep 0.1; done"
    file = _launch_file(
        tmp_path,
        f"    return LaunchDescription([ExecuteProcess(cmd=['sh', '-c', {stubborn!r}],\n"
        "        output='screen', sigterm_timeout='0.3', sigkill_timeout='0.3')])\n",
    )
    with started(free_endpoint(), "launch", file) as launch:
        launch.wait_for("ready")
        os.kill(launch.process.pid, signal.SIGINT)
        assert launch.wait() == 0
    assert "after receiving 'SIGINT', escalating to 'SIGTERM'" in launch.printed
    assert "after receiving 'SIGTERM', escalating to 'SIGKILL'" in launch.printed


def test_a_fault_of_the_launch_file_starts_nothing(tmp_path: Path):
    file = _launch_file(
        tmp_path,
        "    return LaunchDescription([DeclareLaunchArgument('robot', choices=['a', 'b']),\n"
        "        ExecuteProcess(cmd=['echo', 'here'], output='screen')])\n",
    )
    with started(free_endpoint(), "launch", file) as launch:
        assert launch.wait() == 1
    assert "the argument robot has no value and no default: give robot:=..., one of a, b" in (
        launch.printed
    )
    assert "process started" not in launch.printed


class _Paged:
    """A launch as the page starts it."""

    def __init__(self, *words: str) -> None:
        command = [sys.executable, "-P", "-m", "studio", "launch", "--events", *words]
        endpoint = f"connect/endpoints={json.dumps([free_endpoint()])}"
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, "ZENOH_CONFIG_OVERRIDE": endpoint},
        )
        self.events: list[dict[str, Any]] = []

    def until(self, **wanted: object) -> dict[str, Any]:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.events.append(json.loads(line))
            if all(self.events[-1].get(name) == value for name, value in wanted.items()):
                return self.events[-1]
        raise AssertionError(f"{wanted} did not come: {self.events}")

    def send(self, **command: object) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps(command) + "\n")
        self.process.stdin.flush()

    def close(self) -> int:
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.close()
        self.events += map(json.loads, self.process.stdout)
        code = ended_within(self.process, PATIENCE_S)
        self.process.stdout.close()
        return code


def test_the_page_is_told_by_events_and_tells_by_commands(tmp_path: Path):
    file = _launch_file(
        tmp_path,
        "    print('no event')\n"
        "    return LaunchDescription([ExecuteProcess(cmd=['sh', '-c', 'echo up; sleep 100']),\n"
        "        Node(package='rviz2', executable='rviz2', arguments=['-d', '/x/y.rviz'])])\n",
    )
    paged = _Paged(file)
    shown = paged.until(event="shown")
    assert (shown["what"], shown["config"]) == ("rviz2", "/x/y.rviz")
    first = paged.until(event="process_started")
    assert first["place"] == f"{file}:7"
    assert paged.until(event="output")["text"] == "up\n"
    paged.send(command="restart", id=first["id"])
    assert paged.until(event="process_exited")["respawn_in_s"] == 0.0
    second = paged.until(event="process_started")
    assert second["pid"] != first["pid"]
    paged.send(command="end_process", id=first["id"])
    assert paged.until(event="process_exited")["respawn_in_s"] is None
    paged.send(command="nonsense")
    assert "was not understood" in paged.until(event="log")["text"]
    paged.send(command="stop")
    paged.until(event="ended", code=0)
    assert paged.close() == 0


def test_the_end_of_who_started_it_ends_the_group(tmp_path: Path):
    file = _launch_file(
        tmp_path, "    return LaunchDescription([ExecuteProcess(cmd=['sleep', '8642'])])\n"
    )
    paged = _Paged(file)
    pid = paged.until(event="process_started")["pid"]
    assert paged.close() == 0
    assert paged.events[-1] == {"event": "ended", "code": 0}
    wait_until("the process gone", lambda: not _is_there(pid))


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere what a launch started stays")
def test_the_kill_of_the_launch_itself_ends_what_it_started(tmp_path: Path):
    file = _launch_file(
        tmp_path,
        """\
    stays = "trap '' INT TERM; sleep 8643 & echo up; wait; wait"
    return LaunchDescription([ExecuteProcess(cmd=['sh', '-c', stays], output='screen'),
        Node(package='demo_nodes_py', executable='talker')])
""",
    )
    paged = _Paged(file)
    pids = [paged.until(event="process_started")["pid"] for _ in range(2)]
    while "Publishing" not in paged.until(event="output")["text"]:
        pass
    paged.process.kill()
    for pid in pids:
        wait_until("the process gone", lambda pid=pid: not _is_there(pid))
    paged.close()


def _is_there(pid: int) -> bool:
    """Whether it runs; one that has ended may wait for a parent that never asks."""
    if sys.platform != "linux":
        return is_running(pid)
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except FileNotFoundError:
        return False


def test_a_flood_of_output_is_bounded_for_the_page(tmp_path: Path):
    file = _launch_file(
        tmp_path,
        "    return LaunchDescription([ExecuteProcess(cmd=['sh', '-c',\n"
        "        'yes xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx | head -c 50000000; echo; echo end'])])\n",
    )
    paged = _Paged(file)
    paged.until(event="ended")
    outputs = [one for one in paged.events if one["event"] == "output"]
    assert sum(len(one["text"]) for one in outputs) < 10_000_000
    assert paged.close() == 0


def test_one_node_is_a_launch_of_one_node():
    paged = _Paged("--node", "demo_nodes_py", "talker", "--", "--ros-args", "-r", "__node:=mine")
    event = paged.until(event="process_started")
    assert event["command"][-3:] == ["--ros-args", "-r", "__node:=mine"]
    while "Publishing" not in paged.until(event="output")["text"]:
        pass
    assert paged.close() == 0


def test_a_robot_is_expanded_and_lines_of_ros2_are_the_studios(tmp_path: Path):
    text = (
        "from launch.substitutions import *\n"
        "from launch_ros.substitutions import FindPackageShare\n"
        "from launch_ros.parameter_descriptions import ParameterValue\n" + _HEAD + "    file = "
        "PathJoinSubstitution(\n"
        "        [FindPackageShare('rover_description'), 'urdf', 'rover.urdf.xacro'])\n"
        "    text = Command([FindExecutable(name='xacro'), ' ', file, ' lidar:=none'])\n"
        "    return LaunchDescription([Node(package='robot_state_publisher',\n"
        "        executable='robot_state_publisher',\n"
        "        parameters=[{'robot_description': ParameterValue(text, value_type=str)}]),\n"
        "        RegisterEventHandler(OnProcessStart(on_start=[TimerAction(period=1.0, actions=[\n"
        "            ExecuteProcess(cmd=['ros2', 'topic', 'list', '--spin-time', '1'],\n"
        "                           output='screen', on_exit=Shutdown())])], handle_once=True))])\n"
    )
    file = tmp_path / "a.launch.py"
    file.write_text(text)
    with started(free_endpoint(), "launch", str(file)) as launch:
        assert launch.wait() == 0
    assert "/robot_description" in launch.printed


def test_a_launch_file_that_never_returns_ends_with_who_started_it(tmp_path: Path):
    paged = _Paged(_launch_file(tmp_path, "    while True:\n        pass\n"))
    assert paged.close() == 1
    assert paged.events == []


def test_the_terminal_that_closes_ends_the_group(tmp_path: Path):
    file = _launch_file(
        tmp_path,
        "    return LaunchDescription([ExecuteProcess(cmd=['sleep', '100'], name='one')])\n",
    )
    with started(free_endpoint(), "launch", file) as launch:
        launch.wait_for("process started with pid [")
        os.kill(launch.process.pid, signal.SIGHUP)
        assert launch.wait() == 0
    assert "[one-1]: process has" in launch.printed


@pytest.mark.parametrize("numbers", [(signal.SIGINT, signal.SIGINT), (signal.SIGTERM,)])
def test_a_function_that_never_returns_is_ended_from_the_terminal(
    tmp_path: Path, numbers: tuple[int, ...]
):
    file = _launch_file(
        tmp_path,
        "    def block(context):\n        print('held', flush=True)\n"
        "        while True:\n            pass\n"
        "    return LaunchDescription([ExecuteProcess(cmd=['sleep', '100']),\n"
        "        TimerAction(period=0.5, actions=[OpaqueFunction(function=block)])])\n",
    )
    with started(free_endpoint(), "launch", file) as launch:
        launch.wait_for("held")
        pid = int(launch.printed.split("process started with pid [")[1].split("]")[0])
        for number in numbers:
            os.kill(launch.process.pid, number)
            time.sleep(0.3)  # two signals of one kind at once are one
        assert launch.wait() == 1
        wait_until("what it started gone", lambda: not _is_there(pid))
    assert "the launch file does not let go" in launch.printed


def test_a_command_that_takes_long_ends_with_the_launch(tmp_path: Path):
    marker = tmp_path / "runs"
    file = _launch_file(
        tmp_path,
        "    from launch.substitutions import Command\n"
        "    return LaunchDescription([TimerAction(period=0.1, actions=[\n"
        f"        LogInfo(msg=Command(['sh -c \"echo $$ > {marker}; sleep 50\"']))])])\n",
    )
    with started(free_endpoint(), "launch", file) as launch:
        wait_until("the command running", marker.exists)
        os.kill(launch.process.pid, signal.SIGINT)
        assert launch.wait() == 1
    assert "was ended with the launch" in launch.printed


def test_a_misspelt_executable_of_the_users_own_package_would_fail_in_ros(tmp_path: Path):
    text = _HEAD + (
        "    return LaunchDescription([Node(package='mine', executable='oen'),\n"
        "        Node(package='controller_manager', executable='spawner')])\n"
    )
    package_at(tmp_path / "src", "mine", {"launch/a.launch.py": text, "mine/one.py": _NODE}, "one")
    words = ("launch", "mine", "a.launch.py", "--package-path", str(tmp_path / "src"))
    with started(free_endpoint(), *words) as launch:
        assert launch.wait() == 1
    (line,) = [one for one in launch.lines if "[ERROR]" in one]
    assert "a.launch.py:6: Your workspace has the package mine" in line
    assert "it would fail in ROS 2, too, where that ends the launch" in line
    assert "controller_manager spawner is not started: the studio runs no ros2_control" in (
        launch.printed
    )


def test_what_a_handler_of_the_end_starts_is_done_to_its_end(tmp_path: Path):
    file = _launch_file(
        tmp_path,
        """\
    return LaunchDescription([ExecuteProcess(cmd=['sleep', '100']),
        RegisterEventHandler(OnShutdown(on_shutdown=[
            ExecuteProcess(cmd=['sh', '-c', 'sleep 0.3; echo swept'], output='screen'),
            Node(package='demo_nodes_py', executable='talker')]))])
""",
    )
    with started(free_endpoint(), "launch", file) as launch:
        launch.wait_for("process started with pid [")
        assert launch.stop() == 0
    assert "[sh-2] swept" in launch.printed
    assert "demo_nodes_py talker is not started: the launch ends" in launch.printed


def test_a_second_ctrl_c_ends_what_a_handler_of_the_end_started(tmp_path: Path):
    file = _launch_file(
        tmp_path,
        "    return LaunchDescription([ExecuteProcess(cmd=['sleep', '9']), RegisterEventHandler(\n"
        "        OnShutdown(on_shutdown=[ExecuteProcess(cmd=['sleep', '1000'], name='late')]))])\n",
    )
    with started(free_endpoint(), "launch", file) as launch:
        launch.wait_for("process started with pid [")
        os.kill(launch.process.pid, signal.SIGINT)
        launch.wait_for("[late-2]: process started")
        os.kill(launch.process.pid, signal.SIGINT)
        assert launch.wait() == 0


_LIMITED = """\
import functools, sys
from studio.launch import running
from studio.launch.watchdog import Limits
running.Runner = functools.partial(running.Runner, limits=Limits({limits}))
from studio.cli import main
sys.exit(main(["launch", *sys.argv[1:]]))
"""


@pytest.mark.parametrize(("code", "limits", "said"), CASES)
def test_a_launch_that_takes_too_much_is_ended_with_a_sentence(
    tmp_path: Path, code: str, limits: Limits, said: str
):
    command = [sys.executable, "-c", code]
    body = f"    return LaunchDescription([ExecuteProcess(cmd={command!r})])\n"
    numbers = f"{limits.memory_bytes}, {limits.processes}, {limits.files}"
    words = [_launch_file(tmp_path, body), "--connect", free_endpoint()]
    ran = subprocess.run(
        [sys.executable, "-c", _LIMITED.format(limits=numbers), *words],
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    assert f"the launch is ended: {said}" in ran.stdout + ran.stderr
    assert ran.returncode == 1
