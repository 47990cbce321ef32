"""A document's robot on the wire: heard by others, moved by others, and one source at a time."""

from __future__ import annotations

import asyncio
import math
import sys
import time
from contextlib import asynccontextmanager
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import pytest

from studio.engine import messages as m
from studio.engine.engine import Engine
from studio.engine.messages.wire import (
    ConnectWire,
    FindWireRobots,
    OpenFromWire,
    PublishJoints,
    PublishRobot,
    SetJointSource,
)
from studio.errors import CommandError, NotServedError
from studio.nodes.robot_state_publisher import LATCHED
from studio.ros.messages import message
from studio.ros.parameters.parameter import Parameter
from studio.settings import Settings, WireChoice
from tests.support.demos import RunningDemo, heard, node_at, running
from tests.support.open_documents import opened, until
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Callable, Generator
    from pathlib import Path

    from studio.engine.document import Document
    from studio.engine.messages import Command
    from studio.ros.client import Node, Publisher
    from tests.support.open_documents import Ear

pytestmark = [pytest.mark.network, pytest.mark.timeout(180)]

ARM = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="reach" value="0.5"/>
  <link name="base"/><link name="upper"/><link name="tip"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="mount" type="fixed"><parent link="upper"/><child link="tip"/>
    <origin xyz="${reach} 0 0"/></joint>
</robot>"""
STRING, TF, STATES = "std_msgs/msg/String", "tf2_msgs/msg/TFMessage", "sensor_msgs/msg/JointState"


@pytest.fixture(scope="module")
def endpoint() -> Generator[str]:
    with running_router() as found:
        yield found


@pytest.fixture
def tester(endpoint: str) -> Generator[Node]:
    with node_at(endpoint) as node:
        yield node


class Studio:
    """An engine with one open robot, and a page's ear at both."""

    def __init__(self, engine: Engine, document: Document, ear: Ear) -> None:
        self.engine, self.document, self.ear = engine, document, ear

    async def do(self, command: Command) -> None:
        asked = command.model_copy(update={"document": self.document.id})
        await self.engine.execute(asked, self.ear)

    def position(self, joint: str) -> float:
        return self.document.model.joints.by_name()[joint]


@asynccontextmanager
async def studio(endpoint: str, folder: Path) -> AsyncGenerator[Studio]:
    """The arm, open in an engine that joins the router when asked to."""
    file = folder / "arm.urdf.xacro"
    file.write_text(ARM)
    settings = Settings(data_folder=folder / "data", wire=WireChoice("off", (endpoint,)))
    settings.data_folder.mkdir()
    made = Engine(settings)
    await made.start()
    try:
        document, ear = await opened(made, file)
        made.attach(ear)
        yield Studio(made, document, ear)
    finally:
        await made.close()


def states_out(tester: Node) -> Publisher:
    return tester.create_publisher(message(STATES), "/joint_states", 10)


def test_d8_a_subscriber_in_another_process_gets_the_latched_description_and_tf(
    endpoint: str, tmp_path: Path
):
    def echo(topic: str) -> list[str]:
        place = ["--connect", endpoint, "--router", "off"]
        return [sys.executable, "-m", "studio", "topic", "echo", "--once", topic, *place]

    async def hears(topic: str, text: str) -> None:
        with running(echo(topic), endpoint) as listener:
            await until(lambda: text in listener.printed or has_ended(listener))
            assert text in listener.printed, listener.printed

    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            await one.do(PublishRobot(running=True))
            await hears("/robot_description", "robot name=")
            await hears("/tf_static", "child_frame_id: tip")
            await hears("/tf", "child_frame_id: upper")

    asyncio.run(run())


def has_ended(process: RunningDemo) -> bool:
    return process.process.poll() is not None


