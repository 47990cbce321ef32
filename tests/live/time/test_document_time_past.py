"""The last minutes of a live system: documents go back into them, and to what runs now."""

from __future__ import annotations

import asyncio
import math
from collections import Counter
from contextlib import asynccontextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from mcap.reader import make_reader

from studio.errors import CommandError
from studio.live.topics.request import Request
from studio.protocol.connection import ConnectWire, DisconnectWire, SetJointSource
from studio.protocol.copies import DiscardCopy
from studio.protocol.displays import GetTf
from studio.protocol.documents import Watch
from studio.protocol.playback import (
    GetTimeMarks,
    GetTimeTicks,
    GoLive,
    OpenBag,
    SeekTime,
    StepTime,
)
from studio.protocol.recording import CutBag, SavePast
from studio.ros.messages import message
from studio.settings import WireChoice
from tests.support.class_room import run as run_class
from tests.support.open_documents import Ear, until
from tests.support.wired_studio import STATES, joint_states_of, states_out, studio, tf_of

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator

    from studio.protocol import Command
    from studio.ros.client import Node
    from tests.support.class_room import Page, Room
    from tests.support.wired_studio import Studio


class Past:
    """A robot that moves, seen by a document; its joint says when it was where."""

    def __init__(self, seen: Studio, tester: Node) -> None:
        self.seen = seen
        self._states, self._tf = joint_states_of(tester), tf_of(tester)

    async def ask(self, command: Command, answer: str) -> dict[str, Any]:
        await self.seen.do(command)
        return self.seen.ear.last(answer)

    @property
    def state(self) -> dict[str, Any]:
        return self.seen.ear.last("time_state")

    async def stand(self, position: float) -> float:
        """Have it stand there until that is seen; when that was, as pages count."""

        def is_seen() -> bool:
            self._states(position)
            self._tf(position)
            return self.seen.position("shoulder") == pytest.approx(position)

        await until(is_seen)
        past = self.seen.engine.ros.connection.past
        return (past.end_ns - past.zero_ns) / 1e9

    async def turned(self) -> float:
        """How far TF has the joint, as the sine of half its angle."""
        found = await self.ask(GetTf(frame="upper", seen_from="base", pose_only=True), "tf_frames")
        return found["pose"]["wxyz"][3]


@asynccontextmanager
async def past_of(endpoint: str, folder: Path, tester: Node) -> AsyncGenerator[Past]:
    async with studio(endpoint, folder) as seen:
        await seen.do(ConnectWire())
        await seen.do(SetJointSource(source="joint_states"))
        yield Past(seen, tester)


def test_a_live_document_shows_what_was_and_then_again_what_runs(
    endpoint: str, tmp_path: Path, tester: Node
):
    async def story() -> None:
        async with past_of(endpoint, tmp_path, tester) as past:
            first_s = await past.stand(0.25)
            second_s = await past.stand(-0.5)
            await until(lambda: past.state["end_s"] > second_s)
            state = past.state
            assert (state["mode"], state["queue"], state["playing"]) == ("live", 0, False)
            assert state["begin_s"] <= first_s <= second_s <= state["end_s"]
            assert 0 < state["kept_bytes"] < state["kept_bytes_max"] == 256 << 20
            await past.seen.do(SeekTime(at_s=first_s))
            assert (past.state["mode"], past.state["path"]) == ("past", "")
            assert past.state["zero_s"] == state["zero_s"]
            assert past.state["now_s"] == pytest.approx(first_s, abs=1e-6)
            await until(lambda: past.seen.position("shoulder") == pytest.approx(0.25))
            await until(lambda: past.seen.document.feed.source == "joint_states")
            assert await past.turned() == pytest.approx(math.sin(0.125))
            await past.seen.do(SeekTime(at_s=second_s))
            assert past.seen.position("shoulder") == pytest.approx(-0.5)
            assert await past.turned() == pytest.approx(math.sin(-0.25))
            late = Ear()
            past.seen.document.attach(late)
            assert late.last("time_state")["now_s"] == past.state["now_s"]
            assert late.last("time_topics")["topics"]
            await past.seen.do(GoLive())
            assert past.state["mode"] == "live"
            await past.stand(0.75)
            assert await past.turned() == pytest.approx(math.sin(0.375))

    asyncio.run(story())


def test_a_step_back_from_what_runs_now_leads_to_the_last_message(
    endpoint: str, tmp_path: Path, tester: Node
):
    async def story() -> None:
        async with past_of(endpoint, tmp_path, tester) as past:
            last_s = await past.stand(0.25)
            await until(lambda: past.state["end_s"] > last_s + 1.0)
            await past.seen.do(StepTime(topic="/tf", forward=False))
            assert past.state["mode"] == "past"
            kept = past.seen.engine.ros.connection.past
            (last,) = kept.last("/tf", kept.end_ns, 1)
            assert past.state["now_s"] == pytest.approx((last.received_ns - kept.zero_ns) / 1e9)

    asyncio.run(story())


