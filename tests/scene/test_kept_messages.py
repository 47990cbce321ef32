# viser's own buffer of messages is what ours is held against.
# pyright: reportPrivateUsage=false
from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from viser import _messages
from viser.infra._async_message_buffer import AsyncMessageBuffer

from studio.scene.kept_messages import KeptMessages
from studio.scene.node import PointCloudProps
from studio.scene.opened_frames import closed, opened
from studio.scene.wire import Encoder, Packer
from tests.support.page_state import PageState, content_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from studio.scene.opened_frames import Message

NAMES = ("/a", "/a/b", "/a/b/c", "/d")
NUMBERS = ("axes_length", "axes_radius", "origin_radius")
UPRIGHT = (1.0, 0.0, 0.0, 0.0)


class Origin:
    """A few nodes in viser's buffer; made, changed and removed as the studio does it."""

    def __init__(self, *, keeps_creates_fresh: bool) -> None:
        loop = asyncio.new_event_loop()
        loop.close()  # nobody waits for a message
        self.buffer = AsyncMessageBuffer(loop, persistent_messages=True)
        self._props: dict[str, Any] = {}
        self._is_fresh = keeps_creates_fresh
        self._encoder = Encoder()

    def frame_since(self, number: int) -> bytes:
        return self._encoder.frame(m for n, m in self.buffer.message_from_id.items() if n > number)

    @property
    def newest(self) -> int:
        return self.buffer.message_counter - 1

    def make(self, name: str, kind: int, value: int) -> None:
        parent = name.rpartition("/")[0]
        if parent and parent not in self._props:
            return
        self.buffer.remove_entity_state_from_buffer("scene", name)
        if kind % 2:
            points = np.full((2, 3), value, np.float32)
            props: Any = PointCloudProps(
                points, points.astype(np.uint8), 0.1, "square", "float32", 1.0, "flat"
            )
            made: _messages.Message = _messages.PointCloudMessage(name, props)
        else:
            props = _messages.FrameProps(True, value, 0.0, 0.0, (0, 0, 0), 1.0)
            made = _messages.FrameMessage(name, props)
        self._props[name] = props
        self._push(made)
        self.move(name, value)
        self._push(_messages.SetOrientationMessage(name, UPRIGHT))
        self._push(_messages.SetSceneNodeVisibilityMessage(name, bool(value)))

    def update(self, name: str, which: int, value: int) -> None:
        props = self._props.get(name)
        if props is None:
            return
        values: dict[str, Any]
        if isinstance(props, _messages.FrameProps):
            chosen = [NUMBERS[at] for at in range(3) if which >> at & 1]
            values = dict.fromkeys(chosen, float(value))
        else:
            values = {"point_size": float(value)}
            if which % 2:
                values["points"] = np.full((value + 1, 3), value, np.float32)
        self._push(_messages.SceneNodeUpdateMessage(name, values))
        if self._is_fresh:
            vars(props).update(values)

    def move(self, name: str, value: int) -> None:
        if name in self._props:
            self._push(_messages.SetPositionMessage(name, (float(value), 0.0, 0.0)))

    def widen(self, value: int) -> None:
        self._push(_messages.GuiSetPanelWidthMessage("panel", float(value), value, "run"))

    def remove(self, name: str) -> None:
        for below in [other for other in reversed(NAMES) if f"{other}/".startswith(f"{name}/")]:
            if self._props.pop(below, None) is not None:
                self._push(_messages.RemoveSceneNodeMessage(below))

    def _push(self, message: _messages.Message) -> None:
        self.buffer.push(message)


class Page:
    def __init__(self) -> None:
        self.cursor, self.state = -1, PageState()

    def catch_up(self, kept: KeptMessages) -> None:
        frame = framed(kept.since(self.cursor))
        self.state.apply(content_of(frame))
        self.cursor = kept.newest


def framed(messages: Iterable[Message]) -> bytes:
    return closed(messages, 1.0, Packer())


