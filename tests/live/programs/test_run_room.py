"""Nodes that the owner starts out of the page: real processes at a router of this machine."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from studio.errors import CommandError, NotRunnableError
from studio.packages.creation.making import create_package
from studio.packages.creation.new_package import NewPackage
from studio.packages.recent import RecentFiles
from studio.packages.roots import is_below
from studio.protocol.connection import DisconnectWire
from studio.protocol.launch_plans import PlanLaunch
from studio.protocol.launching import (
    EndProcess,
    ForgetRun,
    RestartProcess,
    RunAgainOnSave,
    StartLaunch,
    StartNode,
    StartRunAgain,
    StopRun,
)
from studio.system import is_running
from tests.support.run_studio import LAUNCH, NODE, run_studio, workspace
from tests.support.wire import free_endpoint, router_at

pytestmark = pytest.mark.network


def test_a_node_runs_prints_and_is_stopped(tmp_path: Path):
    async def run() -> None:
        endpoint, ws = free_endpoint(), workspace(tmp_path / "ws")
        with router_at(endpoint):
            async with run_studio(tmp_path / "data", ws, endpoint=endpoint) as studio:
                answer = await studio.ask(StartNode(package="talk", executable="speaker"))
                number = answer["run"]
                assert (await studio.printed(number, "hello is said")).stream == "stdout"
                assert (await studio.printed(number, "with a warning")).stream == "stderr"
                (view,) = studio.runs()
                assert view.line == "ros2 run talk speaker"
                assert view.file == str(ws / "src/talk/talk/speaker.py")
                with pytest.raises(CommandError, match="goes on"):
                    await studio.ask(ForgetRun(run=number))
                await studio.ask(StopRun(run=number))
                view = await studio.reached(number, "ended")
                assert view.trouble == ""
                await studio.ask(ForgetRun(run=number))
                assert studio.runs() == []

    asyncio.run(run())


def test_a_node_is_started_again_when_its_file_is_saved(tmp_path: Path):
    async def run() -> None:
        endpoint, ws = free_endpoint(), workspace(tmp_path / "ws")
        file = ws / "src/talk/talk/speaker.py"
        with router_at(endpoint):
            async with run_studio(tmp_path / "data", ws, endpoint=endpoint) as studio:
                number = (await studio.ask(StartNode(package="talk", executable="speaker")))["run"]
                await studio.printed(number, "hello is said")
                await studio.ask(RunAgainOnSave(run=number, on=True))
                file.write_text(NODE.replace("{word}", "goodbye"))
                await studio.printed(number, "goodbye is said")
                assert studio.runs()[0].again == 1
                file.write_text("def main(:\n")
                await studio.printed(number, "SyntaxError")
                assert (await studio.reached(number, "ended")).code != 0
                file.write_text(NODE.replace("{word}", "back"))
                await studio.printed(number, "back is said")
                await studio.ask(RunAgainOnSave(run=number, on=False))
                await studio.ask(StopRun(run=number))
                await studio.ask(StartRunAgain(run=number))
                await studio.reached(number, "running")

    asyncio.run(run())


def test_nothing_is_run_that_lies_elsewhere(tmp_path: Path):
    async def run() -> None:
        workspace(tmp_path / "ws")
        (tmp_path / "other").mkdir()
        endpoint = free_endpoint()
        with router_at(endpoint):
            async with run_studio(
                tmp_path / "data", tmp_path / "other", endpoint=endpoint
            ) as studio:
                with pytest.raises(Exception, match="talk"):
                    await studio.ask(StartNode(package="talk", executable="speaker"))
            async with run_studio(tmp_path / "data", endpoint=endpoint) as studio:
                with pytest.raises(NotRunnableError, match="--allow-run"):
                    await studio.ask(StartNode(package="talk", executable="speaker"))

    asyncio.run(run())


def test_a_launch_file_that_may_be_run_starts_no_node_that_came_in_a_zip(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    async def run() -> None:
        endpoint, ws = free_endpoint(), tmp_path / "ws"
        data = ws / "data"
        # It bears the name of nodes of the studio's own, was opened last, and lies below a folder
        # that may be run.
        new = NewPackage("turtlesim", "ament_python", ("rclpy",), node_name="turtlesim_node")
        create_package(workspace(ws) / "src", new)
        unpacked = data / "uploads" / "0123" / "turtlesim"
        unpacked.parent.mkdir(parents=True)
        (ws / "src" / "turtlesim").rename(unpacked)
        RecentFiles(data).note(str(unpacked / "package.xml"), "turtle", {}, 1.0)
        monkeypatch.setenv("STUDIO_DATA_DIR", str(data))
        file = ws / "src/talk/launch/turtle.launch.py"
        names = {'"talk"': '"turtlesim"', '"speaker"': '"turtlesim_node"'}
        text = LAUNCH
        for name, other in names.items():
            text = text.replace(name, other)
        file.write_text(text)
        with router_at(endpoint):
            async with run_studio(data, ws, endpoint=endpoint) as studio:
                plan = (await studio.ask(PlanLaunch(file=str(file))))["plan"]
                assert plan["nodes"][0]["start"]["kind"] == "studio"
                number = (await studio.ask(StartLaunch(file=str(file))))["run"]
                await studio.until(lambda: bool(studio.runs()[0].processes))
                assert "studio.course" in studio.runs()[0].processes[0].command
                await studio.ask(StopRun(run=number))
                node = await studio.ask(StartNode(package="turtlesim", executable="turtlesim_node"))
                (view,) = (one for one in studio.runs() if one.run == node["run"])
                assert not is_below(Path(view.file), data)
                await studio.ask(StopRun(run=node["run"]))

    asyncio.run(run())


def test_a_launch_file_starts_its_nodes_which_are_ended_and_started_one_by_one(tmp_path: Path):
    async def run() -> None:
        endpoint, ws = free_endpoint(), workspace(tmp_path / "ws")
        file = str(ws / "src/talk/launch/hall.launch.py")
        with router_at(endpoint):
            async with run_studio(tmp_path / "data", ws, endpoint=endpoint) as studio:
                command = StartLaunch(file=file, arguments={"loud": "true", "name": "two"})
                number = (await studio.ask(command))["run"]
                await studio.until(lambda: len(studio.runs()[0].processes) == 2)
                (view,) = studio.runs()
                assert view.line == "ros2 launch talk hall.launch.py loud:=true name:=two"
                assert [one.node for one in view.processes] == ["/hall/two", "/second"]
                first = view.processes[0].id
                line = await studio.printed(number, "hello is said")
                assert line.process in {one.id for one in view.processes}
                await studio.ask(EndProcess(run=number, process=first))
                await studio.until(lambda: studio.runs()[0].processes[0].state == "ended")
                await studio.ask(RestartProcess(run=number, process=first))
                await studio.until(lambda: studio.runs()[0].processes[0].starts == 2)
                await studio.ask(StopRun(run=number))
                assert (await studio.reached(number, "ended")).trouble == ""
                with pytest.raises(CommandError, match="has ended"):
                    await studio.ask(RestartProcess(run=number, process=first))

    asyncio.run(run())


def test_nodes_end_with_the_studio_however_it_ends(tmp_path: Path):
    ws, mark = workspace(tmp_path / "ws"), tmp_path / "pid"
    node = ws / "src/talk/talk/speaker.py"
    saying = f"open({str(mark)!r}, 'w').write(str(__import__('os').getpid()))\n"
    node.write_text(node.read_text().replace("    rclpy.spin", f"    {saying}    rclpy.spin"))

    async def run() -> int:
        endpoint = free_endpoint()
        with router_at(endpoint):
            async with run_studio(tmp_path / "data", ws, endpoint=endpoint) as studio:
                await studio.ask(StartNode(package="talk", executable="speaker"))
                await studio.until(lambda: mark.is_file() and mark.read_text() != "")
                return int(mark.read_text())

    assert not is_running(asyncio.run(run()))


def test_what_runs_ends_with_the_connection(tmp_path: Path):
    async def run() -> None:
        endpoint, ws = free_endpoint(), workspace(tmp_path / "ws")
        with router_at(endpoint):
            async with run_studio(tmp_path / "data", ws, endpoint=endpoint) as studio:
                number = (await studio.ask(StartNode(package="talk", executable="speaker")))["run"]
                await studio.printed(number, "hello is said")
                await studio.ask(DisconnectWire())
                assert (await studio.reached(number, "ended")).trouble == ""
                with pytest.raises(CommandError, match="connect first"):
                    await studio.ask(StartRunAgain(run=number))

    asyncio.run(run())


VIEW = """from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node


