"""The checks of the course's lessons, beside the demos that they are about."""

from __future__ import annotations

import asyncio
import shlex
import sys
from contextlib import ExitStack, asynccontextmanager
from typing import TYPE_CHECKING

import pytest

from studio.course.demos import LESSONS
from studio.course.lessons.checks import Concern
from studio.course.lessons.files import write_files
from studio.course.lessons.shelf import EXERCISES, Shelf
from studio.documents.engine import Engine
from studio.documents.lessons.graph_checks import GraphChecks
from studio.documents.lessons.model_checks import model_verdict
from studio.live.connection.ros_connection import RosConnection
from studio.live.panels.lessons import CourseDemos
from studio.protocol.connection import ConnectWire, PublishRobot
from studio.protocol.lessons import GetDemos, StartDemo, StopDemo
from studio.ros.type_lookup import known_service
from studio.settings import Settings, WireChoice, repository_or_wheel
from tests.support.demos import running
from tests.support.open_documents import engine, opened
from tests.support.sweep import some_of
from tests.support.wire import PATIENCE_S

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Sequence
    from pathlib import Path

    from studio.course.lessons.text import LessonText, Step
    from studio.documents.document import Document
    from studio.live.connection.link import WireLink

pytestmark = pytest.mark.network

COURSE = Shelf(repository_or_wheel("frontend_assets") / "lessons")
NAMES = [*LESSONS, *EXERCISES]

TOLD: dict[str, dict[int, Sequence[str]]] = {
    "my_first_node": {1: ["param set /my_node_name use_sim_time true"]},
    "my_tiny_node": {1: []},
    "talker": {1: ["start listener"]},
    "listener": {2: ["topic pub --rate 1 /chatter std_msgs/msg/Int32 'data: 3'"]},
    "subscriber_node": {1: ["stop publisher_node"]},
    "timer_node": {1: ["topic pub --rate 5 /timer_topic std_msgs/msg/String 'data: hello'"]},
    "number_publisher": {1: ["start number_counter"]},
    "number_counter": {1: ["topic pub --rate 1 /number std_msgs/msg/Int64 'data: 5'"]},
    "temperature_subscriber": {1: ["stop temperature_publisher"]},
    "qos_topic_node": {
        1: [
            "stop qos_topic_node",
            "run my_robot_package qos_topic_node --ros-args -p "
            "qos_overrides./reliable_topic.publisher.durability:=transient_local",
        ]
    },
    "adder_server": {1: []},
    "adder_client": {1: ["ended adder_client", "stop adder_server", "start adder_client"]},
    "service_server_node": {1: []},
    "service_client_node": {
        1: ["ended service_client_node", "stop service_server_node", "start service_client_node"]
    },
    "now_playing_server": {1: []},
    "now_playing_client": {
        1: ["ended now_playing_client", "stop now_playing_server", "start now_playing_client"]
    },
    "add_points_server": {1: []},
    "radio_dj": {1: ["param set /action_server_node step_seconds 0.1"]},
    "parameter_node": {1: ["param set /parameter_node max_velocity 0.5"]},
    "turtlesim_node": {
        1: ["service call /spawn turtlesim/srv/Spawn '{x: 2, y: 2}'"],
        2: ["param set /turtlesim background_r 200"],
    },
    "jerry_robot": {
        1: [
            "topic pub --once /jerry_command pkg_with_interfaces/msg/JerryCommand "
            "'{direction: left, steps: 3}'"
        ]
    },
    "rover": {2: ["param set /rover autopilot false"]},
    "transform_point": {1: [], 2: []},
    "lifecycle_talker": {
        1: ["lifecycle set /lc_talker configure"],
        2: ["lifecycle set /lc_talker activate"],
    },
    "temperature_pair": {
        1: [
            "stop temperature_publisher",
            "stop temperature_subscriber",
            "run my_robot_package temperature_publisher --ros-args -r __node:=my_thermometer",
        ],
        2: ["run my_robot_package temperature_subscriber --ros-args -r __node:=my_watch"],
    },
    "qos_experiment": {
        1: [
            "topic pub --rate 1 --qos-reliability best_effort /experiment std_msgs/msg/String "
            "'data: hello'",
            "topic echo --qos-reliability reliable /experiment std_msgs/msg/String",
        ],
        2: [
            "end",
            "topic pub --rate 1 --qos-reliability reliable /experiment std_msgs/msg/String "
            "'data: hello'",
            "topic echo --qos-reliability best_effort /experiment std_msgs/msg/String",
        ],
    },
    "own_add_two_ints": {
        1: [
            "stop service_server_node",
            "run my_robot_package service_server_node --ros-args -r __node:=my_adder",
        ],
        2: [],
    },
}
"""What a lesson tells to do, by the number of the step that it leads to: lines of `studio`, or a
demo to start, to stop or to wait for; `end` ends those lines. Steps that look at panels alone are
not here.
"""


