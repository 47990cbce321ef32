"""Pause, reset, and the time of the view, with messages of a real router."""

from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING, Any

import pytest

from studio.nodes.robot_state_publisher import LATCHED
from studio.protocol.connection import SetJointSource
from studio.protocol.displays import AddDisplay, SetDisplayProperty, SetFixedFrame
from studio.protocol.scene_time import GetSceneTime, PauseScene, ResetScene
from studio.protocol.tools import UseTool
from studio.ros.messages import message
from studio.rviz.tools import POINT, POSE_WITH_COVARIANCE
from tests.live.displays.test_document_displays import (
    NOW_S,
    POSE,
    is_at,
    listed,
    places,
    pose_at,
    said,
    transform,
)
from tests.support.demos import heard
from tests.support.open_documents import until
from tests.support.wired_studio import STATES, TF, Studio, studio

if TYPE_CHECKING:
    from pathlib import Path

    from studio.ros.client import Node

pytestmark = pytest.mark.network

CLOCK = "rosgraph_msgs/msg/Clock"


def received(one: Studio) -> int:
    """Messages that came for the first display."""
    return one.ear.last("display_states")["states"][0]["received"]


async def time_of(one: Studio) -> dict[str, Any]:
    await one.do(GetSceneTime())
    return one.ear.last("scene_time")


def at(second: int) -> Any:  # noqa: ANN401
    tick = message(CLOCK)()
    tick.clock.sec = second
    return tick


