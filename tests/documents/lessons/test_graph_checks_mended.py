"""Lessons whose files the reader mends: done as they say, every check of theirs holds."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

import pytest

from studio.course.lessons.checks import Concern
from studio.course.lessons.files import write_files
from studio.course.lessons.shelf import Shelf
from studio.documents.lessons.graph_checks import GraphChecks
from studio.documents.lessons.model_checks import model_verdict
from studio.live.connection.ros_connection import RosConnection
from studio.settings import WireChoice, repository_or_wheel
from tests.support.command_line import started
from tests.support.course_workspaces import Workspace
from tests.support.open_documents import engine, opened
from tests.support.wire import PATIENCE_S

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator
    from pathlib import Path

    from studio.course.lessons.checks import Check
    from studio.documents.document import Document

pytestmark = pytest.mark.network
COURSE = repository_or_wheel("frontend_assets") / "lessons"


def checks_of(lesson: str, concern: Concern) -> list[Check]:
    """All its checks of that kind, of every step."""
    steps = Shelf(COURSE).find(lesson).read().steps
    return [one for step in steps for one in step.checks if one.concern is concern]


def replace(file: Path, *edits: tuple[str, str]) -> None:
    text = file.read_text()
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    file.write_text(text)


@asynccontextmanager
async def checking(endpoint: str) -> AsyncGenerator[GraphChecks]:
    wire = RosConnection(WireChoice("off", (endpoint,)))
    checks = GraphChecks(await wire.link())
    try:
        yield checks
    finally:
        await checks.close()
        await wire.close()


async def graph_holds(lesson: str, checks: GraphChecks) -> None:
    """Wait until all its checks of the graph hold at once."""
    wanted = checks_of(lesson, Concern.GRAPH)
    assert wanted
    left: dict[str, str] = {}
    try:
        async with asyncio.timeout(PATIENCE_S):
            while True:
                found = await checks.verdicts(wanted, may_call={one.line for one in wanted})
                left = {line: one.code for line, one in found.items() if not one.ok}
                if not left:
                    return
                await asyncio.sleep(0.05)
    except TimeoutError:
        pytest.fail(f"These do not hold: {left}")


async def model_misses(lesson: str, document: Document) -> list[str]:
    """Its checks of the model that do not hold."""
    await asyncio.gather(document.checks.settled(), document.robot_checks.settled())
    return [
        one.line
        for one in checks_of(lesson, Concern.MODEL)
        if not model_verdict(one.kind, one.values, document).ok
    ]


def test_the_mended_node_does_all_that_its_lesson_asks_for_and_ends_quietly(
    endpoint: str, tmp_path: Path
):
    write_files(COURSE, "mend_a_node", tmp_path / "mend_a_node")
    counter = tmp_path / "mend_a_node" / "counter.py"
    replace(
        counter,
        ("std_msgs.srv", "std_srvs.srv"),
        ("BEST_EFFORT", "RELIABLE"),
        ("while True:", "self.create_timer(0.5, self.tick)"),
        ("            self.count += 1\n            time.sleep(0.5)\n", ""),
        ("str(self.count)", "str(self.count)\n        return response"),
        (
            "    rclpy.spin(node)\n    rclpy.shutdown()",
            "    try:\n        rclpy.spin(node)\n    except KeyboardInterrupt:\n        pass",
        ),
    )

    async def run() -> None:
        with started(endpoint, "run", str(counter)) as node:
            async with checking(endpoint) as checks:
                await graph_holds("mend_a_node", checks)
            await asyncio.to_thread(node.stop)
            assert "Traceback" not in node.printed

    asyncio.run(run())


def test_the_mended_cart_is_one_robot_and_its_launch_file_shows_its_wheels(
    endpoint: str, tmp_path: Path
):
    folder = tmp_path / "mend_a_launch"
    write_files(COURSE, "mend_a_launch", folder)
    package = folder / "src" / "cart_description"
    replace(
        package / "urdf" / "cart.xacro",
        ("    </visual>\n\n  <link", "    </visual>\n  </link>\n\n  <link"),
        ("base link", "base_link"),
        (
            "    </link>\n  </xacro:macro>",
            '    </link>\n    <joint name="${name}_joint" type="continuous">\n'
            '      <parent link="base_link"/>\n      <child link="${name}_wheel"/>\n'
            '      <origin xyz="${x} ${y} 0"/>\n      <axis xyz="0 1 0"/>\n'
            "    </joint>\n  </xacro:macro>",
        ),
        ('<origin xyz="${x} ${y} 0" rpy', "<origin rpy"),
    )
    replace(
        package / "launch" / "cart.launch.py",
        ("from launch.actions", "from launch import LaunchDescription\nfrom launch.actions"),
        ("robot_state+_publisher", "robot_state_publisher"),
    )

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, package / "urdf" / "cart.xacro")
            assert await model_misses("mend_a_launch", document) == []
        where = ("--package-path", str(folder / "src"))
        with started(endpoint, "launch", "cart_description", "cart.launch.py", *where):
            async with checking(endpoint) as checks:
                await graph_holds("mend_a_launch", checks)

    asyncio.run(run())


REPORTER = """\
import rclpy
from rclpy.node import Node
from weather_interfaces.msg import Report


class Reporter(Node):
    def __init__(self):
        super().__init__('reporter')
        self.publisher = self.create_publisher(Report, 'report', 10)
        self.create_timer(1.0, self.tell)

    def tell(self):
        self.publisher.publish(Report(sky='clear', degrees=21.5))


def main():
    rclpy.init()
    try:
        rclpy.spin(Reporter())
    except KeyboardInterrupt:
        pass
"""


def test_the_message_of_ones_own_is_published_as_its_lesson_asks_for(endpoint: str, tmp_path: Path):
    made = Workspace(tmp_path / "ws")
    made.create("pkg create --build-type ament_cmake weather_interfaces")
    made.create(
        "pkg create --build-type ament_python weather --dependencies rclpy weather_interfaces"
    )
    made.write("weather_interfaces/msg/Report.msg", "string sky\nfloat64 degrees\n")
    made.change(
        "weather_interfaces/CMakeLists.txt",
        (
            "ament_package()",
            "find_package(rosidl_default_generators REQUIRED)\n"
            'rosidl_generate_interfaces(${PROJECT_NAME} "msg/Report.msg")\nament_package()',
        ),
    )
    made.write("weather/weather/reporter.py", REPORTER)
    entry = "        'console_scripts': [\n"
    made.change(
        "weather/setup.py", (entry, f"{entry}            'reporter = weather.reporter:main',\n")
    )

    async def run() -> None:
        where = ("--package-path", str(made.src))
        with started(endpoint, "run", "weather", "reporter", *where):
            async with checking(endpoint) as checks:
                await graph_holds("own_interface", checks)

    asyncio.run(run())