class Reader:
    """Does what a lesson says, and looks at its checks of the graph."""

    def __init__(
        self, endpoint: str, demos: CourseDemos, checks: GraphChecks, link: WireLink
    ) -> None:
        self._link = link
        self._endpoint, self._demos, self._checks = endpoint, demos, checks
        self._lines = ExitStack()

    async def do(self, line: str) -> None:
        """Start or stop a demo, or wait for its end, or run a line of `studio`."""
        verb, *words = shlex.split(line)
        if verb == "start":
            await self._demos.start(StartDemo(demo=words[0]))
        elif verb == "stop":
            await self._demos.stop(StopDemo(demo=words[0]))
        elif verb == "ended":
            await self._ended(words[0])
        elif verb == "end":
            self.close()
        elif verb == "form":  # as the panel Services does, which asks the server for its type
            name, kind = words
            async with asyncio.timeout(PATIENCE_S):
                while not self._link.graph.servers(name):  # noqa: ASYNC110
                    await asyncio.sleep(0.02)
            await asyncio.to_thread(known_service, self._link.node, name, kind, print)
        else:
            words = [sys.executable, "-m", "studio", verb, *words]
            self._lines.enter_context(running(words, self._endpoint, warm=False))

    async def _ended(self, demo: str) -> None:
        """Wait until a client has its answer, and has ended."""
        async with asyncio.timeout(PATIENCE_S):
            while demo in await self._under_way():  # noqa: ASYNC110 - nothing tells us when
                await asyncio.sleep(0.02)

    async def _under_way(self) -> set[str]:
        told = await self._demos.demos(GetDemos())
        return {one.demo for one in told.demos if one.state not in {"ended", "stopped"}}

    async def sees(self, step: Step, *missing: str) -> None:
        """Wait until its checks of the graph hold at once, all but those that shall not."""
        checks = [one for one in step.checks if one.concern is Concern.GRAPH]
        left: dict[str, str] = {}
        try:
            async with asyncio.timeout(PATIENCE_S):
                while True:
                    lines = {one.line for one in checks}
                    found = await self._checks.verdicts(checks, may_call=lines)
                    left = {line: one.code for line, one in found.items() if not one.ok}
                    if left.keys() == set(missing):
                        return
                    await asyncio.sleep(0.05)
        except TimeoutError:
            pytest.fail(f"These do not hold: {left}")

    def close(self) -> None:
        """End what runs in its terminals."""
        self._lines.close()


@asynccontextmanager
async def reading(endpoint: str, name: str) -> AsyncGenerator[tuple[Reader, LessonText]]:
    """Who reads a lesson, whose demos are started one after the other."""
    wire = RosConnection(WireChoice("off", (endpoint,)))
    link = await wire.link()
    demos, checks = CourseDemos(wire), GraphChecks(link)
    reader, text = Reader(endpoint, demos, checks, link), COURSE.find(name).read()
    try:
        for demo in [*text.needs, *({name} & LESSONS.keys())]:
            await reader.do(f"start {demo}")
        yield reader, text
    finally:
        reader.close()
        await demos.close()
        await checks.close()
        await wire.close()


NO_DEMOS = {"find_the_wheel", "mend_a_node", "mend_a_package"}
"""Lessons whose first step is about a robot, or about what the reader has mended."""


@pytest.mark.parametrize("name", some_of([one for one in NAMES if one not in NO_DEMOS], 20))
def test_the_first_step_holds_when_the_demos_run(endpoint: str, name: str):
    async def run() -> None:
        async with reading(endpoint, name) as (reader, text):
            await reader.sees(text.steps[0])

    asyncio.run(run())


MENDED = {
    "mend_a_package": {
        "src/harbor/setup.py": [("harbor.server_node", "harbor.tide_server_node")],
        "src/harbor_interfaces/srv/Tide.srv": [("high float64", "high\nfloat64")],
        "src/harbor_interfaces/package.xml": [("ament_cmake/build", "ament_cmake</build")],
    },
}
"""What the reader mends."""
STARTED = {
    "mend_a_package": [
        "run harbor tide_server --package-path {folder}/src",
        "form /tide harbor_interfaces/srv/Tide",
    ],
}


