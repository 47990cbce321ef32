"""Bags as documents: the robot stands, and panels show, what there was at the moment."""

from __future__ import annotations

import asyncio
import math
import threading
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

import pytest

from studio.bags.mcap_writer import Chunking
from studio.bags.writer import Storing
from studio.errors import BagNotReadableError, CommandError, OutsideRootsError
from studio.live.time.shown import ShownRecording
from studio.protocol.connection import SetJointSource
from studio.protocol.diagnostics import GetDiagnostics
from studio.protocol.displays import AddDisplay, GetTf, GetTopics, SetFixedFrame
from studio.protocol.documents import CloseDocument, OpenPath
from studio.protocol.graph import GetGraph, GetNode
from studio.protocol.interfaces import GetInterface
from studio.protocol.logs import GetLog
from studio.protocol.playback import (
    GetSeries,
    GetTimeMarks,
    GoLive,
    LoopTime,
    OpenBag,
    PlayTime,
    SeekTime,
    SetTimeRate,
    StepTime,
)
from studio.protocol.recording import CutBag
from studio.protocol.scene_time import GetSceneTime
from studio.protocol.topic_rates import GetTopicRates
from studio.protocol.topics import GetTopicEnds, ListTopics
from studio.scene import DocumentScene
from tests.support.open_documents import Ear, engine, opened, until
from tests.support.recorded_arm import BEGIN_NS, LENGTH_S, URDF, angle_rad, base_pose, write_arm_bag
from tests.support.told_recording import ToldRecording, written
from tests.support.wired_studio import ARM

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Callable, Coroutine
    from pathlib import Path

    from studio.documents.document import Document
    from studio.documents.engine import Engine
    from studio.protocol import Command


class Shown:
    """A document that shows a bag, and a page's ear at it."""

    def __init__(self, made: Engine, document: Document, ear: Ear) -> None:
        self.engine, self.document, self.ear = made, document, ear

    async def ask(self, command: Command, answer: str = "") -> dict[str, Any]:
        """Have a command carried out, and give its answer."""
        asked = command.model_copy(update={"document": self.document.id})
        await self.engine.execute(asked, self.ear)
        return self.ear.last(answer) if answer else {}

    async def shoulder(self) -> float:
        return self.document.model.joints.by_name()["shoulder"]

    async def pose(self, frame: str, seen_from: str = "map") -> tuple[list[float], list[float]]:
        """Where TF has a frame, xyz and wxyz."""
        found = await self.ask(GetTf(frame=frame, seen_from=seen_from, pose_only=True), "tf_frames")
        assert found["pose"], found["trouble"]
        return found["pose"]["xyz"], found["pose"]["wxyz"]


@asynccontextmanager
async def shown_bag(folder: Path, *, with_robot: bool = True) -> AsyncGenerator[Shown]:
    """The bag of the arm, open as a document of its own."""
    bag = write_arm_bag(folder / "run", with_robot=with_robot)
    async with engine(folder / "data") as made:
        document, ear = await opened(made, bag)
        made.attach(ear)
        yield Shown(made, document, ear)


def run(
    folder: Path,
    work: Callable[[Shown], Coroutine[Any, Any, None]],
    *,
    with_robot: bool = True,
) -> None:
    async def within() -> None:
        async with shown_bag(folder, with_robot=with_robot) as shown:
            await work(shown)

    asyncio.run(within())


def last_at(at_s: float, every_s: float, offset_s: float) -> float:
    """When the last of regular messages came, s; told apart from the studio's own reckoning."""
    number = math.floor((at_s - 0.05 - offset_s) / every_s + 1e-9)
    return 0.05 + number * every_s