SMALL = st.integers(0, 2)
DRAWS = st.one_of(
    st.tuples(st.just("make"), st.sampled_from(NAMES), SMALL, SMALL),
    st.tuples(st.just("update"), st.sampled_from(NAMES), st.integers(1, 7), SMALL),
    st.tuples(st.just("move"), st.sampled_from(NAMES), SMALL),
    st.tuples(st.just("remove"), st.sampled_from(NAMES)),
    st.tuples(st.just("widen"), SMALL),
)
EVENTS = st.one_of(
    DRAWS,
    st.sampled_from([("window",), ("cut",), ("page",), ("sweep",)]),
    st.tuples(st.just("read"), SMALL),
)


class Story:
    """An origin, what a relay of it keeps, and pages; the first of them is always in step."""

    def __init__(self, *, keeps_creates_fresh: bool) -> None:
        self.origin = Origin(keeps_creates_fresh=keeps_creates_fresh)
        self.kept = KeptMessages()
        self.pages: list[Page] = [Page(), Page()]
        self._sent = -1

    def tell_all(self, events: Iterable[tuple[Any, ...]]) -> None:
        for kind, *arguments in events:
            self._tell(kind, arguments)

    def check(self) -> None:
        """Every page, and one that comes now, has what a page of the origin has."""
        wanted = PageState()
        wanted.apply(content_of(self.origin.frame_since(-1)))
        for page in (*self.pages, Page()):
            page.catch_up(self.kept)
            assert page.state.nodes == wanted.nodes
            assert page.state.said == wanted.said

    def _tell(self, kind: str, arguments: Sequence[Any]) -> None:
        match kind:
            case "window":
                self.take_all()
            case "cut":
                self.cut()
            case "page":
                self.pages.append(Page())
            case "read":
                number: int = arguments[0]
                self.pages[number % len(self.pages)].catch_up(self.kept)
            case "sweep":
                self.kept.forget_removals(min(page.cursor for page in self.pages))
            case _:
                getattr(self.origin, kind)(*arguments)

    def take_all(self) -> None:
        for message in opened(self.origin.frame_since(self._sent)).messages:
            self.kept.add(message)
        self._in_step()

    def cut(self, origin: Origin | None = None) -> list[str]:
        """Cut the line, perhaps for that of another origin; return the kinds of what is sent."""
        before, was_in_step = self.kept.newest, self._sent == self.origin.newest
        if origin is not None:
            self.origin, was_in_step = origin, False
        self.kept.renew(opened(self.origin.frame_since(-1)).messages)
        if was_in_step:
            assert self.kept.since(before) == []
        sent = [message.kind.removesuffix("Message") for message in self.kept.since(before)]
        self._in_step()
        return sent

    def _in_step(self) -> None:
        self._sent = self.origin.newest
        self.pages[0].catch_up(self.kept)


@settings(max_examples=500, deadline=None)
@given(st.lists(EVENTS, max_size=60), st.booleans())
def test_a_page_has_the_state_of_the_origin_wherever_it_fell_behind_and_whatever_the_line_lost(
    events: Sequence[tuple[Any, ...]], fresh: bool
):
    story = Story(keeps_creates_fresh=fresh)
    story.tell_all(events)
    story.take_all()
    story.check()


SOME_DRAWS = st.lists(DRAWS, min_size=1, max_size=8)


@settings(max_examples=1000, deadline=None)
@given(st.tuples(SOME_DRAWS, SOME_DRAWS, SOME_DRAWS), st.booleans())
def test_after_a_cut_of_the_line_all_pages_have_the_state_of_the_origin(
    events: Sequence[Sequence[tuple[Any, ...]]], fresh: bool
):
    story = Story(keeps_creates_fresh=fresh)
    for name in NAMES:
        story.origin.make(name, 0, 0)
    before, meanwhile, lost = events
    story.tell_all(before)
    story.take_all()
    story.pages[1].catch_up(story.kept)
    story.tell_all(meanwhile)
    story.take_all()
    story.tell_all(lost)
    story.cut()
    story.check()
    story.cut()
    story.tell_all(before)
    story.take_all()
    story.check()


