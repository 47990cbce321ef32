from __future__ import annotations

import asyncio
import shutil
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from rosbags.rosbag2 import Reader

from studio.bags.opening import open_bag
from studio.errors import BagNotWrittenError, CommandError, RecordingError
from studio.live.connection.ros_connection import RosConnection
from studio.live.panels.recording import BagRecording
from studio.protocol.recording import (
    CutBag,
    ListBags,
    SavePast,
    StartRecording,
    StopRecording,
    StopWriting,
)
from studio.protocol.roles import Role
from studio.settings import WireChoice
from tests.support.bridged import bridged
from tests.support.open_documents import Ear, until
from tests.support.told_recording import ToldRecording

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.bags.recording import Recording
    from studio.live.panels.ros_system import RosSystem


@dataclass
class Shown:
    recording: Recording
    zero_ns: int


def state(ear: Ear) -> dict[str, Any]:
    return ear.last("recording_state")


def shares(ear: Ear) -> list[float | None]:
    """What was told of a part that is written."""
    return [one["done"] for one in ear.events if one["type"] == "bag_writing"]


@contextmanager
def talking(ros: RosSystem) -> Generator[None]:
    """Publish on /words by a node of the connection, twenty times a second."""
    link = ros.connection.current
    assert link is not None
    kind = link.types.message("std_msgs/msg/String")
    publisher = link.node.create_publisher(kind, "/words", 10)
    timer = link.node.create_timer(0.05, lambda: publisher.publish(kind(data="word")))
    try:
        yield
    finally:
        link.node.destroy_timer(timer)
        link.node.destroy_publisher(publisher)


def test_b1_what_a_page_records_is_listed_whole_and_a_part_of_it_is_cut(endpoint: str):
    async def story() -> None:
        async with bridged(endpoint) as bridge:
            ros, ear = bridge.ros, bridge.ear
            ros.attach(ear)
            with talking(ros):
                await bridge.do(StartRecording(topics=("/words",), name="first"))
                with pytest.raises(CommandError, match="under way"):
                    await bridge.do(StartRecording())
                await until(lambda: state(ear)["messages"] >= 20)
                await bridge.do(StopRecording())
            ended = state(ear)
            assert (ended["recording"], ended["lost"], ended["trouble"]) == (False, 0, "")
            with Reader(Path(ended["path"])) as reader:
                assert reader.message_count == ended["messages"]
            listed = await bridge.do(ListBags())
            assert [(one.name, one.messages) for one in listed.bags] == [
                ("first", ended["messages"])
            ]
            bag = open_bag(Path(listed.bags[0].path))
            ros.recording.shown = lambda _: nullcontext(Shown(bag, bag.begin_ns))
            whole_s = (bag.end_ns - bag.begin_ns) / 1e9
            written = await bridge.do(CutBag(begin_s=0.0, end_s=whole_s / 2, name="half"))
            expected = bag.counts("/words", bag.begin_ns, bag.end_ns + 1, 1)[0]
            assert 0 < written.messages < expected == ended["messages"]
            with pytest.raises(BagNotWrittenError, match="that name already"):
                await bridge.do(CutBag(begin_s=0.0, end_s=1.0, name="half"))
            with pytest.raises(RecordingError, match="later end"):
                await bridge.do(CutBag(begin_s=1.0, end_s=0.5, name="none"))
            assert not (ros.recording.folder / "none").exists()
            ros.recording.past = ros.recording.shown
            kept = await bridge.do(SavePast(seconds=3600, name="all"))
            assert kept.messages == ended["messages"]
            bag.close()

    asyncio.run(story())


