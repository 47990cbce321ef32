from __future__ import annotations

import asyncio
import logging
import threading

import pytest

from studio.ros.node.task import Future


def test_a_result_is_set_once():
    future: Future[int] = Future()
    assert (future.done(), future.result()) == (False, None)
    future.set_result(1)
    future.set_result(2)
    assert (future.done(), future.result(), future.exception()) == (True, 1, None)


def test_an_exception_is_raised_by_the_result():
    future: Future[int] = Future()
    future.set_exception(KeyError("x"))
    assert isinstance(future.exception(), KeyError)
    with pytest.raises(KeyError):
        future.result()


def test_a_cancelled_future_takes_no_result():
    future: Future[int] = Future()
    future.cancel()
    future.set_result(1)
    assert (future.cancelled(), future.done(), future.result()) == (True, True, None)


def test_callbacks_are_called_once_before_and_after():
    future: Future[int] = Future()
    seen: list[int] = []

    def removed(_: object) -> None:
        seen.append(0)

    future.add_done_callback(lambda done: seen.append(done.result()))
    future.add_done_callback(removed)
    assert future.remove_done_callback(removed)
    assert not future.remove_done_callback(removed)
    future.set_result(5)
    future.add_done_callback(lambda done: seen.append(-done.result()))
    assert seen == [5, -5]


def test_a_callback_that_fails_is_logged_and_the_others_are_called(
    caplog: pytest.LogCaptureFixture,
):
    future: Future[int] = Future()
    seen: list[int] = []
    future.add_done_callback(lambda _: 1 // 0)
    future.add_done_callback(lambda _: seen.append(1))
    with caplog.at_level(logging.ERROR):
        future.set_result(1)
    assert seen == [1]
    assert "callback of a future failed" in caplog.text


def test_waiting_ends_when_another_thread_settles_it():
    future: Future[int] = Future()
    assert not future.wait(0.0)
    thread = threading.Thread(target=lambda: future.set_result(3))
    thread.start()
    assert future.wait(30)
    thread.join()
    assert future.result() == 3


def test_asyncio_awaits_what_another_thread_settles():
    async def ask() -> int:
        future: Future[int] = Future()
        thread = threading.Thread(target=lambda: future.set_result(7))
        thread.start()
        got = await future
        thread.join()
        return got

    assert asyncio.run(ask()) == 7


def test_a_wait_that_asyncio_gives_up_leaves_nothing_behind():
    future: Future[int] = Future()

    async def ask() -> None:
        async with asyncio.timeout(0):
            await future

    for _ in range(2):
        with pytest.raises(TimeoutError):
            asyncio.run(ask())
    assert future._listeners == []  # pyright: ignore[reportPrivateUsage]


def test_asyncio_awaits_what_is_known_already():
    async def ask() -> int:
        future: Future[int] = Future()
        future.set_result(8)
        return await future

    assert asyncio.run(ask()) == 8


def test_a_cancelled_future_cancels_who_awaits_it():
    async def ask() -> None:
        future: Future[int] = Future()
        future.cancel()
        await future

    with pytest.raises(asyncio.CancelledError):
        asyncio.run(ask())
