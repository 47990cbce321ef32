"""A clock that goes backwards, as when a simulation begins anew."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import pytest

from studio.ros.client import Duration
from studio.ros.messages import message
from studio.ros.node.clock import JumpThreshold
from tests.support.demos import node_at
from tests.support.wire import PATIENCE_S, running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from studio.ros.node.clock import TimeJump
    from studio.ros.node.node import Node

pytestmark = pytest.mark.network
CLOCK = message("rosgraph_msgs/msg/Clock")
TIME = message("builtin_interfaces/msg/Time")


@pytest.fixture
def pair() -> Generator[tuple[Node, Node]]:
    with (
        running_router() as endpoint,
        node_at(endpoint, "simulation") as simulation,
        node_at(endpoint, "robot") as robot,
    ):
        yield simulation, robot


def teller(simulation: Node, robot: Node) -> Callable[[int], None]:
    """Give what tells a time until the robot has it."""
    publisher = simulation.create_publisher(CLOCK, "/clock", 1)

    def tell(seconds: int) -> None:
        def told() -> bool:
            publisher.publish(CLOCK(clock=TIME(sec=seconds)))
            return robot.get_clock().now().nanoseconds == seconds * 10**9

        wait_until(f"it is {seconds} s", told)

    return tell


def use_sim_time(node: Node) -> None:
    from studio.ros.client import Parameter

    node.set_parameters([Parameter("use_sim_time", value=True)])


def test_timers_go_on_after_the_simulation_began_anew(pair: tuple[Node, Node]):
    simulation, robot = pair
    use_sim_time(robot)
    tell = teller(simulation, robot)
    tell(100)
    ticks: list[int] = []
    jumps: list[TimeJump] = []
    robot.get_clock().create_jump_callback(
        JumpThreshold(min_backward=Duration(nanoseconds=-1)), post_callback=jumps.append
    )
    timer = robot.create_timer(1.0, lambda: ticks.append(robot.get_clock().now().nanoseconds))
    for second in (101, 102):
        tell(second)
        wait_until("it ticks", lambda now=second: bool(ticks) and ticks[-1] == now * 10**9)
    tell(5)
    assert [jump.delta.nanoseconds for jump in jumps] == [-97 * 10**9]
    before = len(ticks)
    for second in (7, 9, 11):
        tell(second)
    wait_until("it ticks again", lambda: len(ticks) > before)
    assert ticks[before] <= 11 * 10**9
    assert not timer.is_canceled()


def test_a_message_stamped_before_the_last_one_is_heard(pair: tuple[Node, Node]):
    simulation, robot = pair
    header = message("std_msgs/msg/Header")
    came: list[Any] = []
    robot.create_subscription(header, "/stamped", came.append, 10)
    publisher = simulation.create_publisher(header, "/stamped", 10)
    graph = simulation.graph
    assert graph.wait_for(lambda: bool(graph.subscriptions("/stamped")), PATIENCE_S)

    def publish() -> bool:
        for seconds in (50, 10):
            publisher.publish(header(stamp=TIME(sec=seconds)))
        return (50, 10) in pairwise(each.stamp.sec for each in tuple(came))

    # Of those that were published while nobody was found, one of a pair may be lost.
    wait_until("both come", publish)
