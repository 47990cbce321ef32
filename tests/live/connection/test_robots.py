"""Robots that are found on the wire and opened from it, and the way to it and back."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import CommandError, NoRouterError, NotServedError, WireSettingsError
from studio.live.connection import robots
from studio.nodes.robot_state_publisher import LATCHED
from studio.protocol.connection import (
    ConnectWire,
    DisconnectWire,
    ExamineWire,
    FindWireRobots,
    OpenFromWire,
    PublishJoints,
    PublishRobot,
    SetJointSource,
)
from studio.protocol.robot import SetJoints
from studio.ros.messages import message
from studio.ros.parameters.parameter import Parameter
from tests.support.open_documents import until
from tests.support.wire import free_endpoint
from tests.support.wired_studio import ARM, STRING, joint_states_of, studio

if TYPE_CHECKING:
    from pathlib import Path

    from studio.ros.client import Node

pytestmark = pytest.mark.network


def test_robots_on_the_wire_are_found_and_our_own_is_not_among_them(
    endpoint: str, tester: Node, tmp_path: Path
):
    tester.create_publisher(message(STRING), "/one/robot_description", LATCHED)
    tester.create_publisher(message(STRING), "/chatter", 10)

    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            await one.do(PublishRobot(running=True))
            await one.do(FindWireRobots())
            assert one.ear.last("wire_robots")["topics"] == ["/one/robot_description"]
            assert one.ear.last("wire_robots")["nodes"] == []
            await one.do(ConnectWire())
            assert one.ear.last("wire_state")["state"] == "connected"

    asyncio.run(run())


def test_a_robot_opens_from_a_topic_and_follows_what_it_tells(
    endpoint: str, tester: Node, tmp_path: Path
):
    urdf = ARM.replace("${reach}", "0.5")
    text = message(STRING)
    out = tester.create_publisher(text, "/other/robot_description", LATCHED)
    out.publish(text(data=urdf))
    tell = joint_states_of(tester)

    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            await one.do(OpenFromWire(topic="/other/robot_description"))
            made = one.engine.document(one.ear.last("opened")["document"])
            await made.opened()
            assert list(made.model.robot.links) == ["base", "upper", "tip"]
            await until(lambda: made.model.joints.by_name() == {"shoulder": 0.5} or tell(0.5))
            out.publish(text(data=urdf.replace('name="tip"', 'name="hand"')))
            out.publish(text(data=urdf.replace('"tip"', '"hand"')))
            await until(lambda: "hand" in made.model.robot.links)
            with pytest.raises(CommandError, match="comes from /other/robot_description"):
                await made.feed.publish_robot(running=True)

    asyncio.run(run())


def test_a_robot_opens_from_the_parameter_of_a_node_and_follows_its_changes(
    endpoint: str, tester: Node, tmp_path: Path
):
    urdf = ARM.replace("${reach}", "0.5")
    tester.declare_parameter("robot_description", urdf)

    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            await one.do(OpenFromWire(node="/tester"))
            made = one.engine.document(one.ear.last("opened")["document"])
            await made.opened()
            changed = Parameter("robot_description", value=urdf.replace('"tip"', '"hand"'))
            await asyncio.to_thread(tester.set_parameters, [changed])
            await until(lambda: "hand" in made.model.robot.links)
            with pytest.raises(NotServedError):
                await one.do(OpenFromWire(node="/nobody"))

    asyncio.run(run())


def test_a_topic_on_which_nobody_tells_a_robot_is_said(
    endpoint: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(robots, "_FIRST_PATIENCE_S", 0.2)

    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            with pytest.raises(CommandError, match="No description came from /nobody"):
                await one.do(OpenFromWire(topic="/nobody"))

    asyncio.run(run())


def test_who_disconnects_ends_what_goes_out_and_comes_in_and_may_connect_again(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            await one.do(PublishRobot(running=True))
            await one.do(PublishJoints(running=True))
            await one.do(SetJointSource(source="tf"))
            await one.do(DisconnectWire())
            assert one.ear.last("wire_state")["state"] == "off"
            feed = one.ear.last("wire_feed")
            assert (feed["publishes_robot"], feed["publishes_joints"]) == (False, False)
            assert feed["source"] == "sliders"
            await one.do(SetJoints(positions={"shoulder": 0.25}))
            await until(lambda: tester.get_node_names() == ["tester"])
            await one.do(DisconnectWire())
            await one.do(PublishRobot(running=True))
            assert one.ear.last("wire_state")["state"] == "connected"
            await until(lambda: "robot_state_publisher" in tester.get_node_names())

    asyncio.run(run())


def test_another_place_is_joined_at_run_time_and_looking_at_one_joins_nothing(
    endpoint: str, tester: Node, tmp_path: Path
):
    tester.create_publisher(message(STRING), "/chatter", 10)

    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            await one.do(ConnectWire(domain=41))
            assert (one.ear.last("wire_state")["domain"], one.ear.last("wire_state")["nodes"]) == (
                41,
                [],
            )
            await one.do(ExamineWire())
            report = one.ear.last("wire_report")
            assert (report["verdict"], report["domains"]) == (
                "other_domain",
                [{"domain": 0, "nodes": 1}],
            )
            await one.do(ConnectWire(domain=0))
            await until(lambda: one.ear.last("wire_state")["node_count"] == 1)
            assert one.ear.last("wire_state")["domain"] == 0
            with pytest.raises(NoRouterError):
                await one.do(ConnectWire(address=free_endpoint()))
            assert one.ear.last("wire_state")["state"] == "failed"
            with pytest.raises(WireSettingsError):
                await one.do(ConnectWire(address="what is this"))
            await one.do(ConnectWire(address=endpoint))
            assert one.ear.last("wire_state")["state"] == "connected"

    asyncio.run(run())
