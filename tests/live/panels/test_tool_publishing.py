"""What tools send, as another session receives it: messages, QoS, and goals of a real server."""

from __future__ import annotations

import asyncio
import math
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import CommandError, NotServedError, RosNameError
from studio.live.displays.document_tools import ToolUse
from studio.protocol.goals import CancelGoal
from studio.ros.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from studio.rviz.tools import (
    DURABILITY,
    HISTORY,
    POINT,
    POSE,
    POSE_WITH_COVARIANCE,
    RELIABILITY,
    ToolSpec,
)
from tests.support.bridged import Bridged, bridged
from tests.support.demos import heard, message
from tests.support.navigation import navigator
from tests.support.open_documents import until

if TYPE_CHECKING:
    from studio.live.panels.tool_publishing import ToolSent
    from studio.ros.client import Node

pytestmark = pytest.mark.network
ASKED = (ReliabilityPolicy.BEST_EFFORT, DurabilityPolicy.TRANSIENT_LOCAL, 3)
FIRST = (ReliabilityPolicy.RELIABLE, DurabilityPolicy.VOLATILE, 5)
POLICIES = (HISTORY, RELIABILITY, DURABILITY)
QUARTER = (math.cos(math.pi / 8), 0.0, 0.0, math.sin(math.pi / 8))
"""pi / 4 about z."""
STAMP_NS = 100_250_000_000


@pytest.fixture(autouse=True)
def _impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("studio.live.panels.tool_publishing._LISTENER_PATIENCE_S", 0.1)


async def used(page: Bridged, kind: str, **values: Any) -> ToolSent:  # noqa: ANN401 - of properties
    """Point with a tool at (1, 2, 0.5) of odom, turned by 45 degrees."""
    tool = ToolSpec(
        kind, kind, "Tool", {name.replace("_", " "): one for name, one in values.items()}
    )
    use = ToolUse(tool, "odom", QUARTER, (1.0, 2.0, 0.5), STAMP_NS)
    return await page.ros.tools.use("d", use, "me")


def test_a_pose_estimate_has_the_covariances_the_frame_and_the_time_when_it_was_pointed_at(
    endpoint: str, tester: Node
):
    poses = heard(tester, POSE_WITH_COVARIANCE, "/initialpose")

    async def run() -> ToolSent:
        async with bridged(endpoint) as page:
            answer = await used(page, "SetInitialPose", Covariance_y=2.0)
            await until(lambda: bool(poses))
            return answer

    answer = asyncio.run(run())
    (said,) = poses
    assert (answer.name, answer.subscriptions, answer.operation) == ("/initialpose", 1, 0)
    assert said.header.frame_id == "odom"
    assert (said.header.stamp.sec, said.header.stamp.nanosec) == (100, 250_000_000)
    place, turn = said.pose.pose.position, said.pose.pose.orientation
    assert (place.x, place.y, place.z) == (1.0, 2.0, 0.5)
    assert (turn.w, turn.x, turn.y, turn.z) == QUARTER
    own = {0: 0.25, 7: 2.0, 35: (math.pi / 12) ** 2}
    assert {at: one for at, one in enumerate(said.pose.covariance) if one} == pytest.approx(own)


def test_a_point_and_a_goal_go_to_the_topics_of_their_tools_with_their_qos(
    endpoint: str, tester: Node
):
    points = heard(tester, POINT, "/clicked_point")
    goals = heard(tester, POSE, "/second/goal")
    qos = {
        "Topic": "second/goal",
        "Topic/Depth": 3,
        "Topic/Reliability Policy": "Best Effort",
        "Topic/Durability Policy": "Transient Local",
    }

    ends = tester.get_publishers_info_by_topic
    told: list[QoSProfile] = []

    async def run() -> None:
        async with bridged(endpoint) as page:
            await used(page, "PublishPoint")
            assert (await used(page, "SetGoal", **qos)).name == "/second/goal"
            await until(lambda: bool(points and goals))
            for name, wanted in (("/second/goal", ASKED), ("/clicked_point", FIRST)):
                await until(lambda name=name: len(ends(name)) == 1)
                found = ends(name)[0].qos_profile
                assert (found.reliability, found.durability, found.depth) == wanted
                assert found.history is HistoryPolicy.KEEP_LAST
            for name, history in (
                ("/all", {"Topic/History Policy": "Keep All"}),
                ("/usual", dict.fromkeys(POLICIES, "System Default")),
            ):
                await used(page, "SetGoal", Topic=name, **history)
                await until(lambda name=name: len(ends(name)) == 1)
                told.append(ends(name)[0].qos_profile)

    asyncio.run(run())
    assert [one.history for one in told] == [HistoryPolicy.KEEP_ALL, HistoryPolicy.KEEP_LAST]
    assert (told[1].reliability, told[1].durability) == FIRST[:2]
    assert (points[0].point.x, points[0].point.y, points[0].point.z) == (1.0, 2.0, 0.5)
    assert goals[0].pose.orientation.w == QUARTER[0]


