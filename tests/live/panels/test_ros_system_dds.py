"""What a page does reaches a robot on DDS at once: no message waits for a route, none is lost."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

import pytest

from studio.protocol.calls import CallService
from studio.protocol.graph import GetGraph
from studio.protocol.publishing import Drive, Publish
from tests.support.bridged import bridged
from tests.support.dds_bridge import DdsNetwork
from tests.support.open_documents import until
from tests.support.wire import PATIENCE_S

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Generator

    from tests.support.bridged import Bridged
    from tests.support.dds_bridge import DdsRobot

pytestmark = pytest.mark.network
STRING, TRIGGER = "std_msgs/msg/String", "std_srvs/srv/Trigger"


@pytest.fixture(scope="module")
def network() -> Generator[DdsNetwork]:
    with DdsNetwork() as made:
        yield made


@asynccontextmanager
async def robot_at(
    network: DdsNetwork, endpoint: str, name: str = ""
) -> AsyncGenerator[tuple[Bridged, DdsRobot]]:
    """A page, and a robot behind a bridge, which hears /order and serves /tell."""
    bridge, robot = network.bridge(connect=endpoint, namespace="/r1"), network.robot(name)
    try:
        if not name:
            robot.ask("subscribe", topic="/order", type_name=STRING)
            robot.ask("serve", service="/tell", type_name=TRIGGER, behaviour="agree")
        async with bridged(endpoint) as page:
            yield page, robot
    finally:
        for one in (robot, bridge):
            one.end()


async def sees(page: Bridged, node: str) -> None:
    """Wait until the page's graph has a node behind the bridge."""

    async def bridges() -> dict[str, str]:
        answer = await page.do(GetGraph())
        return {one.name: one.bridge for one in answer.nodes}

    async with asyncio.timeout(PATIENCE_S):
        while (await bridges()).get(node) != "/r1":  # noqa: ASYNC110 - nothing tells us
            await asyncio.sleep(0.02)


def test_a_message_published_once_reaches_a_robot_on_dds(network: DdsNetwork, endpoint: str):
    async def run() -> None:
        async with robot_at(network, endpoint) as (page, robot):
            await sees(page, "/r1/robot")
            begun = await page.begin(
                Publish(name="/r1/order", message_type=STRING, text="{data: go}")
            )
            told = await page.operation_in("publications", begun, "done", "failed")
            assert (told["state"], told["sent"], told["listeners"]) == ("done", 1, 1)
            await until(lambda: bool(robot.all_said("heard", topic="/order")))
            assert robot.all_said("heard", topic="/order")[0]["message"] == {"data": "go"}

    asyncio.run(run())


def test_a_message_published_as_soon_as_the_studio_is_connected_waits_for_the_robot(
    network: DdsNetwork, endpoint: str
):
    async def run() -> None:
        async with robot_at(network, endpoint) as (page, robot):
            asked = Publish(name="/r1/order", message_type=STRING, text="{data: first}")
            told = await page.operation_in("publications", await page.begin(asked), "done")
            assert told["listeners"] == 1
            await until(lambda: bool(robot.all_said("heard", topic="/order")))

    asyncio.run(run())


def test_a_robot_on_dds_hears_the_first_speed_and_stands_when_all_is_stopped(
    network: DdsNetwork, endpoint: str
):
    async def run() -> None:
        async with robot_at(network, endpoint, "classroom") as (page, robot):
            await sees(page, "/r1/driver")
            await page.do(Drive(topic="/r1/cmd_vel", x=0.5, y=0.0, yaw=0.0))
            await until(lambda: bool(robot.all_said("cmd_vel")))
            assert robot.all_said("cmd_vel")[0]["linear_m_s"] == 0.5
            await page.ros.stop()
            await until(lambda: robot.all_said("cmd_vel")[-1]["linear_m_s"] == 0.0)

    asyncio.run(run())


def test_a_service_of_a_robot_on_dds_answers_a_call_at_once(network: DdsNetwork, endpoint: str):
    async def run() -> None:
        async with robot_at(network, endpoint) as (page, _):
            await sees(page, "/r1/robot")
            begun = await page.begin(
                CallService(name="/r1/tell", service_type=TRIGGER, text="{}", timeout_s=10.0)
            )
            told = await page.operation_in("calls", begun, "answered", "failed")
            assert (told["state"], told["trouble"]) == ("answered", "")
            assert "triggered" in told["reply"]

    asyncio.run(run())
