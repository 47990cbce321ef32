"""The last minutes of a live system: documents go back into them, and to what runs now."""

from __future__ import annotations

import asyncio
from collections import Counter
from contextlib import asynccontextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from mcap.reader import make_reader

from studio.protocol.connection import ConnectWire, SetJointSource
from studio.protocol.displays import GetTf
from studio.protocol.playback import GetTimeMarks, GetTimeTicks, GoLive, SeekTime
from studio.protocol.recording import CutBag, SavePast
from tests.support.open_documents import until
from tests.support.wired_studio import joint_states_of, studio, tf_of

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator

    from studio.protocol import Command
    from studio.ros.client import Node
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
            await past.seen.do(GoLive())
            assert past.state["mode"] == "live"
            await past.stand(0.75)

    asyncio.run(story())


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
            half_s = begin_s + (last_s - begin_s) / 2
            cut = CutBag(begin_s=begin_s, end_s=half_s, topics=("/tf",), name="half")
            part = await past.ask(cut, "bag_written")
            assert list(counted(part["path"])) == ["/tf"]
            assert 0 < part["messages"] < counts["/tf"]

    asyncio.run(story())


def counted(bag: str) -> Counter[str]:
    """How many messages of each topic the library of MCAP reads in a bag."""
    found = Counter[str]()
    for file in Path(bag).glob("*.mcap"):
        with file.open("rb") as stream:
            found.update(one.topic for _, one, _ in make_reader(stream).iter_messages())
    return found