def test_a_publisher_stays_for_who_comes_late_until_its_tool_has_another_topic(
    endpoint: str, tester: Node
):
    kept = {"Topic/Durability Policy": "Transient Local"}

    async def run() -> None:
        async with bridged(endpoint) as page:
            assert (await used(page, "SetGoal", **kept)).subscriptions == 0
            late = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            goals = heard(tester, POSE, "/goal_pose", late)
            await until(lambda: len(goals) == 1)
            assert (await used(page, "SetGoal", **kept)).subscriptions == 1
            await until(lambda: len(goals) == 2)
            await used(page, "SetGoal", Topic="/elsewhere")
            await until(lambda: not tester.get_publishers_info_by_topic("/goal_pose"))
            with pytest.raises(RosNameError):
                await used(page, "SetGoal", Topic="/no place")

    asyncio.run(run())


def test_only_a_new_publisher_waits_for_somebody_to_hear_it(
    endpoint: str, tester: Node, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("studio.live.panels.tool_publishing._LISTENER_PATIENCE_S", 600)
    hearing = tester.create_subscription(message(POINT), "/clicked_point", print, 1)

    async def run() -> None:
        async with bridged(endpoint) as page:
            assert (await used(page, "PublishPoint")).subscriptions == 1
            tester.destroy_subscription(hearing)
            graph = (await page.ros.connection.link()).graph
            await until(lambda: not graph.subscriptions("/clicked_point"))
            assert (await used(page, "PublishPoint")).subscriptions == 0

    asyncio.run(run())


def test_the_publisher_of_a_tool_that_was_removed_is_closed(endpoint: str, tester: Node):
    def ends(name: str) -> int:
        return len(tester.get_publishers_info_by_topic(name))

    async def run() -> None:
        async with bridged(endpoint) as page:
            await used(page, "PublishPoint")
            await used(page, "SetGoal", Send_as="Topic")
            await until(lambda: ends("/clicked_point") == ends("/goal_pose") == 1)
            page.ros.tools.keep_only("elsewhere", ())
            page.ros.tools.keep_only("d", ["SetGoal"])
            await until(lambda: ends("/clicked_point") == 0)
            assert ends("/goal_pose") == 1
            page.ros.tools.keep_only("d", ())
            await until(lambda: ends("/goal_pose") == 0)

    asyncio.run(run())


def test_a_tool_that_is_removed_while_it_waits_sends_nothing(
    endpoint: str, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("studio.live.panels.tool_publishing._LISTENER_PATIENCE_S", 0.5)

    async def run() -> None:
        async with bridged(endpoint) as page:
            sending = asyncio.create_task(used(page, "PublishPoint", Topic="/unheard"))
            await until(lambda: page.ros.tools.keep_only("d", ()) or sending.done())
            with pytest.raises(CommandError, match="nothing was sent"):
                await sending

    asyncio.run(run())


def test_a_goal_goes_to_the_action_where_it_is_served_and_is_cancelled(endpoint: str, tester: Node):
    poses = heard(tester, POSE, "/goal_pose")

    async def run() -> None:
        async with bridged(endpoint) as page:
            with pytest.raises(NotServedError, match="/navigate_to_pose"):
                await used(page, "SetGoal", Send_as="Action")
            assert (await used(page, "SetGoal")).operation == 0
            await until(lambda: len(poses) == 1)
            with navigator(endpoint) as work:
                link = await page.ros.connection.link()
                await until(lambda: bool(link.graph.action_servers("/navigate_to_pose")))
                answer = await used(page, "SetGoal")
                assert answer.name == "/navigate_to_pose"
                await page.operation_in("goals", answer.operation, "executing")
                asked = await asyncio.to_thread(lambda: work.goal().request.pose)
                assert (asked.header.frame_id, asked.pose.position.y) == ("odom", 2.0)
                assert (asked.header.stamp.sec, asked.header.stamp.nanosec) == (100, 250_000_000)
                await asyncio.to_thread(work.tell, 1.5, recoveries=2)
                goals = page.ros.goals.operations
                await until(lambda: goals.get(answer.operation).feedback_count == 1)
                await page.do(CancelGoal(operation=answer.operation))
                await asyncio.to_thread(work.end, "canceled")
                await page.operation_in("goals", answer.operation, "canceled")
                await used(page, "SetGoal", Send_as="Topic")
                await until(lambda: len(poses) == 2)

    asyncio.run(run())


def test_who_lost_control_meanwhile_sends_nothing(endpoint: str, tester: Node):
    points = heard(tester, POINT, "/clicked_point")

    async def run() -> None:
        async with bridged(endpoint) as page:
            # Nobody subscribes there: it waits for somebody until the robot is stopped.
            sending = asyncio.create_task(used(page, "PublishPoint", Topic="/unheard"))
            await asyncio.sleep(0)
            page.ros.release(lambda person: person != "me")
            with pytest.raises(CommandError, match="nothing was sent"):
                await sending
            await used(page, "PublishPoint")
            await until(lambda: len(points) == 1)

    asyncio.run(run())