def test_a_bag_with_a_robot_opens_as_that_and_stands_where_tf_of_the_time_says(tmp_path: Path):
    async def work(shown: Shown) -> None:
        assert shown.document.model.kinematics.movable == ("shoulder",)
        state = shown.ear.last("time_state")
        assert (state["mode"], state["title"], state["begin_s"]) == ("bag", "run", 0.0)
        await until(lambda: shown.document.feed.source == "joint_states")
        for at_s in (3.0, 15.23, 7.777, 0.5, 19.99):
            await shown.ask(SeekTime(at_s=at_s))
            turned = angle_rad(last_at(at_s, 0.02, 0.002))
            assert await shown.shoulder() == pytest.approx(turned, abs=1e-6)
            x, y, yaw = base_pose(last_at(at_s, 0.05, 0.0))
            xyz, wxyz = await shown.pose("base")
            assert xyz == pytest.approx([x, y, 0.0], abs=1e-6)
            assert abs(wxyz[0]) == pytest.approx(abs(math.cos(yaw / 2)), abs=1e-6)
            # The tip: a static transform of the first moment, at the end of a chain of which
            # tf2 takes the newest time that all of it has.
            upper_s = last_at(at_s, 0.05, 0.001)
            bx, by, byaw = base_pose(min(upper_s, last_at(at_s, 0.05, 0.0)))
            tip, _ = await shown.pose("tip")
            reach = byaw + angle_rad(upper_s)
            expected = [bx + 0.5 * math.cos(reach), by + 0.5 * math.sin(reach), 0.0]
            assert tip == pytest.approx(expected, abs=1e-6)

    run(tmp_path, work)


def test_a_robot_of_a_bag_drives_through_its_world_until_another_frame_is_chosen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    places: list[tuple[float, ...]] = []
    place_robot = DocumentScene.place_robot

    def noted(
        scene: DocumentScene, wxyz: tuple[float, float, float, float], xyz: tuple[float, ...]
    ) -> None:
        places.append(xyz)
        place_robot(scene, wxyz, (xyz[0], xyz[1], xyz[2]))

    monkeypatch.setattr(DocumentScene, "place_robot", noted)

    async def work(shown: Shown) -> None:
        for at_s in (3.0, 15.23):
            await shown.ask(SeekTime(at_s=at_s))
            x, y, _ = base_pose(last_at(at_s, 0.05, 0.0))
            await until(lambda: bool(places))
            assert places[-1] == pytest.approx((x, y, 0.0), abs=1e-6)
        await shown.ask(SetFixedFrame(frame="upper"))
        await shown.ask(CloseDocument())
        await shown.engine.execute(OpenPath(path=str(tmp_path / "run")), shown.ear)
        again = shown.engine.document(shown.ear.last("opened")["document"])
        assert again.live.kept.fixed_frame == "upper"

    run(tmp_path, work)


def test_panels_show_the_moment_and_not_what_came_after(tmp_path: Path):
    async def work(shown: Shown) -> None:
        async def log() -> list[str]:
            return [one["text"] for one in (await shown.ask(GetLog(), "log"))["lines"]]

        async def diagnosed() -> list[tuple[str, float]]:
            parts = (await shown.ask(GetDiagnostics(), "diagnostics"))["parts"]
            return [(one["message"], one["age_s"]) for one in parts[:1]]

        await shown.ask(SeekTime(at_s=12.5))
        await log()
        await shown.ask(GetDiagnostics(), "diagnostics")
        await until_async(log, [f"second {number}" for number in range(13)])
        await until_async(diagnosed, [("12", 0.4)])
        await shown.ask(SeekTime(at_s=4.5))
        assert await log() == [f"second {number}" for number in range(5)]
        found = await shown.ask(GetDiagnostics(), "diagnostics")
        assert found["parts"][0]["message"] == "4"
        await shown.ask(SeekTime(at_s=0.0))
        assert await log() == []
        assert (await shown.ask(GetDiagnostics(), "diagnostics"))["parts"] == []

    run(tmp_path, work)


async def until_async(ask: Callable[[], Coroutine[Any, Any, object]], expected: object) -> None:
    """Ask again and again until that is the answer."""
    async with asyncio.timeout(60):
        while await ask() != expected:  # noqa: ASYNC110 - nothing tells us when
            await asyncio.sleep(0.01)


