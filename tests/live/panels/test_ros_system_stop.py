"""What a person set going, once control is no longer theirs, or anybody stops the robot."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import CommandError
from studio.live.panels import driving
from studio.protocol.goals import SendGoal
from studio.protocol.publishing import Drive, Publish
from studio.ros.action import ActionServer, CancelResponse
from tests.support.asked import ask_ros
from tests.support.bridged import bridged
from tests.support.demos import heard
from tests.support.goals import FIBONACCI, Held
from tests.support.open_documents import Ear, until

if TYPE_CHECKING:
    from studio.ros.client import Node

pytestmark = pytest.mark.network
TWIST, STRING = "geometry_msgs/msg/Twist", "std_msgs/msg/String"
TOPIC, OTHER = "/robot/cmd_vel", "/other/cmd_vel"


def forward(twists: list[Any]) -> list[float]:
    return [one.linear.x for one in list(twists)]


class Student(Ear):
    """A page of a person who has control for a while."""

    def __init__(self) -> None:
        super().__init__()
        self.person = "ada"


def test_what_a_person_drives_and_publishes_ends_with_their_control(
    endpoint: str, tester: Node, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(driving, "_SILENCE_S", 1000.0)
    twists, said = heard(tester, TWIST, TOPIC), heard(tester, STRING, "/said")
    ada = Student()
    again = Publish(name="/said", message_type=STRING, text="{data: again}", rate_hz=50)

    async def run() -> None:
        async with bridged(endpoint) as page:
            await ask_ros(page.ros, again, ada)
            await ask_ros(page.ros, Drive(topic=TOPIC, x=0.5), ada)
            await page.do(Drive(topic=OTHER, x=0.25))
            await until(lambda: len(said) > 2 and len(twists) > 0)
            page.ros.release(lambda person: person != "ada")
            await until(lambda: forward(twists) == [0.5, 0.0])
            (ended,) = page.ros.publishing.operations.all()
            await until(lambda: ended.is_over)
            assert ended.trouble == "Control went to somebody else."
            # What the presenter does goes on.
            await page.do(Drive(topic=OTHER, x=0.5))

    asyncio.run(run())


def test_a_stop_publishes_zero_where_pages_drove_and_published_and_cancels_goals(
    endpoint: str, tester: Node, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(driving, "_SILENCE_S", 1000.0)
    twists, others = heard(tester, TWIST, TOPIC), heard(tester, TWIST, OTHER)
    work = Held()
    server = ActionServer(
        tester,
        tester.wire.types.action(FIBONACCI),
        "fibonacci",
        work,
        cancel_callback=lambda _: CancelResponse.ACCEPT,
    )
    once = Publish(name=OTHER, message_type=TWIST, text="{linear: {x: 0.75}}")
    goal = SendGoal(name="fibonacci", action_type=FIBONACCI, text="{order: 3}")

    async def run() -> None:
        async with bridged(endpoint) as page:
            await page.do(Drive(topic=TOPIC, x=0.5))
            await page.do(once)
            sent = (await page.do(goal)).operation
            await until(lambda: forward(others) == [0.75] and forward(twists) == [0.5])
            await page.operation_in("goals", sent, "executing")
            await page.ros.stop()
            await until(lambda: forward(others)[-1] == 0.0 and forward(twists)[-1] == 0.0)
            # A key that is held on moves nothing; one that was let go of and pressed anew does.
            with pytest.raises(CommandError, match="let go of the controls first"):
                await page.do(Drive(topic=TOPIC, x=0.5))
            await page.do(Drive(topic=TOPIC, x=0.0))
            await page.do(Drive(topic=TOPIC, x=0.25))
            await until(lambda: forward(twists)[-1] == 0.25)
            await asyncio.to_thread(work.end, "canceled")
            await page.operation_in("goals", sent, "canceled")

    asyncio.run(run())
    server.destroy()


def test_a_stop_without_a_connection_stops_nothing_and_fails_at_nothing(endpoint: str):
    async def run() -> None:
        async with bridged(endpoint) as page:
            await page.ros.let_go()
            await page.ros.stop()

    asyncio.run(run())
