from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from studio.documents.model import Model
from studio.live.displays.display_list import DisplayList, DisplaySpec, Listening
from studio.live.displays.drawing_room import DrawingRoom
from studio.live.displays.plugins import Plugins
from studio.ros.columns.transforms import TransformCodec
from studio.scene import DocumentScene
from studio.tf.transforms import TransformColumns
from tests.support.display_messages import NOW_NS, encoded, pose, received
from tests.support.memory_source import MemorySource
from tests.support.transforms import S, Told, columns

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

POSE = "geometry_msgs/msg/PoseStamped"
GOAL = bytes(received(POSE, {"pose": pose()}).cdr)


def frame_at(parent: str, child: str, stamp_ns: int) -> bytes:
    told = columns(Told(parent, child, stamp_ns))
    names = told.parents, told.children
    shown = TransformColumns(*names, told.stamps_ns, told.translations, told.rotations_wxyz)
    return bytes(TransformCodec().encode(shown))


class NoMeshes:
    """Loads nothing: nothing here is drawn with a mesh."""

    def want(self) -> None: ...

    def trouble_of(self, uri: str) -> str:
        return uri


class Room:
    """A room with displays of topics of a source, in the fixed frame `map`."""

    def __init__(self, *topics: str) -> None:
        self.source, self.displays = MemorySource(), DisplayList()
        model = Model(DocumentScene(asyncio.get_running_loop()))
        self.room = DrawingRoom(model, NoMeshes(), self.source, Plugins())
        self.room.frames.chosen = "map"
        self.ids: list[str] = []
        for topic in topics:
            self.source.offer(topic, POSE)
            spec = self.displays.add("Pose", topic)
            self.room.open(spec)
            self.ids.append(spec.id)

    async def subscribe(self) -> Room:
        await self.room.subscribe({one.id for one in self.displays if one.enabled})
        return self

    def received(self) -> set[str]:
        """Topics that are subscribed now."""
        return {one.topic for one in self.source.opened}

    def reasons(self) -> list[list[str]]:
        """Of each display, after a step."""
        self.room.step(self.displays, NOW_NS)
        states = self.room.states(self.displays, NOW_NS).states
        return [[remark.reason for remark in one.remarks] for one in states]

    async def enable(self, display: str, *, enabled: bool) -> None:
        old = self.displays.get(display)
        self.displays.change(DisplaySpec(old.id, old.kind, old.name, old.topic, enabled))
        self.reasons()
        await self.subscribe()


def inside_a_loop(story: Callable[[], Coroutine[None, None, None]]) -> None:
    asyncio.run(story())


def test_one_topic_that_cannot_be_heard_does_not_silence_the_others():
    async def story() -> None:
        made = await Room("/no topic", "/goal").subscribe()
        made.source.say("/goal", GOAL)
        assert made.reasons() == [["not_heard"], [""]]

    inside_a_loop(story)


def test_when_time_goes_back_on_tf_what_was_drawn_before_is_gone():
    async def story() -> None:
        made = await Room("/goal").subscribe()
        made.source.say("/tf", frame_at("map", "odom", 100 * S))
        made.source.say("/goal", GOAL)
        assert made.reasons() == [[""]]
        made.source.say("/tf", frame_at("map", "odom", 101 * S))
        assert made.reasons() == [[""]]
        made.source.say("/tf", frame_at("map", "odom", 1 * S))
        assert made.reasons() == [["empty"]]
        made.source.say("/goal", GOAL)
        assert made.reasons() == [[""]]

    inside_a_loop(story)


def test_what_is_switched_on_again_shows_nothing_of_before():
    async def story() -> None:
        made = await Room("/goal").subscribe()
        made.source.say("/goal", GOAL)
        assert made.reasons() == [[""]]
        await made.enable(made.ids[0], enabled=False)
        assert "/goal" not in made.received()
        await made.enable(made.ids[0], enabled=True)
        assert made.reasons() == [["no_message"]]
        assert not made.room.get(made.ids[0]).placing.shown.drawing

    inside_a_loop(story)


def test_a_router_that_is_gone_is_said_of_each_display():
    async def story() -> None:
        made = await Room("/goal", "/aim").subscribe()
        made.source.connect("lost")
        await made.subscribe()
        assert made.reasons() == [["connection_lost"], ["connection_lost"]]

    inside_a_loop(story)


def test_when_clock_goes_back_what_was_drawn_is_gone_and_what_comes_then_is_drawn():
    def clock(sec: int) -> bytes:
        return encoded("rosgraph_msgs/msg/Clock", {"clock": {"sec": sec}})

    async def story() -> None:
        made = await Room("/goal").subscribe()
        made.source.say("/clock", clock(100))
        made.source.say("/goal", GOAL)
        assert made.reasons() == [[""]]
        made.source.say("/clock", clock(1))
        made.reasons()
        placing = made.room.get(made.ids[0]).placing
        assert not placing.shown.drawing
        made.source.say("/goal", GOAL)
        assert made.reasons() == [[""]]
        assert placing.shown.drawing

    inside_a_loop(story)


def test_after_the_end_nothing_is_heard():
    async def story() -> None:
        made = await Room("/goal").subscribe()
        assert made.received() == {"/clock", "/goal", "/tf", "/tf_static"}
        made.room.close_all()
        await made.subscribe()
        assert made.received() == set()

    inside_a_loop(story)


def test_a_display_is_told_as_it_listens_and_as_it_was_asked_to():
    async def story() -> None:
        made = await Room("/goal").subscribe()
        spec = made.displays.get(made.ids[0])
        view = made.room.view(spec)
        assert (view.topic, view.reliable, view.latched, view.depth) == ("/goal", True, False, 5)
        wished = DisplaySpec(spec.id, "Pose", "Goal", "/goal", listening=Listening(latched=True))
        made.room.get(spec.id).spec = wished
        await made.subscribe()
        view = made.room.view(wished)
        assert (view.latched, view.wished.latched, view.wished.depth) == (True, True, None)

    inside_a_loop(story)
