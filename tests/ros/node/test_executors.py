from __future__ import annotations

import asyncio
import gc
import threading
import weakref
from typing import TYPE_CHECKING

import pytest

from studio.errors import ExternalShutdownException
from studio.ros.node.executors import SingleThreadedExecutor
from studio.ros.node.node import Node
from studio.ros.node.task import Future
from studio.ros.node.work import ReentrantCallbackGroup
from tests.support.node_pair import context_at, spin_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.context import Context


@pytest.fixture
def context(endpoint: str) -> Generator[Context]:
    with context_at(endpoint) as found:
        yield found


@pytest.fixture
def executor(context: Context) -> SingleThreadedExecutor:
    return SingleThreadedExecutor(context=context)


def test_tasks_are_carried_out_in_their_order(executor: SingleThreadedExecutor):
    seen: list[int] = []
    tasks = [executor.create_task(seen.append, number) for number in range(3)]
    for _ in tasks:
        executor.spin_once(timeout_sec=0)
    assert seen == [0, 1, 2]
    assert all(task.done() for task in tasks)


def test_spinning_until_a_future_is_done_gives_its_result(executor: SingleThreadedExecutor):
    task = executor.create_task(lambda: 7)
    executor.spin_until_future_complete(task)
    assert task.result() == 7


def test_spinning_until_a_future_is_done_ends_in_time(executor: SingleThreadedExecutor):
    future: Future[None] = Future()
    executor.spin_until_future_complete(future, timeout_sec=0.01)
    assert not future.done()


def test_spinning_again_and_again_until_a_future_is_done_leaves_nothing_in_it(
    executor: SingleThreadedExecutor,
):
    future: Future[None] = Future()
    for _ in range(3):
        executor.spin_until_future_complete(future, timeout_sec=0)
        executor.spin_once_until_future_complete(future, timeout_sec=0)
    assert future._listeners == []  # pyright: ignore[reportPrivateUsage]


def test_a_callback_that_awaits_a_cancelled_future_is_cancelled_and_raises_nothing(
    executor: SingleThreadedExecutor,
):
    future: Future[None] = Future()

    async def wait() -> None:
        await future

    task = executor.create_task(wait)
    executor.spin_once(timeout_sec=0)
    future.cancel()
    executor.spin_once(timeout_sec=0)
    assert task.cancelled()


def test_a_task_that_awaits_what_nobody_else_holds_is_not_lost(executor: SingleThreadedExecutor):
    gates: list[weakref.ref[Future[int]]] = []

    async def wait() -> int:
        gate: Future[int] = Future()
        gates.append(weakref.ref(gate))
        return await gate

    executor.create_task(wait)
    executor.spin_once(timeout_sec=0)
    gc.collect()
    gate = gates[0]()
    assert gate is not None
    gate.set_result(3)
    executor.spin_once(timeout_sec=0)
    del gate
    gc.collect()
    assert gates[0]() is None  # and is let go of when it is done


def test_a_future_that_another_thread_settles_ends_the_spinning(
    executor: SingleThreadedExecutor,
):
    future: Future[int] = Future()
    thread = threading.Thread(target=lambda: future.set_result(1))
    thread.start()
    executor.spin_until_future_complete(future)
    thread.join()
    assert future.result() == 1


def test_a_coroutine_goes_on_when_what_it_awaits_is_done(executor: SingleThreadedExecutor):
    first: Future[int] = Future(executor=executor)

    async def work() -> int:
        return await first + 1

    task = executor.create_task(work())
    executor.spin_once(timeout_sec=0)
    assert not task.done()
    first.set_result(4)
    executor.spin_until_future_complete(task, timeout_sec=30)
    assert task.result() == 5


def test_what_belongs_to_asyncio_is_refused_in_a_callback(executor: SingleThreadedExecutor):
    async def work() -> None:
        await asyncio.Future[None](loop=loop)

    loop = asyncio.new_event_loop()
    executor.create_task(work)
    with pytest.raises(RuntimeError, match="belongs into asyncio"):
        executor.spin_once(timeout_sec=0)
    loop.close()