def test_topics_rates_types_and_the_graph_are_those_of_the_bag(tmp_path: Path):
    async def work(shown: Shown) -> None:
        await shown.ask(SeekTime(at_s=10.0))
        table = await shown.ask(ListTopics(), "topic_table")
        rows = {one["name"]: one for one in table["topics"]}
        assert rows["/goal"]["kind"] == "PointStamped"
        assert rows["/silent"]["publishers"] == 1
        offered = await shown.ask(GetTopics(), "topics")
        assert "/map" in {one["name"] for one in offered["topics"]}
        ends = await shown.ask(GetTopicEnds(topic="/map"), "topic_ends")
        assert ends["publishers"][0]["durability"] == "transient local"
        rates = await shown.ask(GetTopicRates(topics=("/goal", "/map")), "topic_rates")
        by_name = {one["name"]: one for one in rates["rates"]}
        assert 9 <= by_name["/goal"]["rate_hz"] <= 11
        assert by_name["/map"]["state"] == "latched"
        graph = await shown.ask(GetGraph(), "graph")
        assert [one["name"] for one in graph["nodes"]] == ["/run"]
        node = await shown.ask(GetNode(name="/run"), "node")
        assert {"name": "/goal", "type": "geometry_msgs/msg/PointStamped"} in node["publishers"]
        kind = await shown.ask(GetInterface(name="geometry_msgs/msg/PointStamped"), "interface")
        assert kind["parts"] == ["geometry_msgs/msg/PointStamped"]

    run(tmp_path, work)


def test_a_display_shows_the_message_of_the_moment_however_often_one_jumps(tmp_path: Path):
    async def work(shown: Shown) -> None:
        await shown.ask(SetFixedFrame(frame="map"))
        await shown.ask(AddDisplay(kind="PointStamped", topic="/goal"))
        await shown.ask(AddDisplay(kind="Map", topic="/map"))
        for at_s in (12.5, 3.5, 3.9, 19.0):
            await shown.ask(SeekTime(at_s=at_s))
            goal_s = last_at(at_s, 0.1, 0.003)
            [display] = [one for one in shown.document.live.kept.displays if one.topic == "/goal"]
            [item] = [
                placed
                for placed in shown.document.live.shown(display.id).drawing.values()
                if placed.stamp_ns
            ]
            assert item.stamp_ns == BEGIN_NS + round(goal_s * 1e9)
        await until(
            lambda: (
                (found := shown.document.live.states) is not None
                and all(one.remarks[0].level == "ok" for one in found.states)
            )
        )

    run(tmp_path, work)


def test_time_is_played_stepped_looped_and_told(tmp_path: Path):
    async def work(shown: Shown) -> None:
        await shown.ask(SetTimeRate(rate=10.0))
        await shown.ask(LoopTime(begin_s=5.0, end_s=6.0))
        state = shown.ear.last("time_state")
        assert (state["rate"], state["loop"]) == (10.0, [5.0, 6.0])
        await shown.ask(LoopTime())
        await shown.ask(SeekTime(at_s=10.0))
        await shown.ask(StepTime(topic="/rosout"))
        assert shown.ear.last("time_state")["now_s"] == pytest.approx(10.054, abs=1e-9)
        await shown.ask(StepTime(topic="/rosout", forward=False))
        assert shown.ear.last("time_state")["now_s"] == pytest.approx(9.054, abs=1e-9)
        await shown.ask(StepTime())
        assert shown.ear.last("time_state")["now_s"] == pytest.approx(9.055, abs=1e-9)
        await shown.ask(StepTime(topic="/silent"))
        assert shown.ear.last("time_state")["now_s"] == pytest.approx(9.055, abs=1e-9)
        marks = await shown.ask(
            GetTimeMarks(topic="/rosout", begin_s=0.0, end_s=20.0, bins=20), "time_marks"
        )
        assert marks["counts"] == [1] * 20
        await shown.ask(SeekTime(at_s=18.0))
        await shown.ask(PlayTime(playing=True))
        await until(lambda: not shown.ear.last("time_state")["playing"])
        end_s = shown.ear.last("time_state")["end_s"]
        assert shown.ear.last("time_state")["now_s"] == end_s > LENGTH_S
        scene = await shown.ask(GetSceneTime(), "scene_time")
        assert scene["ros_s"] == pytest.approx(BEGIN_NS / 1e9 + end_s, abs=1e-3)
        with pytest.raises(CommandError, match="ends after it begins"):
            await shown.ask(LoopTime(begin_s=6.0, end_s=5.0))

    run(tmp_path, work)


