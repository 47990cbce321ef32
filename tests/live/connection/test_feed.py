"""A document's robot on the wire: heard by others, moved by others, and one source at a time."""

from __future__ import annotations

import asyncio
import math
import sys
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import CommandError
from studio.nodes.robot_state_publisher import LATCHED
from studio.protocol.connection import PublishJoints, PublishRobot, SetJointSource
from studio.protocol.documents import CloseDocument
from studio.protocol.edits import EditSite
from studio.protocol.robot import AnimateJoints, SetJoints, ZeroJoints
from studio.ros.messages import message
from tests.support.demos import RunningDemo, call, heard, running
from tests.support.open_documents import opened, until
from tests.support.wired_studio import (
    STATES,
    STRING,
    TF,
    joint_states_of,
    states_out,
    studio,
    tf_of,
)

if TYPE_CHECKING:
    from pathlib import Path

    from studio.ros.client import Node
    from studio.ros.node.samples import MessageInfo

pytestmark = pytest.mark.network


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


def test_a_prefix_that_is_set_stands_before_all_frames_that_are_told(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        moving, still = heard(tester, TF, "/tf"), heard(tester, TF, "/tf_static", LATCHED)
        async with studio(endpoint, tmp_path) as one:
            await one.do(PublishRobot(running=True))
            await until(lambda: ("base", "upper") in edges(moving))
            kind = message("rcl_interfaces/msg/Parameter")
            prefix = kind(name="frame_prefix")
            prefix.value.type, prefix.value.string_value = 4, "r1/"
            service = "/robot_state_publisher/set_parameters"
            await asyncio.to_thread(
                call, tester, "rcl_interfaces/srv/SetParameters", service, parameters=[prefix]
            )
            await until(lambda: ("r1/upper", "r1/tip") in edges(still))
            await until(lambda: ("r1/base", "r1/upper") in edges(moving))

    asyncio.run(run())


def edges(told: list[Any]) -> set[tuple[str, str]]:
    """Parents and children of all transforms that came."""
    every = (each for one in tuple(told) for each in one.transforms)
    return {(each.header.frame_id, each.child_frame_id) for each in every}


def has_ended(process: RunningDemo) -> bool:
    return process.process.poll() is not None


def test_d9_joint_states_come_at_more_than_10_hz_while_nothing_moves(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        states = heard(tester, STATES, "/joint_states")
        async with studio(endpoint, tmp_path) as one:
            await one.do(PublishJoints(running=True))
            # On a busy machine not every one of them: those of the last second and a half.
            await until(
                lambda: len(states) > 15 and stamp_s(states[-1]) - stamp_s(states[-16]) < 1.5
            )
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
            await one.do(SetJoints(positions={"shoulder": 0.6}))
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

        def hear(told: Any, info: MessageInfo) -> None:  # noqa: ANN401
            came.append((info["source_timestamp"] / 1e9, told.data))

        tester.create_subscription(message(STRING), "/robot_description", hear, LATCHED)
        async with studio(endpoint, tmp_path) as one:
            await one.do(PublishRobot(running=True))
            await until(lambda: bool(came))
            site = one.ear.site("reach")["id"]
            for step in range(60):
                await one.do(EditSite(site=site, text=f"0.{step + 10}", gesture="drag"))
                await asyncio.sleep(1 / 60)
            await until(lambda: "0.69" in came[-1][1])
        # Not each gap: a busy machine is late with one of them and in time with the next.
        assert len(came) <= 5 + 2 * (came[-1][0] - came[0][0])

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
            for command in (SetJoints(positions={"shoulder": 1.0}), ZeroJoints()):
                with pytest.raises(CommandError, match="choose the sliders"):
                    await one.do(command)
            with pytest.raises(CommandError, match="follow /"):
                await one.do(AnimateJoints(running=True))
            await one.do(SetJointSource(source="sliders"))
            await one.do(SetJoints(positions={"shoulder": 1.0}))
            tell(-0.25)
            assert one.position("shoulder") == 1.0

    asyncio.run(run())


def stamp_s(told: Any) -> float:  # noqa: ANN401
    return told.header.stamp.sec + told.header.stamp.nanosec / 1e9


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


def test_tf_of_a_robot_that_is_followed_has_the_stamps_of_its_joint_states_each_once(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        out, came = states_out(tester), heard(tester, TF, "/tf")
        state = message(STATES)(name=["shoulder"], position=[0.5])

        def seconds() -> list[int]:
            stamps = [one.header.stamp for told in came for one in told.transforms]
            return [stamp.sec for stamp in stamps if stamp.nanosec == 77]

        def tell(second: int) -> bool:
            state.header.stamp.sec, state.header.stamp.nanosec = second, 77
            out.publish(state)
            return second in seconds()

        async with studio(endpoint, tmp_path) as one:
            await one.do(PublishRobot(running=True))
            await one.do(SetJointSource(source="joint_states"))
            for second in (20, 30, 40):
                await until(lambda told=second: tell(told))
            assert seconds() == [20, 30, 40]
            await one.do(SetJointSource(source="sliders"))
            count = len(came)
            await until(lambda: len(came) > count + 1)
            assert came[-1].transforms[0].header.stamp.sec > 1_700_000_000

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


def test_a_document_that_is_closed_while_it_connects_leaves_nothing_on(
    endpoint: str, tester: Node, tmp_path: Path
):
    # Zenoh may keep a token for ever that ends at the moment when somebody begins to watch.
    assert tester.graph.settle()

    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            switched = asyncio.create_task(one.document.feed.publish_robot(running=True))
            await until(lambda: one.ear.last("wire_state")["state"] != "off")
            await one.engine.execute(CloseDocument(document=one.document.id), one.ear)
            await switched
            await until(lambda: not tester.get_publishers_info_by_topic("/robot_description"))

            def names() -> list[str]:
                return [name for name, _ in tester.get_node_names_and_namespaces()]

            await until(lambda: "studio" in names())
            await until(lambda: "robot_state_publisher" not in names())  # it is told a moment later

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
            await one.engine.execute(CloseDocument(document=second.id), one.ear)
            await one.do(PublishRobot(running=True))
            assert one.ear.last("wire_feed")["publishes_robot"]

    asyncio.run(run())
