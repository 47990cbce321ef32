from __future__ import annotations

import threading

import pytest

import studio.ros.client as rclpy
from studio.errors import ExternalShutdownException
from studio.ros.node.context import Context
from studio.ros.node.spinning import spinning
from studio.ros.wire.settings import WireSettings
from tests.support.node_pair import context_at
from tests.support.wire import wait_until

NO_SIGNALS = rclpy.SignalHandlerOptions.NO


def test_the_wire_is_joined_for_a_block(endpoint: str):
    with rclpy.init(
        [], settings=WireSettings(connect=(endpoint,)), signal_handler_options=NO_SIGNALS
    ):
        assert rclpy.ok()
        node = rclpy.create_node("block")
        seen: list[int] = []
        node.create_timer(0.0, lambda: seen.append(1))
        rclpy.spin_once(node)
        assert seen == [1]
    assert not rclpy.ok()
    rclpy.shutdown()


def test_a_context_of_ones_own_is_joined(endpoint: str):
    context = Context()
    settings = WireSettings(connect=(endpoint,), domain=7)
    with rclpy.init([], context=context, settings=settings):
        assert rclpy.ok(context=context)
        assert rclpy.Node("own", context=context).token.domain == 7
    assert not rclpy.ok(context=context)


def test_a_future_ends_the_spinning(endpoint: str):
    with context_at(endpoint) as context:
        node = rclpy.Node("waits", context=context)
        future: rclpy.Future[int] = rclpy.Future()
        node.create_timer(0.0, lambda: future.set_result(3))
        rclpy.spin_until_future_complete(node, future)
        assert future.result() == 3
        never: rclpy.Future[int] = rclpy.Future()
        rclpy.spin_until_future_complete(node, never, timeout_sec=0.01)
        assert not never.done()


def test_a_node_is_given_back_to_the_executor_that_had_it(endpoint: str):
    with context_at(endpoint) as context:
        node = rclpy.Node("lent", context=context)
        own = rclpy.SingleThreadedExecutor(context=context)
        own.add_node(node)
        other = rclpy.SingleThreadedExecutor(context=context)
        rclpy.spin_once(node, executor=other, timeout_sec=0)
        assert node.executor is own
        rclpy.spin_once(node, timeout_sec=0)
        assert node.executor is own


def test_spinning_in_a_thread_ends_when_the_context_does(endpoint: str):
    with context_at(endpoint) as context:
        node = rclpy.Node("thread", context=context)
        ended: list[bool] = []

        def run() -> None:
            with pytest.raises(ExternalShutdownException):
                rclpy.spin(node)
            ended.append(True)

        thread = threading.Thread(target=run)
        thread.start()
        wait_until("it spins", lambda: node.executor is not None)
        context.end()
        thread.join()
        assert ended == [True]


def test_spinning_beside_a_block_ends_with_it(endpoint: str):
    with context_at(endpoint) as context:
        node = rclpy.Node("beside", context=context)
        seen: list[int] = []
        node.create_timer(0.001, lambda: seen.append(1))
        with spinning(node):
            wait_until("it beats", lambda: len(seen) > 2)
        assert node.executor is None


def test_what_a_callback_raises_beside_a_block_is_raised_at_its_end(endpoint: str):
    with context_at(endpoint) as context:
        node = rclpy.Node("fails", context=context)
        begun = threading.Event()

        def fail() -> None:
            begun.set()
            raise KeyError("x")

        node.create_timer(0.0, fail)
        with pytest.raises(KeyError), spinning(node):
            assert begun.wait(30)


def test_r2d2s_loop_of_spin_once_and_a_rate_keeps_time(endpoint: str):
    with context_at(endpoint) as context:
        node = rclpy.Node("state_publisher", context=context)
        rate = node.create_rate(100.0)
        begin_ns = rclpy.Clock().now_ns()
        for _ in range(5):
            rclpy.spin_once(node)
            rate.sleep()
        assert rclpy.Clock().now_ns() - begin_ns >= 40_000_000
        assert node.destroy_rate(rate)
        assert not node.destroy_rate(rate)


def test_a_rate_sleeps_while_another_thread_spins(endpoint: str):
    with context_at(endpoint) as context:
        node = rclpy.Node("sleeper", context=context)
        rate = node.create_rate(200.0)
        with spinning(node):
            for _ in range(3):
                rate.sleep()
        context.end()
        with pytest.raises(ExternalShutdownException):
            rate.sleep()
        with pytest.raises(ValueError, match="above 0"):
            node.create_rate(0)


def test_a_rate_on_a_clock_of_its_own_beats_while_nobody_tells_the_time_of_ros(endpoint: str):
    with context_at(endpoint) as context:
        sim_time = rclpy.Parameter("use_sim_time", value=True)
        node = rclpy.Node("simulated", context=context, parameter_overrides=[sim_time])
        steady = rclpy.Clock(clock_type=rclpy.ClockType.STEADY_TIME)
        rate = node.create_rate(200.0, steady)
        with spinning(node):
            rate.sleep()