def test_d9_joint_states_come_at_more_than_10_hz_while_nothing_moves(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        states = heard(tester, STATES, "/joint_states")
        async with studio(endpoint, tmp_path) as one:
            await one.do(PublishJoints(running=True))
            await until(lambda: len(states) > 20)
            await one.do(PublishJoints(running=False))
        stamps_s = [one.header.stamp.sec + one.header.stamp.nanosec / 1e9 for one in states]
        assert (len(stamps_s) - 1) / (stamps_s[-1] - stamps_s[0]) > 10
        assert (states[0].name, states[0].position.tolist()) == (["shoulder"], [0.0])

    asyncio.run(run())


def test_d9_a_joint_that_is_moved_is_told_in_joint_states_and_tf(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        states, moving = heard(tester, STATES, "/joint_states"), heard(tester, TF, "/tf")
        async with studio(endpoint, tmp_path) as one:
            await one.do(PublishJoints(running=True))
            await one.do(PublishRobot(running=True))
            await one.do(m.SetJoints(positions={"shoulder": 0.6}))
            await until(lambda: bool(states) and states[-1].position.tolist() == [0.6])
            half = math.sin(0.3)
            await until(
                lambda: (
                    bool(moving)
                    and math.isclose(moving[-1].transforms[0].transform.rotation.z, half)
                )
            )

    asyncio.run(run())


def test_while_somebody_drags_the_description_goes_out_twice_a_second_and_at_the_end(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        came: list[tuple[float, str]] = []

        def hear(told: Any) -> None:  # noqa: ANN401
            came.append((time.monotonic(), told.data))

        tester.create_subscription(message(STRING), "/robot_description", hear, LATCHED)
        async with studio(endpoint, tmp_path) as one:
            await one.do(PublishRobot(running=True))
            await until(lambda: bool(came))
            site = one.ear.site("reach")["id"]
            for step in range(60):
                await one.do(m.EditSite(site=site, text=f"0.{step + 10}", gesture="drag"))
                await asyncio.sleep(1 / 60)
            await until(lambda: "0.69" in came[-1][1])
        assert len(came) <= 2 + 2 * (came[-1][0] - came[0][0]) + 1
        assert all(later - sooner > 0.3 for (sooner, _), (later, _) in pairwise(came))

    asyncio.run(run())


@pytest.mark.parametrize("source", ["joint_states", "tf"])
def test_the_joints_follow_a_robot_that_runs_and_nobody_else_meanwhile(
    endpoint: str, tester: Node, tmp_path: Path, source: str
):
    async def run() -> None:
        tell = joint_states_of(tester) if source == "joint_states" else tf_of(tester)
        async with studio(endpoint, tmp_path) as one:
            await one.do(SetJointSource.model_validate({"source": source}))
            assert one.ear.last("wire_feed")["source_state"] == "waiting"
            await until(lambda: one.position("shoulder") == pytest.approx(-0.25) or tell(-0.25))
            await until(lambda: one.ear.last("wire_feed")["source_state"] == "live")
            for command in (m.SetJoints(positions={"shoulder": 1.0}), m.ZeroJoints()):
                with pytest.raises(CommandError, match="choose the sliders"):
                    await one.do(command)
            with pytest.raises(CommandError, match="follow /"):
                await one.do(m.AnimateJoints(running=True))
            await one.do(SetJointSource(source="sliders"))
            await one.do(m.SetJoints(positions={"shoulder": 1.0}))
            tell(-0.25)
            assert one.position("shoulder") == 1.0

    asyncio.run(run())


def joint_states_of(tester: Node) -> Callable[[float], bool]:
    """Tells a position; False, for it is asked for until it has come."""
    out = states_out(tester)

    def tell(position: float) -> bool:
        out.publish(message(STATES)(name=["shoulder", "strange"], position=[position, 0.0]))
        return False

    return tell


def tf_of(tester: Node) -> Callable[[float], bool]:
    out = tester.create_publisher(message(TF), "/tf", 10)
    stamped = message("geometry_msgs/msg/TransformStamped")

    def tell(position: float) -> bool:
        one = stamped(child_frame_id="upper")
        one.header.frame_id = "base"
        turn = one.transform.rotation
        turn.z, turn.w = math.sin(position / 2), math.cos(position / 2)
        out.publish(message(TF)(transforms=[one]))
        return False

    return tell


def test_what_is_told_and_what_is_followed_make_no_echo(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        tell = joint_states_of(tester)
        states = heard(tester, STATES, "/joint_states")
        async with studio(endpoint, tmp_path) as one:
            await one.do(PublishJoints(running=True))
            await until(lambda: bool(states))
            await one.do(SetJointSource(source="joint_states"))
            assert one.ear.last("wire_feed")["joints_paused"]
            names = tester.get_node_names_and_namespaces
            await until(lambda: "joint_state_publisher" not in dict(names()))
            await until(lambda: one.position("shoulder") == 0.5 or tell(0.5))
            await until(lambda: one.ear.last("wire_feed")["strangers"] == ["strange"])
            ours = [state for state in states if state.name == ["shoulder"]]
            assert all(state.position.tolist() == [0.0] for state in ours)
            await one.do(SetJointSource(source="sliders"))
            assert not one.ear.last("wire_feed")["joints_paused"]
            await until(lambda: states[-1].name == ["shoulder"])
            assert states[-1].position.tolist() == [0.5], "from where the other one left it"

    asyncio.run(run())


def test_another_node_that_publishes_the_same_is_named(endpoint: str, tester: Node, tmp_path: Path):
    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            await one.do(PublishJoints(running=True))
            assert one.ear.last("wire_feed")["rivals"] == []
            out = states_out(tester)
            await until(lambda: one.ear.last("wire_feed")["rivals"] == ["/tester"])
            tester.destroy_publisher(out)
            await until(lambda: one.ear.last("wire_feed")["rivals"] == [])

    asyncio.run(run())


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


def test_a_topic_on_which_nobody_tells_a_robot_is_said(endpoint: str, tmp_path: Path):
    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            with pytest.raises(CommandError, match="Nothing told a robot at /nobody"):
                await one.do(OpenFromWire(topic="/nobody"))

    asyncio.run(run())


def test_a_document_that_is_closed_while_it_connects_leaves_nothing_on(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            switched = asyncio.create_task(one.document.feed.publish_robot(running=True))
            await until(lambda: one.ear.last("wire_state")["state"] != "off")
            await one.engine.execute(m.CloseDocument(document=one.document.id), one.ear)
            await switched
            await until(lambda: not tester.get_publishers_info_by_topic("/robot_description"))

            def names() -> list[str]:
                return [name for name, _ in tester.get_node_names_and_namespaces()]

            await until(lambda: "studio" in names())
            assert "robot_state_publisher" not in names()

    asyncio.run(run())


def test_two_open_robots_do_not_publish_at_once(endpoint: str, tmp_path: Path):
    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            other = tmp_path / "other.urdf"
            other.write_text('<robot name="r"><link name="a"/></robot>')
            second, _ = await opened(one.engine, other)
            await one.do(PublishRobot(running=True))
            with pytest.raises(CommandError, match="Another open robot publishes"):
                await second.feed.publish_robot(running=True)
            await one.do(PublishRobot(running=False))
            await second.feed.publish_robot(running=True)
            await one.engine.execute(m.CloseDocument(document=second.id), one.ear)
            await one.do(PublishRobot(running=True))
            assert one.ear.last("wire_feed")["publishes_robot"]

    asyncio.run(run())