def test_a_pause_leaves_the_view_as_it_is_and_what_came_meanwhile_is_drawn_after_it(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        poses = tester.create_publisher(message(POSE), "/aim", 10)
        tf = tester.create_publisher(message(TF), "/tf", 100)
        async with studio(endpoint, tmp_path) as one:
            await one.do(AddDisplay(kind="Pose", topic="/aim"))
            await one.do(SetFixedFrame(frame="odom"))
            await until(
                lambda: bool(poses.get_subscription_count() and tf.get_subscription_count())
            )
            tf.publish(transform("odom", "base", 1.0))
            poses.publish(pose_at("odom", 2.0))
            await until(lambda: said(one) == [""])
            await one.do(PauseScene(paused=True))
            assert one.ear.last("live_displays")["paused"]
            before = await places(one)
            poses.publish(pose_at("base", 0.0))
            tf.publish(transform("odom", "base", 5.0, NOW_S + 1))
            await until(lambda: received(one) == 2)
            assert await places(one) == before
            await one.do(SetDisplayProperty(display="d1", name="Alpha", value=0.5))
            await is_at(one, [1.0, 0.0, 0.0])  # who changes a display sees the change
            poses.publish(pose_at("odom", 2.0))
            await until(lambda: received(one) == 3)
            assert [1.0, 0.0, 0.0] in await places(one)
            await one.do(PauseScene(paused=False))
            async with asyncio.timeout(60):
                while [1.0, 0.0, 0.0] in await places(one):  # noqa: ASYNC110 - nothing tells us when
                    await asyncio.sleep(0.02)
            assert not one.ear.last("live_displays")["paused"]

    asyncio.run(run())


def test_a_reset_drops_what_came_and_takes_what_is_latched_once_more(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        once = tester.create_publisher(message(POSE), "/kept_aim", LATCHED)
        poses = tester.create_publisher(message(POSE), "/aim", 10)
        fixed = tester.create_publisher(message(TF), "/tf_static", LATCHED)
        once.publish(pose_at("odom", 1.0))
        fixed.publish(transform("odom", "base", 1.0))
        async with studio(endpoint, tmp_path) as one:
            await one.do(AddDisplay(kind="Pose", topic="/kept_aim"))
            await one.do(AddDisplay(kind="Pose", topic="/aim"))
            await one.do(SetFixedFrame(frame="odom"))
            await until(lambda: bool(poses.get_subscription_count()))
            poses.publish(pose_at("odom", 2.0))
            await until(lambda: said(one) == [""] and said(one, 1) == [""])
            count = len(one.ear.events)
            await one.do(ResetScene())
            await until(lambda: said(one) == [""] and said(one, 1) == ["no_message"])
            assert len(one.ear.events) > count
            await until(lambda: one.ear.last("display_states")["fixed_frame"]["level"] == "ok")
            assert [each["topic"] for each in listed(one)] == ["/kept_aim", "/aim"]

    asyncio.run(run())


def test_the_time_is_that_of_the_clock_topic_stands_in_a_pause_and_begins_anew_with_a_reset(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            told = await time_of(one)
            assert (told["from_clock"], told["ros_elapsed_s"]) == (False, 0.0)
            assert told["ros_s"] == told["wall_s"]
            await one.do(AddDisplay(kind="Pose", topic="/aim"))  # connects
            clock = tester.create_publisher(message(CLOCK), "/clock", 10)
            await until(lambda: bool(clock.get_subscription_count()))
            await hears(one, clock, 500)
            await hears(one, clock, 512)
            assert (await time_of(one))["ros_elapsed_s"] == 12.0
            await one.do(PauseScene(paused=True))
            clock.publish(at(530))
            assert (await time_of(one))["ros_s"] == 512.0
            await one.do(PauseScene(paused=False))
            await hears(one, clock, 530)
            await one.do(ResetScene())
            await until(lambda: bool(clock.get_subscription_count()))
            await hears(one, clock, 540)
            told = await time_of(one)
            assert told["ros_elapsed_s"] == 0.0
            assert told["wall_elapsed_s"] < 60.0
            tester.destroy_publisher(clock)
            async with asyncio.timeout(60):
                while (await time_of(one))["from_clock"]:  # noqa: ASYNC110 - nothing tells us when
                    await asyncio.sleep(0.02)

    asyncio.run(run())


async def hears(one: Studio, clock: Any, second: int) -> None:  # noqa: ANN401
    """Tell a time until it is the studio's."""
    async with asyncio.timeout(60):
        while (await time_of(one))["ros_s"] != float(second):
            clock.publish(at(second))
            await asyncio.sleep(0.02)


def test_what_tools_send_is_stamped_with_wall_time_and_with_that_of_the_clock_topic_where_it_is(
    endpoint: str, tester: Node, tmp_path: Path
):
    told = {
        "SetInitialPose": heard(tester, POSE_WITH_COVARIANCE, "/initialpose"),
        "PublishPoint": heard(tester, POINT, "/clicked_point"),
    }

    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            tools = {each.kind: each.id for each in one.document.live.tools.list}

            async def stamp_s(kind: str) -> int:
                before = len(told[kind])
                await one.do(UseTool(tool=tools[kind], x=1.0, y=2.0))
                await until(lambda: len(told[kind]) > before)
                return told[kind][-1].header.stamp.sec

            for kind in told:
                assert abs(await stamp_s(kind) - time.time_ns() / 1e9) < 60
            clock = tester.create_publisher(message(CLOCK), "/clock", 10)
            beat = tester.create_timer(0.02, lambda: clock.publish(at(100)))
            link = await one.engine.ros.connection.link()
            await until(lambda: bool(link.graph.publishers("/clock")))
            for kind in told:
                assert await stamp_s(kind) == 100
            tester.destroy_timer(beat)

    asyncio.run(run())


def test_a_robot_that_follows_joint_states_stands_still_in_a_pause(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        out = tester.create_publisher(message(STATES), "/joint_states", 10)
        poses = tester.create_publisher(message(POSE), "/aim", 10)
        async with studio(endpoint, tmp_path) as one:
            await one.do(AddDisplay(kind="Pose", topic="/aim"))
            await one.do(SetJointSource(source="joint_states"))
            await until(lambda: bool(poses.get_subscription_count()))
            async with asyncio.timeout(60):
                while one.position("shoulder") != 0.5:
                    out.publish(turned(0.5))
                    await asyncio.sleep(0.02)
            await one.do(PauseScene(paused=True))
            out.publish(turned(-0.5))
            poses.publish(pose_at("base", 0.0))  # comes after it
            await until(lambda: one.ear.last("display_states")["states"][0]["received"] == 1)
            assert one.position("shoulder") == 0.5
            await one.do(PauseScene(paused=False))
            await until(lambda: one.position("shoulder") == -0.5)

    asyncio.run(run())


def turned(position: float) -> Any:  # noqa: ANN401
    return message(STATES)(name=["shoulder"], position=[position])
