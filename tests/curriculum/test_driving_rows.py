"""The course's row T2 from the page: turtlesim is driven by hand."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.protocol.publishing import Drive
from tests.support.bridged import bridged
from tests.support.demos import heard, node_at, running_demo
from tests.support.open_documents import until

if TYPE_CHECKING:
    from studio.ros.client import Node

pytestmark = pytest.mark.network


def test_t2_the_turtle_is_driven_by_hand_and_stands_once_it_is_let_go(endpoint: str):
    with node_at(endpoint) as node, running_demo(endpoint, "turtlesim_node"):
        asyncio.run(_drive(endpoint, node))


async def _drive(endpoint: str, node: Node) -> None:
    poses = heard(node, "turtlesim/msg/Pose", "/turtle1/pose")
    await until(lambda: bool(poses))
    start = poses[-1]
    async with bridged(endpoint) as page:
        while poses[-1].x < start.x + 0.5:
            await page.do(Drive(topic="/turtle1/cmd_vel", x=2.0, yaw=0.5))
            await asyncio.sleep(0.05)  # as a page does while the stick is held
        assert poses[-1].theta > start.theta
        await until(lambda: poses[-1].linear_velocity == 0.0)
        assert poses[-1].angular_velocity == 0.0