def test_another_bag_and_the_end_of_the_connection_end_the_past(
    endpoint: str, tmp_path: Path, tester: Node
):
    async def story() -> None:
        async with past_of(endpoint, tmp_path, tester) as past:
            at_s = await past.stand(0.25)
            await until(lambda: past.state["end_s"] > at_s)
            saved = await past.ask(SavePast(seconds=600, name="saved"), "bag_written")
            await past.seen.do(SeekTime(at_s=at_s))
            await past.seen.do(OpenBag(path=saved["path"]))
            assert (past.state["mode"], past.state["begin_s"]) == ("bag", 0.0)
            assert past.state["kept_bytes_max"] == 0
            await past.seen.do(GoLive())
            await past.seen.do(SeekTime(at_s=at_s))
            assert past.state["mode"] == "past"
            await past.seen.do(DisconnectWire())
            await until(lambda: past.state["mode"] == "live")
            assert (past.state["zero_s"], past.state["end_s"], past.state["kept_bytes"]) == (
                0,
                0,
                0,
            )
            with pytest.raises(CommandError, match="nothing of that is kept"):
                await past.seen.do(SeekTime(at_s=at_s))

    asyncio.run(story())


def test_a_flood_stays_within_the_memory_and_large_topics_are_thinned(
    endpoint: str, tmp_path: Path, tester: Node
):
    size_max = 16 << 20
    kind = message("std_msgs/msg/String")
    out = tester.create_publisher(kind, "/blob", 10)
    blob = kind(data="x" * 500_000)

    async def story() -> None:
        async with studio(endpoint, tmp_path, rewind_bytes=size_max) as seen:
            await seen.do(ConnectWire())
            past = seen.engine.ros.connection.past
            looked_at = seen.document.source.subscribe(Request("/blob", newest_only=True))
            states, sizes, count = joint_states_of(tester), set[int](), 0
            async with asyncio.timeout(60):
                while count < 200 or not is_thinned(seen.ear):
                    out.publish(blob)
                    states(0.25)
                    count += 1
                    sizes.add(seen.ear.last("time_state")["kept_bytes"])
                    await asyncio.sleep(0.01)
            past.collect()
            assert max(sizes | {past.size}) <= size_max
            assert past.last("/joint_states", past.end_ns, 1)
            looked_at.close()

    asyncio.run(story())


def is_thinned(ear: Ear) -> bool:
    """Whether pages are told that of a large topic not all is kept."""
    topics = {one["name"]: one for one in ear.last("time_topics")["topics"]}
    return "/blob" in topics and "one message in up to" in topics["/blob"]["note"]