def test_a_part_that_is_written_is_told_and_can_be_stopped(endpoint: str):
    recording = ToldRecording()
    recording.add_topic("/words")
    for at in range(1_000):
        recording.tell("/words", at, data="word")

    async def story() -> None:
        async with bridged(endpoint) as bridge:
            bags, ear = bridge.ros.recording, bridge.ear
            bridge.ros.attach(ear)
            bags.shown = lambda _: nullcontext(Shown(recording, recording.begin_ns))
            recording.gate.clear()
            cut = asyncio.ensure_future(bridge.do(CutBag(begin_s=0.0, end_s=1.0, name="part")))
            await until(lambda: shares(ear) == [0.0])
            with pytest.raises(CommandError, match="already"):
                await bridge.do(CutBag(begin_s=0.0, end_s=1.0, name="other"))
            later = Ear()
            bridge.ros.attach(later)
            assert shares(later) == [0.0]
            await bridge.do(StopWriting())
            recording.gate.set()
            with pytest.raises(CommandError, match="no bag is left"):
                await cut
            assert shares(later)[-1] is None
            assert list(bags.folder.iterdir()) == []
            written = await bridge.do(CutBag(begin_s=0.0, end_s=1.0, name="part"))
            assert written.messages == 1_000

    try:
        asyncio.run(story())
    finally:
        recording.gate.set()  # else whoever reads would wait for ever


def test_a_recording_goes_on_without_its_page_and_is_whole_when_the_connection_ends(endpoint: str):
    async def story() -> None:
        async with bridged(endpoint) as bridge:
            ros, ear = bridge.ros, bridge.ear
            ros.attach(ear)
            with talking(ros):
                await bridge.do(StartRecording(name="left"))
                ros.detach(ear)
                later = Ear()
                ros.attach(later)
                await until(lambda: state(later)["messages"] >= 10)
                await ros.let_go()
            with Reader(ros.recording.folder / "left") as reader:
                assert reader.topics["/words"].msgcount >= 10
            assert not state(later)["recording"]

    asyncio.run(story())


def test_a_recording_whose_folder_is_taken_away_ends_saying_so_and_the_next_one_begins(
    endpoint: str,
):
    async def story() -> None:
        async with bridged(endpoint) as bridge:
            ros, ear = bridge.ros, bridge.ear
            ros.attach(ear)
            with talking(ros):
                await bridge.do(StartRecording(topics=("/words",), name="gone"))
                await until(lambda: state(ear)["messages"] > 0)
                shutil.rmtree(ros.recording.folder / "gone")
                await until(lambda: state(ear)["free_bytes"] == 0)
                await bridge.do(StopRecording())
                assert "gone" in state(ear)["trouble"]
                await bridge.do(StartRecording(topics=("/words",), name="next"))
                await until(lambda: state(ear)["messages"] > 0)
                await bridge.do(StopRecording())
            assert (state(ear)["recording"], state(ear)["trouble"]) == (False, "")

    asyncio.run(story())


def test_where_bags_lie_is_told_to_nobody_but_the_owner(endpoint: str):
    async def story() -> None:
        async with bridged(endpoint) as bridge:
            guest = Ear(Role.GUEST)
            bridge.ros.attach(bridge.ear)
            bridge.ros.attach(guest)
            await bridge.do(StartRecording(name="hidden"))
            await until(lambda: state(guest)["recording"])
            assert state(guest)["path"] == ""
            assert state(bridge.ear)["path"].endswith("bags/hidden")

    asyncio.run(story())


@pytest.mark.parametrize("name", ["../out", "a/b", ".hidden", "C:x", "a\nb"])
def test_no_name_leads_out_of_the_folder(endpoint: str, name: str):
    async def story() -> None:
        async with bridged(endpoint) as bridge:
            with pytest.raises(CommandError, match="no name of a bag"):
                await bridge.do(StartRecording(name=name))

    asyncio.run(story())


def test_without_a_connection_or_a_recording_it_says_so(tmp_path: Path):
    async def story() -> None:
        recording = BagRecording(RosConnection(WireChoice("off")), tmp_path / "bags")
        with pytest.raises(CommandError, match="connect first"):
            await recording.start(StartRecording())
        with pytest.raises(CommandError, match="shows no recording"):
            await recording.cut(CutBag(begin_s=0, end_s=1))
        with pytest.raises(CommandError, match="shows no recording"):
            await recording.save_past(SavePast(seconds=1))
        await recording.stop()
        assert (await recording.list(ListBags())).bags == ()

    asyncio.run(story())
