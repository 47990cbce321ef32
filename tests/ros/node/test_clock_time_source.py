from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.ros.messages import message
from studio.ros.node.executors import SingleThreadedExecutor
from studio.ros.parameters.parameter import Parameter
from studio.ros.qos import QoSProfile
from tests.support.node_pair import node_pair, spin_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.node import Node

ClockMessage = message("rosgraph_msgs/msg/Clock")
Stamp = message("builtin_interfaces/msg/Time")


@pytest.fixture
def nodes() -> Generator[tuple[Node, Node]]:
    with node_pair() as pair:
        yield pair


def set_sim_time(node: Node, *, on: bool) -> None:
    node.set_parameters([Parameter("use_sim_time", value=on)])


def test_clock_tells_the_time_while_use_sim_time_is_set(nodes: tuple[Node, Node]):
    simulator, node = nodes
    clock = node.get_clock()
    set_sim_time(node, on=True)
    assert (clock.ros_time_is_active, clock.now_ns()) == (True, 0)
    publisher = simulator.create_publisher(ClockMessage, "/clock", QoSProfile(depth=1))

    def is_told() -> bool:
        publisher.publish(ClockMessage(clock=Stamp(sec=12, nanosec=34)))
        return clock.now_ns() == 12_000_000_034

    spin_until(is_told, node)
    set_sim_time(node, on=False)
    assert not clock.ros_time_is_active
    assert clock.now_ns() > 12_000_000_034


def test_timers_follow_clock_also_backwards(nodes: tuple[Node, Node]):
    simulator, node = nodes
    set_sim_time(node, on=True)
    seconds: list[int] = []
    node.create_timer(1.0, lambda: seconds.append(node.get_clock().now_ns() // 10**9))
    publisher = simulator.create_publisher(ClockMessage, "/clock", QoSProfile(depth=1))
    executor = SingleThreadedExecutor(context=node.context)

    def go_to(second: int) -> None:
        def is_there() -> bool:
            publisher.publish(ClockMessage(clock=Stamp(sec=second)))
            return node.get_clock().now_ns() == second * 10**9

        spin_until(is_there, node, executor=executor)

    for second in (1, 2, 9, 3, 4):
        go_to(second)
        expected = second != 3
        spin_until(lambda: (second in seconds) is expected, node, executor=executor)  # noqa: B023
    assert seconds == [1, 2, 9, 4]


def test_a_clock_before_zero_is_taken_for_zero(nodes: tuple[Node, Node]):
    simulator, node = nodes
    set_sim_time(node, on=True)
    publisher = simulator.create_publisher(ClockMessage, "/clock", QoSProfile(depth=1))
    node.get_clock().set_ros_time(5)

    def is_zero() -> bool:
        publisher.publish(ClockMessage(clock=Stamp(sec=-3)))
        return node.get_clock().now_ns() == 0

    spin_until(is_zero, node)