def test_times_beyond_every_recording_are_answered_like_others(tmp_path: Path):
    far_s = 1e308

    async def work(shown: Shown) -> None:
        marks = await shown.ask(
            GetTimeMarks(topic="/rosout", bins=1, begin_s=-far_s, end_s=far_s), "time_marks"
        )
        assert marks["counts"] == [20]
        asked = GetSeries(topic="/goal", path="point.x", columns=1, begin_s=-far_s, end_s=far_s)
        async with asyncio.timeout(60):
            while not (series := await shown.ask(asked, "series"))["exact"]:
                pass
        assert series["second"] == [pytest.approx(19.95)]
        await shown.ask(CutBag(name="whole", begin_s=-far_s, end_s=far_s), "bag_written")
        await shown.ask(SeekTime(at_s=far_s))
        state = shown.ear.last("time_state")
        assert state["now_s"] == state["end_s"]

    run(tmp_path, work)


def test_back_in_what_runs_now_nothing_of_the_bag_is_left(tmp_path: Path):
    async def work(shown: Shown) -> None:
        await shown.ask(SeekTime(at_s=12.5))
        await shown.ask(GoLive())
        assert shown.ear.last("time_state")["mode"] == "live"
        await until(lambda: shown.document.feed.source == "sliders")
        assert (await shown.ask(ListTopics(), "topic_table"))["topics"] == []
        with pytest.raises(CommandError, match="shows what runs now"):
            await shown.ask(SeekTime(at_s=1.0))
        with pytest.raises(CommandError, match="shows what runs now"):
            await shown.ask(PlayTime(playing=True))
        late = Ear()
        shown.document.attach(late)
        assert late.last("time_state")["mode"] == "live"

    run(tmp_path, work)


def test_a_bag_without_a_robot_is_a_frame_to_show_its_topics_in(tmp_path: Path):
    async def work(shown: Shown) -> None:
        assert shown.document.model.kinematics.link_names == ("map",)
        assert shown.ear.last("document")["is_bare"]
        assert shown.document.title == "run"
        await shown.ask(SeekTime(at_s=5.0))
        x, y, _ = base_pose(last_at(5.0, 0.05, 0.0))
        await shown.ask(GetTf(frame="base", seen_from="map"), "tf_frames")  # waits for TF
        assert (await shown.pose("base"))[0] == pytest.approx([x, y, 0.0], abs=1e-6)

    run(tmp_path, work, with_robot=False)


@pytest.mark.parametrize(
    ("kind", "payload", "why"),
    [
        ("std_msgs/msg/Header", b"\0\1\0\0", "it is of std_msgs/msg/Header"),
        ("std_msgs/msg/String", b"\0\1\0\0\xff\xff\0\0", "std_msgs/msg/String"),
        ("std_msgs/msg/String", b"\0\1\0\0\2\0\0\0a\0", "no <robot> in it"),
    ],
)
def test_a_description_that_is_none_leaves_the_rest_and_says_so(
    tmp_path: Path, kind: str, payload: bytes, why: str
):
    recording = ToldRecording()
    recording.add_topic("/robot_description", kind)
    recording.tell_bytes("/robot_description", 0, payload)
    recording.add_topic("/chatter")
    recording.tell("/chatter", 1000, data="on")

    async def work() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, written(recording, tmp_path / "run"))
            assert ear.last("document")["is_bare"]
            [trouble] = ear.last("time_state")["troubles"]
            assert trouble.startswith("There is no robot")
            assert why in trouble
            assert document.title == "run"

    asyncio.run(work())


def test_a_description_in_a_damaged_chunk_leaves_the_rest_and_says_so(tmp_path: Path):
    recording = ToldRecording()
    recording.add_topic("/robot_description")
    recording.tell("/robot_description", 0, data=URDF)
    recording.add_topic("/chatter")
    recording.tell("/chatter", 1000, data="on")
    chunking = Chunking(100)  # so that the other one is in a chunk of its own
    bag = written(recording, tmp_path / "run", Storing(chunking=chunking))
    file = bag / "run_0.mcap"
    file.write_bytes(file.read_bytes().replace(b"<robot", b"<tobor"))

    async def work() -> None:
        async with engine(tmp_path / "data") as made:
            _, ear = await opened(made, bag)
            assert ear.last("document")["is_bare"]
            troubles = " ".join(ear.last("time_state")["troubles"])
            assert "its part of the file is damaged" in troubles
            assert "its checksum is wrong" in troubles

    asyncio.run(work())


