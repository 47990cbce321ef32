"""Demos started and stopped from a page: real processes at a router of this machine."""

from __future__ import annotations

import asyncio
import os
import signal
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

import pytest

from studio.errors import CommandError
from studio.live.connection.ros_connection import RosConnection
from studio.live.panels import lessons
from studio.live.panels.lessons import CourseDemos
from studio.protocol.lessons import (
    DemoView,
    GetDemoOutput,
    GetDemos,
    PressKey,
    StartDemo,
    StopDemo,
)
from studio.settings import WireChoice
from tests.support.bridged import bridged
from tests.support.demos import call, node_at, running_demo
from tests.support.wire import PATIENCE_S, free_endpoint, router_at, wait_until

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator

pytestmark = pytest.mark.network


@asynccontextmanager
async def course_at(endpoint: str) -> AsyncGenerator[CourseDemos]:
    async with bridged(endpoint) as bridge:
        yield bridge.ros.lessons


async def view(course: CourseDemos, demo: str) -> DemoView:
    told = await course.demos(GetDemos())
    return next(one for one in told.demos if one.demo == demo)


async def seen(course: CourseDemos, demo: str, *states: str) -> DemoView:
    """Wait until a demo is in one of these states."""
    async with asyncio.timeout(PATIENCE_S):
        while (now := await view(course, demo)).state not in states:  # noqa: ASYNC110 - nothing tells us when
            await asyncio.sleep(0.02)
    return now


async def printed(course: CourseDemos, demo: str, words: str) -> tuple[str, ...]:
    """Wait until a demo has printed some words; gives all that is kept."""
    async with asyncio.timeout(PATIENCE_S):
        while True:
            lines = course.output(GetDemoOutput(demo=demo)).lines
            if any(words in line for line in lines):
                return lines
            await asyncio.sleep(0.02)


def pid_of(course: CourseDemos, demo: str) -> int:
    process = course._runs[demo]._process  # pyright: ignore[reportPrivateUsage]
    assert process is not None
    return process.pid


def state_of(desk: CourseDemos, demo: str) -> str:
    return desk._runs[demo].state  # pyright: ignore[reportPrivateUsage]


