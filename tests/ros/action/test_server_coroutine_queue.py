from __future__ import annotations

import inspect
from typing import TYPE_CHECKING

from studio.ros.action.server import CoroutineQueue

if TYPE_CHECKING:
    from collections.abc import Coroutine


async def nothing() -> None:
    """Do it."""


def is_closed(coroutine: Coroutine[None, None, None]) -> bool:
    return inspect.getcoroutinestate(coroutine) == inspect.CORO_CLOSED


def test_coroutines_are_given_in_their_order():
    later, coroutines = CoroutineQueue(), [nothing() for _ in range(2)]
    for one in coroutines:
        later.add(one)
    taken = [later.take(), later.take(), later.take()]
    assert [run and run() for run in taken] == [*coroutines, None]
    assert not later.is_ready
    for one in coroutines:
        one.close()


def test_those_that_were_not_begun_are_closed_at_the_end_and_after_it():
    later, before, after = CoroutineQueue(), nothing(), nothing()
    later.add(before)
    later.destroy()
    later.add(after)
    assert is_closed(before)
    assert is_closed(after)
    assert later.take() is None
