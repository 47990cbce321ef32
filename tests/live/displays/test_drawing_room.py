from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from studio.documents.model import Model
from studio.errors import RosNameError
from studio.live.displays.display_list import DisplayList, DisplaySpec, Listening
from studio.live.displays.drawing_room import DrawingRoom
from studio.ros.columns.transforms import TransformCodec
from studio.scene import DocumentScene
from studio.tf.transforms import TransformColumns
from tests.support.display_messages import NOW_NS, encoded, pose, received
from tests.support.heard_topics import HeardTopics, publisher
from tests.support.transforms import S, Told, columns

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.ros.graph.endpoints import GraphEndpoint

POSE = "geometry_msgs/msg/PoseStamped"
GOAL = bytes(received(POSE, {"pose": pose()}).cdr)


class Graph:
    """Somebody publishes poses on every topic."""

    def publishers(self, topic: str) -> Sequence[GraphEndpoint]:
        if " " in topic:
            raise RosNameError(topic, "it has a space")
        return (publisher(POSE),)

    def topics(self) -> Sequence[tuple[str, Sequence[str]]]:
        return (("/goal", (POSE,)),)

    def endpoint_of_gid(self, gid: bytes) -> GraphEndpoint | None:
        del gid
        return None


class Link(HeardTopics):
    """A connection without a wire."""

    is_connected = True
    graph = Graph()


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
    """A room with displays of topics at a link, in the fixed frame `map`."""

    def __init__(self, *topics: str) -> None:
        self.link, self.displays = Link(), DisplayList()
        model = Model(DocumentScene(asyncio.get_running_loop()))
        self.room = DrawingRoom(model, NoMeshes())
        self.room.frames.chosen = "map"
        self.ids: list[str] = []
        for topic in topics:
            spec = self.displays.add("Pose", topic)
            self.room.open(spec)
            self.ids.append(spec.id)
        self.listen()

    def listen(self) -> None:
        self.room.listen(self.link, [one.id for one in self.displays if one.enabled])

    def reasons(self) -> list[list[str]]:
        """Of each display, after a step."""
        self.room.step(self.displays, NOW_NS)
        states = self.room.states(self.displays, NOW_NS).states
        return [[remark.reason for remark in one.remarks] for one in states]

    def enable(self, display: str, *, enabled: bool) -> None:
        old = self.displays.get(display)
        self.displays.change(DisplaySpec(old.id, old.kind, old.name, old.topic, enabled))
        self.reasons()
        self.listen()


def inside_a_loop(story: Callable[[], None]) -> None:
    async def run() -> None:
        story()

    asyncio.run(run())


def test_one_topic_that_cannot_be_heard_does_not_silence_the_others():
    def story() -> None:
        made = Room("/no topic", "/goal")
        made.link.say("/goal", GOAL)
        assert made.reasons() == [["not_heard"], [""]]

    inside_a_loop(story)


def test_when_time_goes_back_on_tf_what_was_drawn_before_is_gone():
    def story() -> None:
        made = Room("/goal")
        made.link.say("/tf", frame_at("map", "odom", 100 * S))
        made.link.say("/goal", GOAL)
        assert made.reasons() == [[""]]
        made.link.say("/tf", frame_at("map", "odom", 101 * S))
        assert made.reasons() == [[""]]
        made.link.say("/tf", frame_at("map", "odom", 1 * S))
        assert made.reasons() == [["empty"]]
        made.link.say("/goal", GOAL)
        assert made.reasons() == [[""]]

    inside_a_loop(story)


def test_what_is_switched_on_again_shows_nothing_of_before():
    def story() -> None:
        made = Room("/goal")
        made.link.say("/goal", GOAL)
        assert made.reasons() == [[""]]
        made.enable(made.ids[0], enabled=False)
        assert "/goal" not in made.link.takers
        made.enable(made.ids[0], enabled=True)
        assert made.reasons() == [["no_message"]]
        assert not made.room.get(made.ids[0]).placing.shown.drawing

    inside_a_loop(story)


def test_a_router_that_is_gone_is_said_of_each_display():
    def story() -> None:
        made = Room("/goal", "/aim")
        made.link.is_connected = False
        made.listen()
        assert made.reasons() == [["connection_lost"], ["connection_lost"]]

    inside_a_loop(story)


def test_when_clock_goes_back_what_was_drawn_is_gone_and_what_comes_then_is_drawn():
    def clock(sec: int) -> bytes:
        return encoded("rosgraph_msgs/msg/Clock", {"clock": {"sec": sec}})

    def story() -> None:
        made = Room("/goal")
        made.link.say("/clock", clock(100))
        made.link.say("/goal", GOAL)
        assert made.reasons() == [[""]]
        made.link.say("/clock", clock(1))
        made.reasons()
        placing = made.room.get(made.ids[0]).placing
        assert not placing.shown.drawing
        made.link.say("/goal", GOAL)
        assert made.reasons() == [[""]]
        assert placing.shown.drawing

    inside_a_loop(story)


def test_after_the_end_nothing_is_heard():
    def story() -> None:
        made = Room("/goal")
        assert set(made.link.takers) == {"/clock", "/goal", "/tf", "/tf_static"}
        made.room.close_all()
        made.listen()
        assert made.link.takers == {}

    inside_a_loop(story)


def test_a_display_is_told_as_it_listens_and_as_it_was_asked_to():
    def story() -> None:
        made = Room("/goal")
        spec = made.displays.get(made.ids[0])
        view = made.room.view(spec)
        assert (view.topic, view.reliable, view.latched, view.depth) == ("/goal", True, False, 5)
        wished = DisplaySpec(spec.id, "Pose", "Goal", "/goal", listening=Listening(latched=True))
        made.room.get(spec.id).spec = wished
        made.listen()
        view = made.room.view(wished)
        assert (view.latched, view.wished.latched, view.wished.depth) == (True, True, None)

    inside_a_loop(story)