def test_what_a_callback_raises_is_raised_where_it_spins(executor: SingleThreadedExecutor):
    task = executor.create_task(lambda: 1 // 0)
    with pytest.raises(ZeroDivisionError):
        executor.spin_once(timeout_sec=0)
    assert isinstance(task.exception(), ZeroDivisionError)


def test_a_done_callback_is_work_of_the_executor(executor: SingleThreadedExecutor):
    future: Future[int] = Future(executor=executor)
    seen: list[int] = []
    future.add_done_callback(lambda done: seen.append(done.result()))
    future.set_result(2)
    assert seen == []
    executor.spin_once(timeout_sec=0)
    assert seen == [2]


def test_a_group_that_awaits_lets_no_other_piece_begin(context: Context):
    node = Node("waits", context=context)
    gate: Future[None] = Future()
    seen: list[str] = []

    async def slow() -> None:
        timer.cancel()
        seen.append("slow begins")
        await gate
        seen.append("slow ends")

    timer = node.create_timer(0.0, slow)
    executor = SingleThreadedExecutor(context=context)
    spin_until(lambda: "slow begins" in seen, node, executor=executor)
    other = node.create_guard_condition(lambda: seen.append("other"))
    beside = node.create_guard_condition(lambda: seen.append("beside"), ReentrantCallbackGroup())
    other.trigger()
    beside.trigger()
    spin_until(lambda: "beside" in seen, node)  # by another executor, whom the group stops too
    assert "other" not in seen
    gate.set_result(None)
    spin_until(lambda: "other" in seen, node, executor=executor)
    assert seen == ["slow begins", "beside", "slow ends", "other"]


def test_a_timer_of_the_node_is_carried_out_at_its_pace(context: Context):
    node = Node("beats", context=context)
    beats: list[int] = []
    node.create_timer(0.01, lambda: beats.append(1))
    spin_until(lambda: len(beats) >= 5, node)


def test_a_node_goes_to_the_executor_that_takes_it_last(context: Context):
    node = Node("moves", context=context)
    one, other = (SingleThreadedExecutor(context=context) for _ in range(2))
    assert one.add_node(node)
    assert not one.add_node(node)
    assert other.add_node(node)
    assert (one.get_nodes(), other.get_nodes(), node.executor) == ([], [node], other)
    other.shutdown()
    assert node.executor is None


def test_work_that_was_ready_before_it_spins_is_carried_out(context: Context):
    node = Node("early", context=context)
    seen: list[int] = []
    node.create_guard_condition(lambda: seen.append(1)).trigger()
    spin_until(lambda: seen == [1], node)


def test_work_that_was_taken_back_is_not_carried_out(context: Context):
    node = Node("back", context=context)
    seen: list[str] = []
    gone = node.create_guard_condition(lambda: seen.append("gone"))
    kept = node.create_guard_condition(lambda: seen.append("kept"))
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    gone.trigger()
    kept.trigger()
    assert node.destroy_guard_condition(gone)
    assert not node.destroy_guard_condition(gone)
    spin_until(lambda: "kept" in seen, node, executor=executor)
    assert seen == ["kept"]


def test_a_context_that_ends_ends_the_spinning(context: Context):
    executor = SingleThreadedExecutor(context=context)
    threading.Timer(0.0, context.end).start()
    with pytest.raises(ExternalShutdownException):
        executor.spin_once()


def test_shutting_down_by_a_callback_ends_the_spinning_quietly(context: Context):
    executor = SingleThreadedExecutor(context=context)
    executor.create_task(context.end)
    executor.spin()
    assert not context.ok()


def test_an_executor_that_was_shut_down_spins_no_more(executor: SingleThreadedExecutor):
    with executor:
        executor.create_task(lambda: 1 // 0)
    executor.spin()
    assert executor.is_shut_down


def test_work_that_is_told_to_an_executor_too_late_is_carried_out_by_the_next(context: Context):
    node = Node("late", context=context)
    seen: list[int] = []
    guard = node.create_guard_condition(lambda: seen.append(1))
    before = SingleThreadedExecutor(context=context)
    before.add_node(node)
    before.remove_node(node)
    guard.trigger()
    before.announce(guard)
    before.spin_once(timeout_sec=0)
    assert seen == []
    spin_until(lambda: seen == [1], node)