def two_origins_with_a_frame() -> tuple[Story, Origin]:
    """A story whose pages have the frame, and another origin that has the same."""
    story, other = Story(keeps_creates_fresh=True), Origin(keeps_creates_fresh=True)
    for origin in (story.origin, other):
        origin.make("/d", 0, 0)
    story.take_all()
    story.pages[1].catch_up(story.kept)
    return story, other


def test_of_two_updates_that_set_the_same_the_later_one_is_sent_again_with_the_earlier_one():
    story, other = two_origins_with_a_frame()
    for origin, value in ((story.origin, 0), (other, 2)):
        origin.update("/d", 0b11, value)
        origin.update("/d", 0b01, 1)
    story.take_all()
    assert story.cut(other) == ["SceneNodeUpdate", "SceneNodeUpdate"]
    story.check()


def test_updates_that_came_in_another_order_are_sent_as_far_as_they_differ():
    story, other = two_origins_with_a_frame()
    for origin, masks in ((story.origin, (0b01, 0b11)), (other, (0b11, 0b01))):
        for mask in masks:
            origin.update("/d", mask, mask)
    story.take_all()
    assert story.cut(other) == ["SceneNodeUpdate"]
    story.check()


def test_a_page_that_fell_behind_is_told_of_an_update_that_the_new_state_has_in_its_node():
    story, other = Story(keeps_creates_fresh=True), Origin(keeps_creates_fresh=True)
    story.origin.make("/d", 0, 0)
    story.take_all()
    story.pages[1].catch_up(story.kept)
    story.origin.update("/d", 0b01, 2)
    story.take_all()
    other.make("/d", 0, 2)
    other.move("/d", 0)
    other.buffer.push(_messages.SetSceneNodeVisibilityMessage("/d", False))
    assert story.cut(other) == []
    story.check()


def test_a_node_of_which_something_is_not_said_any_more_is_made_anew():
    story, other = two_origins_with_a_frame()
    story.origin.buffer.push(_messages.SetSceneNodeClickBindingsMessage("/d", ()))
    story.take_all()
    sent = story.cut(other)
    assert sent == ["Frame", "SetPosition", "SetOrientation", "SetSceneNodeVisibility"]


def test_a_node_is_made_anew_with_all_that_is_said_of_it():
    story, other = two_origins_with_a_frame()
    other.make("/d", 1, 0)
    sent = story.cut(other)
    assert sent == ["PointCloud", "SetPosition", "SetOrientation", "SetSceneNodeVisibility"]
    story.check()


def test_a_node_that_stays_below_one_that_is_gone_is_made_anew():
    story, other = two_origins_with_a_frame()
    for origin in (story.origin, other):
        origin.make("/a", 0, 0)
        origin.make("/a/b", 0, 0)
    story.take_all()
    other.buffer.remove_from_buffer(lambda message: getattr(message, "name", "") == "/a")
    sent = story.cut(other)
    assert sent[:2] == ["RemoveSceneNode", "Frame"]
    story.check()


def test_what_is_said_of_a_removed_node_is_not_told_to_those_who_come():
    story = Story(keeps_creates_fresh=True)
    story.origin.make("/d", 0, 0)
    story.origin.remove("/d")
    story.origin.buffer.push(_messages.SetPositionMessage("/d", (1.0, 0.0, 0.0)))
    story.take_all()
    assert story.kept.since(-1) == []
    story.kept.forget_removals(story.kept.newest)
    assert len(story.kept) == 0


def test_a_node_that_is_made_anew_loses_what_was_said_of_the_earlier_one():
    story = Story(keeps_creates_fresh=True)
    story.origin.make("/d", 0, 0)
    story.origin.update("/d", 1, 2)
    story.take_all()
    story.origin.make("/d", 0, 1)
    story.take_all()
    kinds = [message.kind for message in story.kept.since(-1)]
    assert "SceneNodeUpdateMessage" not in kinds
