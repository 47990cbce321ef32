from __future__ import annotations

import math

import pytest

from studio.errors import ExtrapolationError
from studio.live.displays.later_frames import LaterFrames
from studio.ros.attachment import Attachment
from studio.ros.columns.transforms import TransformCodec
from studio.ros.node.samples import RawSample
from studio.tf.buffer import TransformBuffer
from tests.support.transforms import S, Told, about_z, columns


def later(*rows: Told) -> list[RawSample]:
    data = bytes(TransformCodec().encode(columns(*rows)))
    return [RawSample(data, Attachment(1, 0, bytes(16)), 0)]


def buffer() -> TransformBuffer:
    """The base drives, its arm turns, and the tip is fixed to it."""
    made = TransformBuffer()
    made.put(columns(Told("map", "base", S, (1.0, 0.0, 0.0))))
    made.put(columns(Told("base", "arm", S, wxyz=about_z(0.0))))
    made.put(columns(Told("arm", "tip", 0, (1.0, 0.0, 0.0))), static=True)
    return made


def test_a_frame_is_between_its_last_transform_and_the_next():
    frames = LaterFrames(buffer())
    samples = later(
        Told("map", "base", 2 * S, (3.0, 0.0, 0.0)),
        Told("base", "arm", 2 * S, wxyz=about_z(math.pi / 2)),
    )
    *_, x, y, _z = frames.pose(samples, "map", "tip", S + S // 2)
    assert (x, y) == pytest.approx((2.0 + math.cos(math.pi / 4), math.sin(math.pi / 4)))
    w, *_, back_x, back_y, _ = frames.pose(samples, "tip", "map", S + S // 2)
    assert abs(w) == pytest.approx(math.cos(math.pi / 8))
    assert math.hypot(back_x, back_y) == pytest.approx(math.hypot(x, y))


def test_what_does_not_come_soon_enough_is_not_invented():
    frames = LaterFrames(buffer())
    with pytest.raises(ExtrapolationError):
        frames.pose(later(Told("map", "base", 2 * S)), "map", "base", 3 * S)
    with pytest.raises(ExtrapolationError):
        frames.pose(later(Told("map", "other", 2 * S)), "map", "base", 2 * S)
    with pytest.raises(ExtrapolationError):
        frames.pose([], "map", "base", S // 2)
