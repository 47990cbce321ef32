from __future__ import annotations

import threading
from typing import TYPE_CHECKING

import pytest

from studio.ros.node.executors import MultiThreadedExecutor
from studio.ros.node.node import Node
from studio.ros.node.work import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from tests.support.node_pair import context_at, spin_until
from tests.support.wire import PATIENCE_S, running_router

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.context import Context


@pytest.fixture(scope="module")
def context() -> Generator[Context]:
    with running_router() as endpoint, context_at(endpoint) as found:
        yield found


def test_groups_run_beside_each_other(context: Context):
    node = Node("beside", context=context)
    meeting = threading.Barrier(2)
    met: list[str] = []

    def meet(name: str) -> None:
        meeting.wait(PATIENCE_S)
        met.append(name)

    for name in ("one", "other"):
        group = MutuallyExclusiveCallbackGroup()
        node.create_guard_condition(lambda name=name: meet(name), group).trigger()
    with MultiThreadedExecutor(2, context=context) as executor:
        spin_until(lambda: len(met) == 2, node, executor=executor)


def test_a_reentrant_timer_runs_beside_itself(context: Context):
    node = Node("itself", context=context)
    meeting = threading.Barrier(2)
    met: list[int] = []

    def meet() -> None:
        if not met:
            met.append(meeting.wait(PATIENCE_S))

    timer = node.create_timer(0.001, meet, ReentrantCallbackGroup())
    with MultiThreadedExecutor(2, context=context) as executor:
        spin_until(lambda: len(met) > 0, node, executor=executor)
    timer.cancel()


def test_pieces_of_one_group_never_run_beside_each_other(context: Context):
    node = Node("alone", context=context)
    running, most, done = [0], [0], [0]

    def work() -> None:
        running[0] += 1
        most[0] = max(most[0], running[0])
        threading.Event().wait(0.001)
        running[0] -= 1
        done[0] += 1

    timers = [node.create_timer(0.001, work) for _ in range(4)]
    with MultiThreadedExecutor(4, context=context) as executor:
        spin_until(lambda: done[0] >= 20, node, executor=executor)
    for timer in timers:
        timer.cancel()
    assert most == [1]


def test_what_a_thread_raises_is_raised_where_it_spins(context: Context):
    node = Node("raises", context=context)
    node.create_guard_condition(lambda: 1 // 0).trigger()
    with (
        MultiThreadedExecutor(2, context=context) as executor,
        pytest.raises(ZeroDivisionError),
    ):
        spin_until(lambda: False, node, executor=executor)


def test_nothing_is_taken_while_all_threads_are_busy(context: Context):
    node = Node("busy", context=context)
    gate, group = threading.Event(), ReentrantCallbackGroup()
    begun: list[int] = []

    def block() -> None:
        begun.append(1)
        gate.wait(PATIENCE_S)

    guards = [node.create_guard_condition(block, group) for _ in range(4)]
    for guard in guards:
        guard.trigger()
    with MultiThreadedExecutor(2, context=context) as executor:
        spin_until(lambda: len(begun) == 2, node, executor=executor)
        executor.spin_once(timeout_sec=0.01)
        assert len(begun) == 2
        assert sum(guard.is_ready for guard in guards) == 2
        gate.set()


def test_an_executor_needs_a_thread(context: Context):
    with pytest.raises(ValueError, match="needs a thread"):
        MultiThreadedExecutor(0, context=context)
