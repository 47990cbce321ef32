"""Lanes at a relay: what a page that comes later, or follows later, is sent."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import CommandError
from studio.protocol.roles import Role
from studio.server.relays.messages import (
    STUDIO_LANE,
    CloseLane,
    Frame,
    LaneFrame,
    LaneSnapshot,
    OpenLane,
    Refresh,
)
from studio.server.relays.relayed_lanes import RelayedLanes

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine
    from typing import Any

    from studio.server.relays.messages import Up


class Page:
    """A page that keeps, of each key, only the newest, as a slow one may be sent."""

    def __init__(self) -> None:
        self.role, self.person = Role.GUEST, "somebody"
        self.came: list[bytes] = []

    def sees(self, document: str) -> bool:
        del document
        return True

    def post(self, data: bytes, *, binary: bool = False, key: str | None = None) -> None:
        del binary, key
        self.came.append(data)


class Lanes:
    def __init__(self) -> None:
        self.asked: list[Up] = []
        self.lanes = RelayedLanes(self.asked.append, lambda lane: f"ticket of {lane}")

    def snapshot(self, *data: bytes, lane: str = "rover") -> None:
        self.lanes.take_snapshot(LaneSnapshot(lane, tuple(map(Frame, data))))

    def frame(self, data: bytes, key: str = "", lane: str = "rover") -> None:
        self.lanes.take_frame(LaneFrame(lane, Frame(data, False, key)))

    async def page(self, lane: str = "rover") -> Page:
        page = Page()
        await self.lanes.watch(lane, page)
        return page


def in_loop(story: Callable[[Lanes], Coroutine[Any, Any, None]]) -> None:
    async def run() -> None:
        await story(Lanes())

    asyncio.run(run())


def test_a_lane_is_opened_once_and_who_waits_gets_its_snapshot_and_what_came_since():
    async def story(lanes: Lanes) -> None:
        waiting = [asyncio.create_task(lanes.page()) for _ in range(3)]
        await asyncio.sleep(0)
        assert lanes.asked == [OpenLane("rover", "ticket of rover")]
        lanes.snapshot(b"state")
        pages = await asyncio.gather(*waiting)
        lanes.frame(b"change")
        late = await lanes.page()
        assert [one.came for one in (*pages, late)] == [[b"state", b"change"]] * 4

    in_loop(story)


@given(st.lists(st.tuples(st.binary(min_size=1, max_size=3), st.sampled_from(["", "a", "b"]))))
def test_who_comes_later_has_what_still_counts_of_all_that_came(frames: list[tuple[bytes, str]]):
    async def story(lanes: Lanes) -> None:
        lanes.asked.clear()
        early = asyncio.create_task(lanes.page())
        await asyncio.sleep(0)
        lanes.snapshot(b"state")
        assert (await early).came == [b"state"]
        for data, key in frames:
            lanes.frame(data, key)
        late = await lanes.page()
        counting = [
            data
            for at, (data, key) in enumerate(frames)
            if not key or all(other != key for _, other in frames[at + 1 :])
        ]
        assert late.came == [b"state", *counting]
        assert early.result().came == [b"state", *(data for data, _ in frames)]

    in_loop(story)


def test_when_more_came_than_the_state_has_it_is_asked_for_again_and_pages_are_not_sent_it():
    async def story(lanes: Lanes) -> None:
        opening = asyncio.create_task(lanes.page())
        await asyncio.sleep(0)
        lanes.snapshot(b"state")
        page = await opening
        lanes.asked.clear()
        for _ in range(5):
            lanes.frame(bytes(100_000))
        assert lanes.asked == [Refresh("rover")]
        lanes.snapshot(b"newer state")
        assert b"newer state" not in page.came
        assert (await lanes.page()).came == [b"newer state"]

    in_loop(story)


def test_after_the_line_was_cut_pages_are_sent_the_whole_state_anew():
    async def story(lanes: Lanes) -> None:
        opening = asyncio.create_task(lanes.page())
        await asyncio.sleep(0)
        lanes.snapshot(b"state")
        page = await opening
        lanes.asked.clear()
        lanes.lanes.renew()
        assert lanes.asked == [
            OpenLane(STUDIO_LANE, "ticket of "),
            OpenLane("rover", "ticket of rover"),
        ]
        lanes.snapshot(b"newer state")
        assert page.came == [b"state", b"newer state"]

    in_loop(story)


def test_what_the_presenter_looks_at_goes_to_who_follows_and_is_forgotten_when_told_so():
    async def story(lanes: Lanes) -> None:
        studio = lanes.lanes.studio
        lanes.snapshot(b"lobby", lane=STUDIO_LANE)
        looks, follows = Page(), Page()
        for page in (looks, follows):
            studio.add(page)
        studio.follow(follows, following=True)
        lanes.frame(b"eye", "view", lane=STUDIO_LANE)
        assert (looks.came, follows.came) == ([b"lobby"], [b"lobby", b"eye"])
        studio.follow(looks, following=True)
        assert looks.came == [b"lobby", b"eye"]
        lanes.frame(b"", "view", lane=STUDIO_LANE)
        later = Page()
        studio.add(later)
        studio.follow(later, following=True)
        assert later.came == [b"lobby"]

    in_loop(story)


def test_who_leaves_a_lane_before_it_is_there_is_sent_nothing_of_it():
    async def story(lanes: Lanes) -> None:
        page = Page()
        opening = asyncio.create_task(lanes.lanes.watch("rover", page))
        following = asyncio.create_task(lanes.lanes.watch("!changes graph", page))
        await asyncio.sleep(0)
        lanes.lanes.leave(page)
        lanes.lanes.unfollow("!changes graph", page)
        for name in ("rover", "!changes graph"):
            lanes.snapshot(b"state", lane=name)
        await asyncio.gather(opening, following)
        lanes.frame(b"change")
        assert page.came == []

    in_loop(story)


def test_a_lane_that_is_none_is_told_and_another_page_may_ask_again():
    async def story(lanes: Lanes) -> None:
        opening = asyncio.create_task(lanes.page("gone"))
        await asyncio.sleep(0)
        lanes.lanes.close("gone", "There is no such document.")
        with pytest.raises(CommandError, match="no such document"):
            await opening
        lanes.asked.clear()
        again = asyncio.create_task(lanes.page("gone"))
        await asyncio.sleep(0)
        assert lanes.asked == [OpenLane("gone", "ticket of gone")]
        again.cancel()

    in_loop(story)


def test_a_page_that_left_is_sent_nothing_and_a_lane_that_nobody_has_open_is_closed_later(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.setattr("studio.server.relays.relayed_lanes._IDLE_S", 0.0)

    async def story(lanes: Lanes) -> None:
        opening = asyncio.create_task(lanes.page())
        await asyncio.sleep(0)
        lanes.snapshot(b"state")
        page = await opening
        lanes.lanes.close_idle()
        lanes.lanes.forget(page)
        lanes.frame(b"change")
        assert page.came == [b"state"]
        lanes.asked.clear()
        await asyncio.sleep(0.001)
        lanes.lanes.close_idle()
        assert lanes.asked == [CloseLane("rover")]

    in_loop(story)
