"""A workspace with a Python package, and an engine that may run what lies in it."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

from studio.documents.engine import Engine
from studio.packages.creation.making import create_package
from studio.packages.creation.new_package import NewPackage
from studio.packages.edits.package_edit import PackageEdit
from studio.packages.edits.setup_edits import data_files_added
from studio.packages.edits.writing import write_edit
from studio.packages.roots import ServedRoots
from studio.packages.sources.package_source import PackageSource
from studio.protocol.launching import GetRunOutput, GetRuns
from studio.settings import Settings, WireChoice
from tests.support.open_documents import Ear

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Callable
    from pathlib import Path

    from studio.protocol import Command
    from studio.protocol.launching import OutputLine, RunView
    from studio.protocol.roles import Role

PATIENCE_S = 60.0
NODE = """import sys

import rclpy
from rclpy.node import Node
from std_msgs.msg import String


def main(args=None):
    rclpy.init(args=args)
    node = Node("speaker")
    said = node.create_publisher(String, "said", 10)
    node.create_timer(0.05, lambda: said.publish(String(data="{word}")))
    print("{word} is said", flush=True)
    print("with a warning", file=sys.stderr, flush=True)
    rclpy.spin(node)


if __name__ == "__main__":
    main()
"""
LAUNCH = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("name", default_value="one", choices=["one", "two"],
                              description="What the speaker is called"),
        DeclareLaunchArgument("loud", default_value="false"),
        Node(package="talk", executable="speaker", name=LaunchConfiguration("name"),
             namespace="hall", remappings=[("said", "heard")]),
        Node(package="talk", executable="speaker", name="second",
             condition=IfCondition(LaunchConfiguration("loud"))),
    ])
"""


ROBOT = """<robot name="cart" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="length" default="0.4"/>
  <link name="base"><visual><geometry><box size="$(arg length) 0.3 0.1"/></geometry>
    <material name="blue"><color rgba="0.2 0.4 0.8 1"/></material></visual></link>
  <link name="mast"><visual><geometry><cylinder radius="0.01" length="0.3"/></geometry></visual>
  </link>
  <joint name="mast_joint" type="fixed"><parent link="base"/><child link="mast"/>
    <origin xyz="0 0 0.2"/></joint>
</robot>
"""
VIEW = """Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/TF, Name: Frames of the cart, Enabled: true, Value: true}
  Global Options: {Fixed Frame: base}
"""
SHOW = """import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    share = get_package_share_directory("talk")
    robot = Command(["xacro ", os.path.join(share, "launch", "cart.xacro"),
                     " length:=", LaunchConfiguration("length")])
    return LaunchDescription([
        DeclareLaunchArgument("length", default_value="0.8", description="Of the cart, in metres"),
        Node(package="robot_state_publisher", executable="robot_state_publisher",
             parameters=[{"robot_description": robot}]),
        Node(package="rviz2", executable="rviz2",
             arguments=["-d", os.path.join(share, "launch", "cart.rviz")]),
        Node(package="talk", executable="speaker", namespace="cart"),
    ])
"""


def workspace(folder: Path, word: str = "hello") -> Path:
    """Make a workspace with the package `talk`: a node `speaker`, a launch file; its folder."""
    source = folder / "src"
    source.mkdir(parents=True)
    new = NewPackage(
        "talk",
        "ament_python",
        ("rclpy", "std_msgs"),
        node_name="speaker",
        license="Apache-2.0",
        description="Says a word again and again.",
        maintainer_name="Ada",
        maintainer_email="ada@robots.example",
    )
    create_package(source, new)
    node = source / "talk" / "talk" / "speaker.py"
    node.write_text(NODE.replace("{word}", word))
    launch = source / "talk" / "launch"
    launch.mkdir(exist_ok=True)
    (launch / "hall.launch.py").write_text(LAUNCH)
    setup = PackageSource(source / "talk").setup
    assert setup is not None
    installed = data_files_added(setup, [("launch", "*.launch.py")])
    write_edit(PackageEdit("Install launch", "", edits=installed), ServedRoots([source]))
    return folder


def add_robot(ws: Path) -> None:
    """Put a robot, a view and a launch file of both beside the launch file that is there."""
    folder = ws / "src/talk/launch"
    (folder / "cart.xacro").write_text(ROBOT)
    (folder / "cart.rviz").write_text(VIEW)
    (folder / "show.launch.py").write_text(SHOW)


def robot_workspace(folder: Path) -> Path:
    """Make a workspace with a node, a robot, and a launch file of both; its folder."""
    made = workspace(folder)
    add_robot(made)
    return made


class RunStudio:
    """An engine, and somebody who asks it."""

    def __init__(self, engine: Engine, ear: Ear) -> None:
        self.engine, self.ear = engine, ear
        self._asked = 0

    async def ask(self, command: Command) -> dict[str, Any]:
        """Carry a command out; its answer, or `done` where it has none."""
        self._asked += 1
        asked = command.model_copy(update={"request": self._asked})
        await self.engine.execute(asked, self.ear)
        return next(one for one in self.ear.events if one.get("request") == self._asked)

    def runs(self) -> list[RunView]:
        """All runs, the newest first."""
        return [*self.engine.programs.runs.runs(GetRuns()).runs]

    def lines(self, run: int) -> list[OutputLine]:
        """What a run printed."""
        return [*self.engine.programs.runs.output(GetRunOutput(run=run)).lines]

    async def printed(self, run: int, words: str) -> OutputLine:
        """Wait until a run has printed some words; the line."""
        try:
            async with asyncio.timeout(PATIENCE_S):
                while True:
                    for line in self.lines(run):
                        if words in line.text:
                            return line
                    await asyncio.sleep(0.02)
        except TimeoutError:
            raise AssertionError(f"{words!r} is not in {self.lines(run)}, {self.runs()}") from None

    async def until(self, holds: Callable[[], bool]) -> None:
        """Wait until that holds of the runs."""
        try:
            async with asyncio.timeout(PATIENCE_S):
                while not holds():  # noqa: ASYNC110 - nothing tells us when
                    await asyncio.sleep(0.02)
        except TimeoutError:
            said = [self.lines(one.run) for one in self.runs()]
            raise AssertionError(f"{self.runs()}, {said}") from None

    async def reached(self, run: int, *states: str) -> RunView:
        """Wait until a run is in one of these states."""
        async with asyncio.timeout(PATIENCE_S):
            while True:
                found = next(one for one in self.runs() if one.run == run)
                if found.state in states:
                    return found
                await asyncio.sleep(0.02)


@asynccontextmanager
async def run_studio(
    data_folder: Path, *run_folders: Path, endpoint: str = "", role: Role | None = None
) -> AsyncGenerator[RunStudio]:
    """An engine with these folders of `--allow-run`, which joins the router at `endpoint`."""
    data_folder.mkdir(parents=True, exist_ok=True)
    wire = WireChoice("off", (endpoint,)) if endpoint else WireChoice()
    made = Engine(Settings(data_folder=data_folder, run_folders=run_folders, wire=wire))
    ear = Ear() if role is None else Ear(role)
    made.attach(ear)
    try:
        if endpoint:
            made.rejoin(always=True)
            async with asyncio.timeout(PATIENCE_S):
                while made.ros.connection.current is None:  # noqa: ASYNC110 - nothing tells us
                    await asyncio.sleep(0.02)
        yield RunStudio(made, ear)
    finally:
        await made.close()
