from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.errors import UnknownFrameError
from studio.live.displays.own_frames import OwnFrames
from studio.tf.buffer import TransformBuffer
from studio.tf.forest import FRAMES_MAX
from tests.support.posed import Posed, arm
from tests.support.transforms import Told, columns

if TYPE_CHECKING:
    from studio.tf.transforms import Notice, TransformColumns


class CountingBuffer(TransformBuffer):
    """A buffer that knows of how many transforms it was told."""

    told = 0

    def put(
        self,
        columns: TransformColumns,
        *,
        static: bool = False,
        publisher: str = "",
        received_ns: int | None = None,
    ) -> tuple[Notice, ...]:
        """Count them."""
        self.told += len(columns.children)
        return super().put(columns, static=static, publisher=publisher, received_ns=received_ns)


def x_m(buffer: TransformBuffer, frame: str) -> float:
    return buffer.fixed_from("base", frame).xyz[0]


def test_links_are_where_the_joints_put_them():
    buffer, posed = TransformBuffer(), Posed(arm())
    own = OwnFrames(posed, buffer)
    own.step()
    assert (own.root, set(own.links)) == ("base", {"base", "upper", "tip"})
    assert x_m(buffer, "tip") == 0.5
    posed.become(arm(0.75))
    own.step()
    assert x_m(buffer, "tip") == 0.75


def test_a_link_that_is_no_more_is_no_frame_any_more():
    buffer, posed = TransformBuffer(), Posed(arm())
    own = OwnFrames(posed, buffer)
    own.step()
    posed.become(arm(tip="hand"))
    own.step()
    assert x_m(buffer, "hand") == 0.5
    with pytest.raises(UnknownFrameError):
        buffer.fixed_from("base", "tip")


def test_what_others_tell_of_is_theirs_also_under_the_old_names_with_a_slash():
    buffer = TransformBuffer()
    own = OwnFrames(Posed(arm()), buffer)
    own.step()
    own.leave_to_others(("/tip",))
    buffer.put(columns(Told("upper", "/tip", 1, (2.0, 0.0, 0.0))))
    own.step()
    assert x_m(buffer, "tip") == 2.0
    buffer.clear()
    own.take_back()
    own.step()
    assert x_m(buffer, "tip") == 0.5


def test_frames_that_others_told_before_stay_theirs_when_the_robot_gets_such_links():
    buffer, posed = TransformBuffer(), Posed(arm())
    own = OwnFrames(posed, buffer)
    own.step()
    own.leave_to_others(("hand",))
    buffer.put(columns(Told("upper", "hand", 1, (2.0, 0.0, 0.0))))
    posed.become(arm(tip="hand"))
    own.step()
    assert x_m(buffer, "hand") == 2.0


def test_only_what_moved_is_told():
    buffer, posed = CountingBuffer(), Posed(arm())
    own = OwnFrames(posed, buffer)
    own.step()
    assert buffer.told == 2
    own.step()
    assert buffer.told == 2
    posed.joints.set({"shoulder": 0.5})
    own.step()
    assert buffer.told == 3
    posed.become(arm(0.75))
    own.step()
    assert buffer.told == 5  # the tip, and the shoulder that is at 0 again


def test_of_names_without_end_only_the_robots_own_are_kept_in_mind():
    buffer, posed = TransformBuffer(), Posed(arm())
    own = OwnFrames(posed, buffer)
    own.step()
    own.leave_to_others(tuple(f"far{number}" for number in range(FRAMES_MAX)))
    own.leave_to_others(("hand",))
    posed.become(arm(tip="hand"))
    own.step()
    assert x_m(buffer, "hand") == 0.5
    own.leave_to_others(("hand",))
    own.step()
    with pytest.raises(UnknownFrameError):
        buffer.fixed_from("base", "hand")