def test_what_was_shown_is_let_go_though_nobody_waits_for_the_next(tmp_path: Path):
    closed: list[str] = []

    def of(title: str) -> ShownRecording:
        recording = ToldRecording()
        recording.add_topic("/chatter")
        return ShownRecording(recording, "bag", title, title, lambda: closed.append(title))

    async def work(shown: Shown) -> None:
        time, source = shown.document.time, shown.document.source
        for title in "ab":
            with source.settling:  # so that nothing else is shown yet
                waiting = asyncio.create_task(time.show(of(title)))
                await until(lambda title=title: time.path == title)
                waiting.cancel()
                await asyncio.gather(waiting, return_exceptions=True)
            await until(lambda: getattr(source.current, "recording", None) is time.recording)
        await time.show(of("c"))
        assert closed == ["a", "b"]
        await shown.ask(CloseDocument())
        await until(lambda: closed == ["a", "b", "c"])

    run(tmp_path, work)
    assert not [one for one in threading.enumerate() if one.name == "recording"]


def test_an_open_robot_is_shown_against_the_recorded_one(tmp_path: Path):
    async def work() -> None:
        bag, file = write_arm_bag(tmp_path / "run"), tmp_path / "arm.urdf.xacro"
        file.write_text(ARM.replace('value="0.5"', 'value="0.8"'))
        async with engine(tmp_path / "data") as made:
            shown = Shown(made, *(await opened(made, file)))
            await shown.ask(SetJointSource(source="animation"))
            await shown.ask(SetJointSource(source="sliders"))
            await shown.ask(OpenBag(path=str(bag)), "opened")
            await until(lambda: shown.document.feed.source == "joint_states")
            await shown.ask(SeekTime(at_s=6.0))
            turned = angle_rad(last_at(6.0, 0.02, 0.002))
            assert await shown.shoulder() == pytest.approx(turned, abs=1e-6)
            [ghost] = shown.document.live.kept.displays
            assert (ghost.kind, ghost.topic) == ("RobotModel", "/robot_description")
            assert ghost.values["Alpha"] == 0.4
            await shown.ask(GoLive())
            assert shown.document.live.kept.displays == ()
            await until(lambda: shown.document.feed.source == "sliders")

    asyncio.run(work())


def test_what_is_no_bag_or_not_served_leaves_what_was_shown(tmp_path: Path):
    async def work(shown: Shown) -> None:
        secret = write_arm_bag(tmp_path / "elsewhere" / "secret")
        with pytest.raises(OutsideRootsError):
            await shown.ask(OpenBag(path=str(secret)))
        with pytest.raises(OutsideRootsError):
            await shown.engine.execute(OpenPath(path=str(secret)), shown.ear)
        (tmp_path / "run" / "sub").mkdir()
        with pytest.raises(CommandError, match="is no bag"):
            await shown.ask(OpenBag(path=str(tmp_path / "run" / "sub")))
        rubbish = tmp_path / "run" / "sub" / "rubbish.mcap"
        rubbish.write_bytes(b"rubbish" * 100)
        with pytest.raises(BagNotReadableError):
            await shown.ask(OpenBag(path=str(rubbish)))
        state = shown.ear.last("time_state")
        assert (state["mode"], state["title"], state["progress"]) == ("bag", "run", None)
        again = await shown.ask(OpenBag(path=str(tmp_path / "run")), "opened")
        assert again["document"] == shown.document.id

    (tmp_path / "elsewhere").mkdir()
    run(tmp_path, work)


def test_how_far_a_damaged_bag_is_read_is_told_to_the_page_that_opens_it(tmp_path: Path):
    async def story() -> None:
        bag = write_arm_bag(tmp_path / "run")
        [file] = bag.glob("*.mcap")
        file.write_bytes(file.read_bytes()[: file.stat().st_size * 9 // 10])
        async with engine(tmp_path / "data") as made:
            ear = Ear()
            made.attach(ear)
            name = await made.open_path(bag, {})
            told = [one for one in ear.events if one["type"] == "bag_opening"]
            assert {one["name"] for one in told} == {"run"}
            shares = [one["done"] for one in told]
            assert len(shares) > 1
            assert (shares[-1], shares[:-1]) == (None, sorted(shares[:-1]))
            assert made.document(name).time.shown is not None

    asyncio.run(story())