def test_copies_rewind_by_themselves_and_who_finds_no_place_waits_in_what_runs(
    endpoint: str, tmp_path: Path, tester: Node, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("studio.live.time.rewinding.SEATS", 2)

    async def work(room: Room) -> None:
        await room.ask(room.presenter, ConnectWire())
        states = states_out(tester)
        timer = tester.create_timer(0.05, lambda: states.publish(message(STATES)(name=["x"])))
        ada, bob = await room.student("Ada"), await room.student("Bob")
        copies = [await room.copy(ada), await room.copy(bob)]
        await room.ask(room.presenter, Watch(document=room.shared.id))
        pages = (room.presenter, ada, bob)
        await until(lambda: all(state_of(one)["end_s"] > 1.0 for one in pages))
        await room.ask(room.presenter, SeekTime(document=room.shared.id, at_s=0.5))
        await room.ask(ada, SeekTime(document=copies[0].id, at_s=0.6))
        assert copies[0].time.recording is room.shared.time.recording
        await room.ask(bob, SeekTime(document=copies[1].id, at_s=0.1))
        assert told_of(bob) == ("live", 1)
        await room.ask(bob, SeekTime(document=copies[1].id, at_s=0.7))
        assert copies[1].source.is_live
        await room.ask(ada, GoLive(document=copies[0].id))
        await until(lambda: told_of(bob) == ("past", 0))
        assert state_of(bob)["now_s"] == pytest.approx(0.7)
        assert [state_of(one)["mode"] for one in pages] == ["past", "live", "past"]
        await room.ask(ada, SeekTime(document=copies[0].id, at_s=0.6))
        assert told_of(ada) == ("live", 1)
        await room.ask(bob, DiscardCopy(document=copies[1].id))
        await until(lambda: told_of(ada) == ("past", 0))
        tester.destroy_timer(timer)

    run_class(tmp_path, work, wire=WireChoice("off", (endpoint,)))


def test_who_leaves_gives_the_place_up(
    endpoint: str, tmp_path: Path, tester: Node, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("studio.live.time.rewinding.SEATS", 1)
    monkeypatch.setattr("studio.live.time.document_time._LEFT_S", 0.5)
    monkeypatch.setattr("studio.documents.copies.copies._LOOK_EVERY_S", 0.1)
    monkeypatch.setattr("studio.documents.copies.copies._REST_AFTER_S", 0.1)

    async def work(room: Room) -> None:
        await room.ask(room.presenter, ConnectWire())
        states = states_out(tester)
        timer = tester.create_timer(0.05, lambda: states.publish(message(STATES)(name=["x"])))
        ada, bob = await room.student("Ada"), await room.student("Bob")
        copies = [await room.copy(ada), await room.copy(bob)]
        await room.ask(room.presenter, Watch(document=room.shared.id))
        await until(lambda: state_of(ada)["end_s"] > 1.0)
        await room.ask(ada, SeekTime(document=copies[0].id, at_s=0.5))
        await room.ask(room.presenter, SeekTime(document=room.shared.id, at_s=0.5))
        await room.ask(bob, SeekTime(document=copies[1].id, at_s=0.5))
        assert [told_of(one) for one in (ada, room.presenter, bob)] == [
            ("past", 0),
            ("live", 1),
            ("live", 2),
        ]
        room.engine.detach(ada)  # the copy rests
        await until(lambda: told_of(room.presenter) == ("past", 0))
        assert told_of(bob) == ("live", 1)
        room.engine.detach(room.presenter)  # the shared document stays open
        await until(lambda: told_of(bob) == ("past", 0))
        assert room.shared.source.is_live
        tester.destroy_timer(timer)

    run_class(tmp_path, work, wire=WireChoice("off", (endpoint,)))


def test_of_nine_copies_eight_rewind_at_once_and_share_one_past(
    endpoint: str, tmp_path: Path, tester: Node
):
    async def work(room: Room) -> None:
        await room.ask(room.presenter, ConnectWire())
        states = states_out(tester)
        timer = tester.create_timer(0.05, lambda: states.publish(message(STATES)(name=["x"])))
        students = [await room.student(f"S{number}") for number in range(9)]
        copies = [await room.copy(one) for one in students]
        await until(lambda: all(state_of(one)["end_s"] > 1.0 for one in students))
        for student, copy in zip(students, copies, strict=True):
            await room.ask(student, SeekTime(document=copy.id, at_s=0.5))
        assert [told_of(one) for one in students] == [("past", 0)] * 8 + [("live", 1)]
        assert {one.time.recording for one in copies[:8]} == {room.engine.ros.connection.past}
        await room.ask(students[3], GoLive(document=copies[3].id))
        await until(lambda: told_of(students[8]) == ("past", 0))
        tester.destroy_timer(timer)

    run_class(tmp_path, work, wire=WireChoice("off", (endpoint,)))


def state_of(page: Page) -> dict[str, Any]:
    return page.last("time_state")


def told_of(page: Page) -> tuple[str, int]:
    """What a page shows, and how many wait before it."""
    return state_of(page)["mode"], state_of(page)["queue"]


def test_the_past_is_marked_while_the_document_is_live_and_a_part_of_it_is_a_bag(
    endpoint: str, tmp_path: Path, tester: Node
):
    async def story() -> None:
        async with past_of(endpoint, tmp_path, tester) as past:
            await past.stand(0.25)
            last_s = await past.stand(-0.5)
            await until(lambda: past.state["end_s"] > last_s)
            topics = {one["name"] for one in past.seen.ear.last("time_topics")["topics"]}
            assert {"/joint_states", "/tf"} <= topics
            begin_s = past.state["begin_s"]
            asked = GetTimeMarks(topic="/tf", begin_s=begin_s, end_s=last_s + 1.0, bins=10)
            marks = await past.ask(asked, "time_marks")
            ticks = await past.ask(GetTimeTicks(), "time_ticks")
            assert (ticks["ticks"], ticks["more"]) == ([], 0)
            saved = await past.ask(SavePast(seconds=600, name="saved"), "bag_written")
            counts = counted(saved["path"])
            assert sum(counts.values()) == saved["messages"]
            assert counts["/tf"] == sum(marks["counts"]) > 1
            cut = CutBag(begin_s=begin_s, end_s=last_s + 1.0, topics=("/tf",), name="part")
            part = await past.ask(cut, "bag_written")
            assert counted(part["path"]) == {"/tf": counts["/tf"]}

    asyncio.run(story())


def counted(bag: str) -> Counter[str]:
    """How many messages of each topic the library of MCAP reads in a bag."""
    found = Counter[str]()
    for file in Path(bag).glob("*.mcap"):
        with file.open("rb") as stream:
            found.update(one.topic for _, one, _ in make_reader(stream).iter_messages())
    return found
