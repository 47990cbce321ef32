# viser's own keys are what ours are held against.
# pyright: reportPrivateUsage=false, reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
from __future__ import annotations

import dataclasses
from contextlib import suppress
from typing import Any, cast

import msgspec
import numpy as np
import pytest
import zstandard
from hypothesis import given, settings
from hypothesis import strategies as st
from viser import _messages

from studio.errors import SceneError
from studio.scene.kept_messages import KeptMessages
from studio.scene.node import PointCloudProps
from studio.scene.opened_frames import HeldFrames, closed, opened, removal_of
from studio.scene.wire import Encoder, Packer
from tests.support.page_state import content_of

CLASSES: dict[str, type[Any]] = _messages.Message._subclass_from_type_string()
NEVER_THE_SAME = ("RunJavascriptMessage", "GetRenderRequestMessage")
"""Their keys are made anew each time."""


def an_instance(message_class: type[_messages.Message]) -> _messages.Message:
    """A message of that class with something in each field."""
    fields = dataclasses.fields(cast("Any", message_class))
    values: dict[str, Any] = {field.name: f"its {field.name}" for field in fields if field.init}
    if "updates" in values:
        values["updates"] = {"b": 1, "a": [2]}
    return message_class(**values)


def packed(*messages: dict[str, Any]) -> bytes:
    return Packer().frame(msgspec.Raw(msgspec.msgpack.encode(messages)), 1.0, [])


def cloud(count: int) -> _messages.PointCloudMessage:
    points = np.random.default_rng(0).random((count, 3), np.float32)
    rgb = np.zeros(3, np.uint8)
    props = PointCloudProps(points, rgb, 0.1, "square", "float32", 1.0, "flat")
    return _messages.PointCloudMessage("/a", props)


@pytest.mark.parametrize("name", sorted(set(CLASSES) - {"ReplayDoneMessage"}))
def test_a_message_replaces_what_viser_says_that_it_replaces(name: str):
    message: Any = an_instance(CLASSES[name])
    fields = {
        "type": name,
        **{f.name: getattr(message, f.name) for f in dataclasses.fields(message)},
    }
    for _ in range(2):
        (read,) = opened(packed(fields)).messages
        assert read.slot.phase == message.lifecycle_phase
        if name not in NEVER_THE_SAME:
            assert read.slot.key == message.redundancy_key()
        if message.lifecycle_phase in (None, "update_dict", "update_simple"):
            assert read.slot.entity == message.entity_state_key()


def test_a_frame_that_is_closed_again_says_the_same_and_has_each_array_once():
    made = cloud(5000)
    points = _messages.SceneNodeUpdateMessage("/a", {"points": vars(made.props)["points"]})
    frame = Encoder().frame([made, points, _messages.SetPositionMessage("/a", (1.0, 2.0, 3.0))])
    read = opened(frame)
    again = closed(read.messages, read.stamp_s, Packer(), ends_replay=True)
    assert content_of(again) == [*content_of(frame), {"type": "ReplayDoneMessage"}]
    assert len(again) < len(frame) + 100
    reread = opened(again)
    assert reread.ends_replay
    assert not read.ends_replay
    assert all(a.says_the_same(b) for a, b in zip(read.messages, reread.messages, strict=True))


def test_what_removes_a_node_is_what_viser_sends_to_remove_it():
    (made,) = opened(Encoder().frame([cloud(1)])).messages
    (sent,) = opened(Encoder().frame([_messages.RemoveSceneNodeMessage("/a")])).messages
    removal = removal_of(made)
    assert removal.slot == sent.slot
    assert removal.fields() == sent.fields()


def test_a_frame_of_which_little_is_kept_is_let_go():
    frame = Encoder().frame([cloud(100_000)])
    (made,) = (read := opened(frame)).messages
    points = made.fields()["props"]["points"]
    assert points.view.obj is frame
    held = HeldFrames()
    held.hold(len(frame), read.arrays)
    assert points.view.obj is frame
    held.hold(len(frame) * 3, read.arrays)
    assert points.view.obj is not frame
    assert content_of(closed([made], 1.0, Packer())) == content_of(frame)


@settings(max_examples=500, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 500), st.integers(0, 255)), min_size=1, max_size=5))
def test_damaged_messages_are_read_or_refused_and_nothing_else(changes: list[tuple[int, int]]):
    frame = Encoder().frame([cloud(2), _messages.SceneNodeUpdateMessage("/a", {"scale": 2.0})])
    packed_size = int.from_bytes(frame[8:16], "little")
    inner = bytearray(zstandard.decompress(frame[16 : 16 + packed_size]))
    arrays = frame[-27:]  # two points, and a colour
    assert len(opened(_repacked(bytes(inner), arrays)).messages) == 2
    for at, value in changes:
        inner[at % len(inner)] = value
    kept = KeptMessages()
    with suppress(SceneError):
        for message in opened(_repacked(bytes(inner), arrays)).messages:
            kept.add(message)
    closed(kept.since(-1), 1.0, Packer())


def _repacked(inner: bytes, arrays: bytes) -> bytes:
    packed_again = zstandard.compress(inner)
    head = len(inner).to_bytes(8, "little") + len(packed_again).to_bytes(8, "little")
    return head + packed_again + bytes(-len(packed_again) % 8) + arrays


@pytest.mark.parametrize(
    "message",
    [
        {},
        {"type": 1},
        {"type": "Nothing"},
        {"type": "FrameMessage", "name": 1},
        {"type": "FrameMessage"},
        {"type": "SceneNodeUpdateMessage", "name": "/a", "updates": 1},
        {"type": "SceneNodeUpdateMessage", "name": "/a"},
        {"type": "SetBonePositionMessage", "name": "/a"},
        {
            "type": "FrameMessage",
            "name": "/a",
            "props": {"x": {"__binary_index": 0, "dtype": "<f4"}},
        },
        {"type": "FrameMessage", "name": "/a", "props": {"x": {"__binary_index": "a", "dtype": 1}}},
    ],
    ids=repr,
)
def test_a_message_that_is_none_of_visers_spoils_its_frame(message: dict[str, Any]):
    with pytest.raises(SceneError, match="not one of viser's"):
        opened(packed({"type": "SetGuiPanelLabelMessage", "label": None}, message))
