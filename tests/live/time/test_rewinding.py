"""Places to look back from: eight at once, then a queue, and none once all is forgotten."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import CommandError
from studio.live.time.rewinding import SEATS, Rewinding
from tests.live.time.test_past import BEGIN, SECOND, a_past, opened, stream
from tests.support.open_documents import until

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

    from studio.live.time.past import LivePast
    from studio.live.time.rewinding import Seat


class Watcher:
    """Somebody who asks for a place, and what they are told."""

    def __init__(self, rewinding: Rewinding) -> None:
        self.told: list[str] = []
        self.seat: Seat = rewinding.ask(
            lambda: self.told.append("granted"),
            lambda: self.told.append(f"moved {self.seat.place}"),
            lambda: self.told.append("ended"),
        )


def run(work: Callable[[Rewinding, LivePast], Coroutine[Any, Any, None]]) -> None:
    """With three seconds that are kept."""

    async def story() -> None:
        past = a_past()
        opened(past, "/a").put(stream(4, SECOND, 10))
        rewinding = Rewinding(past)
        changes: list[int] = []
        rewinding.follow(lambda: changes.append(1))
        await until(lambda: rewinding.is_possible)
        await work(rewinding, past)

    asyncio.run(story())


def test_eight_are_granted_at_once_and_the_next_wait_in_order():
    async def work(rewinding: Rewinding, _: LivePast) -> None:
        watchers = [Watcher(rewinding) for _ in range(SEATS + 3)]
        assert [one.seat.place for one in watchers] == [0] * SEATS + [1, 2, 3]
        watchers[9].seat.leave()  # who waits gives up
        assert watchers[10].told == ["moved 2"]
        watchers[0].seat.leave()
        watchers[0].seat.leave()
        assert watchers[8].told == ["moved 1", "granted"]
        assert (watchers[8].seat.place, watchers[10].seat.place) == (0, 1)
        shown = watchers[8].seat.shown()
        assert (shown.mode, shown.zero_ns) == ("past", BEGIN)
        await asyncio.to_thread(shown.let_go)
        await until(lambda: watchers[10].seat.place == 0)
        assert [one.told for one in watchers[1:8]] == [[]] * 7

    run(work)


def test_all_places_are_lost_once_all_is_forgotten_and_can_be_asked_for_again():
    async def work(rewinding: Rewinding, past: LivePast) -> None:
        watchers = [Watcher(rewinding) for _ in range(SEATS + 1)]
        ticks = rewinding.ticks
        await asyncio.to_thread(past.clear)
        await until(lambda: all(one.told[-1:] == ["ended"] for one in watchers))
        assert rewinding.ticks is not ticks
        assert rewinding.facts.end_ns == 0
        with pytest.raises(CommandError, match="nothing of that is kept"):
            Watcher(rewinding)
        opened(past, "/a").put(stream(4, SECOND, 10))
        await until(lambda: rewinding.is_possible)
        assert Watcher(rewinding).seat.place == 0
        watchers[0].seat.leave()  # one of before is harmless
        assert Watcher(rewinding).seat.place == 0

    run(work)


def test_who_follows_is_told_while_anything_is_kept_and_when_that_ends():
    async def work(rewinding: Rewinding, past: LivePast) -> None:
        told: list[tuple[int, int]] = []

        def note() -> None:
            told.append((rewinding.facts.end_ns - BEGIN, len(rewinding.facts.topics)))

        rewinding.follow(note)
        await until(lambda: (3 * SECOND, 1) in told)
        await asyncio.to_thread(lambda: past.keep(keeping=False))
        await until(lambda: told[-1] == (-BEGIN, 0))
        rewinding.unfollow(note)
        rewinding.unfollow(note)
        told.clear()
        await asyncio.to_thread(lambda: past.keep(keeping=True))
        opened(past, "/a").put(stream(2, SECOND, 10))
        await until(lambda: rewinding.facts.end_ns == BEGIN + SECOND)
        assert told == []

    run(work)


def test_what_is_read_without_a_place_takes_none():
    async def work(rewinding: Rewinding, past: LivePast) -> None:
        looked = [rewinding.looked_at() for _ in range(SEATS + 1)]
        assert {one.recording for one in looked} == {past}
        assert Watcher(rewinding).seat.place == 0

    run(work)