def generate_launch_description():
    robot = Command(["xacro ", "{robot}", " reach:=0.5"])
    return LaunchDescription([
        Node(package="robot_state_publisher", executable="robot_state_publisher",
             parameters=[{{"robot_description": robot}}]),
        Node(package="rviz2", executable="rviz2", arguments=["-d", "{view}"]),
        Node(package="nobody_has_it", executable="nothing"),
    ])
"""
ROBOT = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="reach" default="1"/>
  <link name="base"/>
</robot>
"""


def test_a_launch_has_its_robot_its_view_and_what_is_not_started(tmp_path: Path):
    async def run() -> None:
        endpoint, ws = free_endpoint(), workspace(tmp_path / "ws")
        robot, view = ws / "src/talk/arm.urdf.xacro", ws / "src/talk/arm.rviz"
        robot.write_text(ROBOT)
        view.write_text("Visualization Manager:\n  Displays: []\n")
        file = ws / "src/talk/launch/view.launch.py"
        file.write_text(VIEW.format(robot=robot, view=view))
        with router_at(endpoint):
            async with run_studio(tmp_path / "data", ws, endpoint=endpoint) as studio:
                plan = (await studio.ask(PlanLaunch(file=str(file))))["plan"]
                (planned,) = plan["robots"]
                assert (planned["file"], planned["mappings"]) == (str(robot), {"reach": "0.5"})
                number = (await studio.ask(StartLaunch(file=str(file))))["run"]
                await studio.until(lambda: bool(studio.runs()[0].shown))
                (shown,) = studio.runs()[0].shown
                assert (shown.what, shown.config) == ("rviz2", str(view))
                await studio.until(lambda: bool(studio.runs()[0].not_started))
                (missing,) = studio.runs()[0].not_started
                assert missing.package == "nobody_has_it"
                assert missing.reason
                await studio.ask(StopRun(run=number))

    asyncio.run(run())
