"""The time of copies: a student rewinds alone, and a stranger not at all."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import NotAllowedError, NotInControlError, UnknownDocumentError
from studio.protocol.classroom import GiveControl
from studio.protocol.logs import GetLog
from studio.protocol.playback import GoLive, OpenBag, PlayTime, SeekTime
from tests.support.class_room import Page, Room, run
from tests.support.open_documents import until
from tests.support.recorded_arm import write_arm_bag

if TYPE_CHECKING:
    from pathlib import Path


async def with_bag(room: Room, tmp_path: Path) -> None:
    """Show the bag to the class."""
    bag = tmp_path / "rover_description" / "run"
    if not bag.exists():
        await asyncio.to_thread(write_arm_bag, bag)
    await room.ask(room.presenter, OpenBag(document=room.shared.id, path=str(bag)))


def stands_at_s(page: Page) -> float:
    return page.last("time_state")["now_s"]


def test_a_student_rewinds_alone_and_the_class_stays_where_it_is(tmp_path: Path):
    async def work(room: Room) -> None:
        await with_bag(room, tmp_path)
        await room.ask(room.presenter, SeekTime(document=room.shared.id, at_s=5.0))
        ada = await room.student("Ada")
        copy = await room.copy(ada)
        await until(lambda: copy.time.recording is not None)
        assert copy.time.recording is room.shared.time.recording  # read once for all
        await room.ask(ada, SeekTime(document=copy.id, at_s=15.0))
        assert stands_at_s(ada) == 15.0
        assert room.shared.time.at_ns - room.shared.time.zero_ns == 5 * 10**9
        await room.ask(ada, GoLive(document=copy.id))
        assert ada.last("time_state")["mode"] == "live"
        await room.ask(ada, SeekTime(document=copy.id, at_s=2.0))  # back to the bag of the class
        assert ada.last("time_state")["mode"] == "bag"
        assert room.shared.time.recording is not None
        end_s = ada.last("time_state")["end_s"]
        await room.ask(ada, GoLive(document=copy.id))  # what the class shows is still offered
        assert (ada.last("time_state")["title"], ada.last("time_state")["end_s"]) == ("run", end_s)
        assert {one["name"] for one in ada.last("time_topics")["topics"]} >= {"/tf", "/rosout"}
        await room.ask(room.presenter, GoLive(document=room.shared.id))
        assert (ada.last("time_state")["title"], ada.last("time_state")["end_s"]) == ("", 0.0)
        assert ada.last("time_topics")["topics"] == []

    run(tmp_path, work)


def test_copies_follow_the_class_to_another_bag_and_back_to_what_runs(tmp_path: Path):
    async def work(room: Room) -> None:
        ada = await room.student("Ada")
        copy = await room.copy(ada)
        await with_bag(room, tmp_path)
        await until(lambda: copy.time.recording is room.shared.time.recording)
        await until(lambda: "/rosout" in {one.name for one in copy.source.catalogue()})
        await with_bag(room, tmp_path)
        await until(lambda: copy.time.recording is room.shared.time.recording)
        await room.ask(room.presenter, GoLive(document=room.shared.id))
        await until(lambda: copy.time.recording is None)
        assert copy.source.is_live

    run(tmp_path, work)


def test_who_has_no_control_moves_no_time_and_a_copy_is_nobody_elses(tmp_path: Path):
    async def work(room: Room) -> None:
        await with_bag(room, tmp_path)
        ada, bob = await room.student("Ada"), await room.student("Bob")
        copy = await room.copy(ada)
        await until(lambda: copy.time.recording is not None)
        with pytest.raises(NotInControlError):
            await room.ask(ada, SeekTime(document=room.shared.id, at_s=1.0))
        with pytest.raises(UnknownDocumentError):
            await room.ask(bob, SeekTime(document=copy.id, at_s=1.0))
        with pytest.raises(UnknownDocumentError):
            await room.ask(bob, GetLog(document=copy.id))
        with pytest.raises(NotAllowedError):
            await room.ask(ada, OpenBag(document=copy.id, path=copy.time.path))
        await room.ask(room.presenter, GiveControl(document=room.shared.id, person=ada.person))
        await room.ask(ada, SeekTime(document=room.shared.id, at_s=1.0))
        await room.ask(ada, PlayTime(document=room.shared.id, playing=False))
        assert room.shared.time.at_ns - room.shared.time.zero_ns == 10**9

    run(tmp_path, work)