@pytest.mark.parametrize("name", MENDED)
def test_a_step_holds_once_the_files_of_the_lesson_are_mended(
    endpoint: str, name: str, tmp_path: Path
):
    folder = tmp_path / name
    write_files(repository_or_wheel("frontend_assets") / "lessons", name, folder)
    for path, edits in MENDED[name].items():
        text = (folder / path).read_text()
        for old, new in edits:
            assert old in text
            text = text.replace(old, new)
        (folder / path).write_text(text)

    async def run() -> None:
        async with reading(endpoint, name) as (reader, text):
            for line in STARTED[name]:
                await reader.do(line.format(folder=folder))
            for step in text.steps:
                await reader.sees(step)

    asyncio.run(run())


@pytest.mark.parametrize("name", some_of(TOLD, 40))
def test_later_steps_hold_once_it_is_done_what_the_lesson_says(endpoint: str, name: str):
    async def run() -> None:
        async with reading(endpoint, name) as (reader, text):
            await reader.sees(text.steps[0])
            for number, lines in TOLD[name].items():
                for line in lines:
                    await reader.do(line)
                await reader.sees(text.steps[number])

    asyncio.run(run())


@pytest.mark.sweep
def test_a_pair_that_is_wrong_is_seen_to_be_wrong(endpoint: str):
    async def run() -> None:
        async with reading(endpoint, "temperature_pair") as (reader, text):
            await reader.sees(text.steps[0])
            await reader.do(
                "run my_robot_package temperature_publisher --ros-args -r __node:=other"
            )
            _, rate, publishers, _ = (one.line for one in text.steps[0].checks)
            await reader.sees(text.steps[0], rate, publishers)

    asyncio.run(run())


@asynccontextmanager
async def engine_at(endpoint: str, data_folder: Path) -> AsyncGenerator[Engine]:
    """An engine that joins the router when it is asked to."""
    made = Engine(Settings(data_folder=data_folder, wire=WireChoice("off", (endpoint,))))
    try:
        yield made
    finally:
        await made.close()


async def missing_in(document: Document, step: Step) -> list[str]:
    """The checks of the model that do not hold."""
    await asyncio.gather(document.checks.settled(), document.robot_checks.settled())
    return [
        one.line
        for one in step.checks
        if one.concern is Concern.MODEL
        if not model_verdict(one.kind, one.values, document).ok
    ]


def test_the_wheels_become_larger_by_the_numbers_that_are_to_be_found(models: Path, tmp_path: Path):
    file = models / "rover_description" / "urdf" / "rover.urdf.xacro"
    seen, larger, apart = COURSE.find("find_the_wheel").read().steps

    async def run() -> None:
        async with engine(tmp_path) as made:
            document, ear = await opened(made, file)
            assert await missing_in(document, seen) == []
            assert await missing_in(document, larger) == ["property wheel_radius is 0.2"]
            values = {"wheel_radius": "0.2", "wheel_base": "0.5", "wheel_width": "0.06"}
            for name, value in values.items():
                assert len(await missing_in(document, apart)) > 0
                await document.edits.edit_site(ear.site(name)["id"], value, name)
            assert await missing_in(document, larger) == []
            assert await missing_in(document, apart) == []

    asyncio.run(run())


def test_r2d2_hangs_in_odom_when_it_does_not_stand_and_is_published(
    endpoint: str, models: Path, tmp_path: Path
):
    file = models / "r2d2_description" / "urdf" / "r2d2.urdf.xacro"
    drives = COURSE.find("state_publisher").read().steps[2]

    async def run() -> None:
        async with (
            reading(endpoint, "r2d2_in_odom") as (reader, text),
            engine_at(endpoint, tmp_path) as made,
        ):
            _, hangs, leads = text.steps
            document, ear = await opened(made, file)
            assert await missing_in(document, hangs) == ["argument stands is false"]
            await document.edits.pass_arguments({"stands": "false"})
            assert await missing_in(document, hangs) == []
            assert await missing_in(document, drives) == []
            await made.execute(ConnectWire(), ear)
            await made.execute(PublishRobot(document=document.id, running=True), ear)
            await reader.sees(leads)

    asyncio.run(run())