def is_there(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def test_a_demo_is_started_seen_heard_and_stopped(endpoint: str):
    async def run() -> None:
        async with course_at(endpoint) as course:
            assert (await course.demos(GetDemos(request=3))).demos == ()
            await course.start(StartDemo(demo="talker"))
            assert (await seen(course, "talker", "running")).code == 0
            assert (await course.demos(GetDemos())).elsewhere == ()
            assert "Hello World" in (await printed(course, "talker", "Publishing"))[0]
            with pytest.raises(CommandError, match="talker runs already"):
                await course.start(StartDemo(demo="talker"))
            await course.stop(StopDemo(demo="talker"))
            assert (await view(course, "talker")).state == "stopped"
            with pytest.raises(CommandError, match="does not run"):
                await course.stop(StopDemo(demo="talker"))

    asyncio.run(run())


def test_it_is_told_that_a_demo_began_printed_and_ended(endpoint: str):
    async def run() -> None:
        told: list[str] = []
        wire = RosConnection(WireChoice("off", (endpoint,)))
        await wire.link()
        desk = CourseDemos(wire, lambda: told.append(state_of(desk, "talker")))
        try:
            await desk.start(StartDemo(demo="talker"))
            assert told
            before = len(told)
            await printed(desk, "talker", "Publishing")
            assert len(told) > before
            await desk.stop(StopDemo(demo="talker"))
            assert told[-1] == "stopped"
        finally:
            await desk.close()
            await wire.close()

    asyncio.run(run())


def test_what_is_known_of_the_output_is_not_told_again_but_that_of_a_new_run_is(endpoint: str):
    async def run() -> None:
        async with course_at(endpoint) as course:
            assert course.output(GetDemoOutput(demo="basic_node")).run == 0
            await course.start(StartDemo(demo="basic_node"))
            await printed(course, "basic_node", "initialized")
            await course.stop(StopDemo(demo="basic_node"))
            first = course.output(GetDemoOutput(demo="basic_node"))
            assert first.last == len(first.lines) > 0
            known = GetDemoOutput(demo="basic_node", run=first.run, after=first.last)
            assert course.output(known).lines == ()
            await course.start(StartDemo(demo="basic_node"))
            await printed(course, "basic_node", "initialized")
            again = course.output(known)
            assert again.run != first.run
            assert len(again.lines) > 0

    asyncio.run(run())


def test_a_client_that_has_its_answer_ends_by_itself_with_what_it_said_last(endpoint: str):
    async def run() -> None:
        async with course_at(endpoint) as course:
            await course.start(StartDemo(demo="adder_client"))
            await printed(course, "adder_client", "waiting again")
            await course.start(StartDemo(demo="adder_server"))
            ended = await seen(course, "adder_client", "ended")
            assert ended.code == 0
            assert "41 + 1 = 42" in ended.reason

    asyncio.run(run())


def test_one_that_is_killed_from_outside_says_so_and_can_be_started_again(endpoint: str):
    async def run() -> None:
        async with course_at(endpoint) as course:
            await course.start(StartDemo(demo="talker"))
            os.kill(pid_of(course, "talker"), signal.SIGKILL)
            ended = await seen(course, "talker", "ended")
            assert ended.code == -signal.SIGKILL
            await course.start(StartDemo(demo="talker"))
            await seen(course, "talker", "running")

    asyncio.run(run())


def test_keys_drive_the_demo_that_takes_them_and_no_other(endpoint: str):
    async def run() -> None:
        async with course_at(endpoint) as course:
            await course.start(StartDemo(demo="turtle_teleop_key"))
            await printed(course, "turtle_teleop_key", "Arrow keys")
            course.press(PressKey(demo="turtle_teleop_key", pressed="up"))
            course.press(PressKey(demo="turtle_teleop_key", pressed="q"))
            assert (await seen(course, "turtle_teleop_key", "ended")).code == 0
            with pytest.raises(CommandError, match="does not run"):
                course.press(PressKey(demo="turtle_teleop_key", pressed="up"))
            await course.start(StartDemo(demo="my_first_node"))
            with pytest.raises(CommandError, match="not driven by keys"):
                course.press(PressKey(demo="my_first_node", pressed="up"))

    asyncio.run(run())


def test_a_node_that_somebody_else_started_is_told_and_has_no_twin(endpoint: str):
    async def run() -> None:
        async with course_at(endpoint) as course:
            async with asyncio.timeout(PATIENCE_S):
                while not (told := await course.demos(GetDemos())).elsewhere:  # noqa: ASYNC110
                    await asyncio.sleep(0.02)
            assert told.elsewhere == ("talker",)
            with pytest.raises(CommandError, match="/topic_helloworld_pub is there already"):
                await course.start(StartDemo(demo="talker"))

    with running_demo(endpoint, "talker"):
        asyncio.run(run())


def test_no_more_than_the_most_run_at_once(endpoint: str, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(lessons, "RUNNING_MAX", 1)

    async def run() -> None:
        async with course_at(endpoint) as course:
            await course.start(StartDemo(demo="my_first_node"))
            with pytest.raises(CommandError, match="1 demos run already: stop one"):
                await course.start(StartDemo(demo="basic_node"))

    asyncio.run(run())


def test_without_a_connection_or_such_a_demo_nothing_starts():
    async def run() -> None:
        course = CourseDemos(RosConnection(WireChoice("off")))
        assert (await course.demos(GetDemos())).elsewhere == ()
        with pytest.raises(CommandError, match="Not connected to ROS 2: connect first"):
            await course.start(StartDemo(demo="talker"))
        for name in ("os", "../talker", "studio.cli", ""):
            with pytest.raises(CommandError, match="No demo is called"):
                await course.start(StartDemo(demo=name))
            with pytest.raises(CommandError, match="No demo is called"):
                course.output(GetDemoOutput(demo=name))

    asyncio.run(run())


def test_while_the_router_is_gone_nothing_starts():
    async def run() -> None:
        place = free_endpoint()
        router = router_at(place)
        async with course_at(place) as course:
            link = course._wire.current  # pyright: ignore[reportPrivateUsage]
            assert link is not None
            router.close()
            await asyncio.to_thread(wait_until, "it is gone", lambda: not link.is_connected)
            with pytest.raises(CommandError, match="is gone: a demo would meet nobody"):
                await course.start(StartDemo(demo="talker"))

    asyncio.run(run())


def test_all_end_when_the_connection_is_let_go_and_none_starts_after_the_end(endpoint: str):
    async def run() -> None:
        async with bridged(endpoint) as bridge:
            course = bridge.ros
            for demo in ("talker", "add_points_client"):
                await course.lessons.start(StartDemo(demo=demo))
            pids = [pid_of(course.lessons, demo) for demo in ("talker", "add_points_client")]
            await course.let_go()
            assert not any(map(is_there, pids))
            await course.close()
            with pytest.raises(CommandError, match="connect first"):
                await course.lessons.start(StartDemo(demo="talker"))

    asyncio.run(run())


def test_a_demo_serves_others_at_the_same_router(endpoint: str):
    async def run() -> None:
        async with course_at(endpoint) as course:
            await course.start(StartDemo(demo="adder_server"))
            await seen(course, "adder_server", "running")
            kind = "learning_interface/srv/AddTwoInts"
            with node_at(endpoint) as tester:
                answer = await asyncio.to_thread(call, tester, kind, "/add_two_ints", a=2, b=3)
            assert answer.sum == 5

    asyncio.run(run())


def test_a_demo_is_in_the_domain_of_the_studio_not_in_that_of_its_environment(
    endpoint: str, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("ROS_DOMAIN_ID", "3")

    async def run() -> None:
        wire = RosConnection(WireChoice("off", (endpoint,), domain=41))
        course = CourseDemos(wire)
        try:
            await wire.link()
            await course.start(StartDemo(demo="talker"))
            # It is seen in the graph of domain 41, or never.
            await seen(course, "talker", "running")
        finally:
            await course.close()
            await wire.close()

    asyncio.run(run())
