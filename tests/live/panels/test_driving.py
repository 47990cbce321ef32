"""A robot driven by hand: who drives it, what it hears, and that it stands still without them."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest
from pydantic import ValidationError

from studio.errors import CommandError, StudioError
from studio.live.panels import driving
from studio.protocol.publishing import Drive
from tests.support.asked import ask_ros
from tests.support.bridged import Bridged, bridged
from tests.support.demos import heard
from tests.support.open_documents import Ear, until

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from studio.ros.client import Node

pytestmark = pytest.mark.network
TWIST, STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
TOPIC = "/robot/cmd_vel"


def speeds(twists: list[Any]) -> list[tuple[float, float, float]]:
    return [(one.linear.x, one.linear.y, one.angular.z) for one in list(twists)]


def stands(twists: list[Any]) -> bool:
    """Whether it was told to stand still, after all else."""
    return bool(twists) and speeds(twists)[-1] == (0.0, 0.0, 0.0)


def test_who_falls_silent_has_the_robot_stand_still(endpoint: str, tester: Node):
    twists = heard(tester, TWIST, TOPIC)

    async def run() -> None:
        async with bridged(endpoint) as page:
            await page.do(Drive(topic=TOPIC, x=0.5, y=0.25, yaw=-1.0))
            await until(lambda: stands(twists))
            assert speeds(twists) == [(0.5, 0.25, -1.0), (0.0, 0.0, 0.0)]
            await until(lambda: not tester.graph.publishers(TOPIC))

    asyncio.run(run())


async def page_is_gone(page: Bridged) -> None:
    page.ros.detach(page.ear)


async def connection_ends(page: Bridged) -> None:
    await page.ros.let_go()


@pytest.mark.parametrize("ends", [page_is_gone, connection_ends])
def test_nothing_drives_on_beyond_its_page_or_the_connection(
    endpoint: str,
    tester: Node,
    monkeypatch: pytest.MonkeyPatch,
    ends: Callable[[Bridged], Awaitable[None]],
):
    monkeypatch.setattr(driving, "_SILENCE_S", 1000.0)
    twists = heard(tester, TWIST, TOPIC)

    async def run() -> None:
        async with bridged(endpoint) as page:
            await page.do(Drive(topic=TOPIC, x=0.5))
            page.ros.detach(Ear())  # somebody else's page
            await page.do(Drive(topic=TOPIC, x=0.6))
            await until(lambda: len(twists) == 2)
            await ends(page)
            await until(lambda: stands(twists))

    asyncio.run(run())
    assert speeds(twists) == [(0.5, 0.0, 0.0), (0.6, 0.0, 0.0), (0.0, 0.0, 0.0)]


def test_one_drives_and_another_waits_until_they_let_go(
    endpoint: str, tester: Node, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(driving, "_SILENCE_S", 1000.0)
    twists = heard(tester, TWIST, TOPIC)
    second = Ear()

    async def run() -> None:
        async with bridged(endpoint) as page:
            await page.do(Drive(topic=TOPIC, x=0.5))
            with pytest.raises(CommandError, match=f"Somebody else drives on {TOPIC}"):
                await ask_ros(page.ros, Drive(topic=TOPIC[1:], x=-9.0), second)
            page.ros.detach(page.ear)
            await ask_ros(page.ros, Drive(topic=TOPIC, x=-1.0), second)
            await until(lambda: (-1.0, 0.0, 0.0) in speeds(twists))
            assert (-9.0, 0.0, 0.0) not in speeds(twists)

    asyncio.run(run())


def test_speeds_go_out_in_their_order_and_within_bounds(endpoint: str, tester: Node):
    twists = heard(tester, TWIST, TOPIC)
    wanted = [1e300, -1e300, *(step / 100 for step in range(40)), 0.0]

    async def run() -> None:
        async with bridged(endpoint) as page:
            await asyncio.gather(*(page.do(Drive(topic=TOPIC, x=x)) for x in wanted))
            await until(lambda: len(twists) >= len(wanted))

    asyncio.run(run())
    assert [x for x, _, _ in speeds(twists)][: len(wanted)] == [100.0, -100.0, *wanted[2:]]


def test_the_stamped_kind_holds_the_time(endpoint: str, tester: Node):
    twists = heard(tester, STAMPED, TOPIC)

    async def run() -> None:
        async with bridged(endpoint) as page:
            await page.do(Drive(topic=TOPIC, stamped=True, yaw=0.3))
            await until(lambda: len(twists) == 2)

    asyncio.run(run())
    assert [one.twist.angular.z for one in twists] == [0.3, 0.0]
    assert all(one.header.stamp.sec > 10**9 for one in twists)


@pytest.mark.parametrize("number", [float("nan"), float("inf"), float("-inf")])
def test_a_speed_that_is_no_number_is_none(number: float):
    with pytest.raises(ValidationError):
        Drive(topic=TOPIC, yaw=number)


def test_a_topic_that_cannot_be_named_so_is_refused(endpoint: str):
    async def run() -> None:
        async with bridged(endpoint) as page:
            with pytest.raises(StudioError, match="cmd vel"):
                await page.do(Drive(topic="/cmd vel", x=1.0))

    asyncio.run(run())
