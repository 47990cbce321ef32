from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.displays.drawing import Solids
from studio.displays.point import PointStampedDisplay
from studio.displays.pose import PoseDisplay
from studio.errors import CdrError, DisplayMessageError
from studio.ros.types.library import TypeLibrary
from tests.support.display_messages import STAMP_NS, TYPES, point, pose, received
from tests.support.drawn import said

if TYPE_CHECKING:
    from studio.displays.display import Received

TYPE = "geometry_msgs/msg/PointStamped"


def points(count: int, keep: int) -> PointStampedDisplay:
    display = PointStampedDisplay(TYPES, {"History Length": keep})
    for number in range(count):
        display.take(at(number))
    return display


def at(x: float, frame: str = "map") -> Received:
    fields = {"header": {"frame_id": frame, "stamp": {"sec": 12, "nanosec": 500}}}
    return received(TYPE, {**fields, "point": point(x, 0.0, 0.0)})


def places(display: PointStampedDisplay) -> set[float]:
    shapes = [shape for placed in display.draw(0).values() for shape in placed.shapes.values()]
    return {float(shape.positions[0, 0]) for shape in shapes if isinstance(shape, Solids)}


def test_the_last_messages_are_kept_and_no_more():
    assert places(points(10, keep=3)) == {7.0, 8.0, 9.0}


def test_each_is_in_its_own_frame_at_its_own_stamp():
    display = points(1, keep=2)
    display.take(at(1.0, "odom"))
    placed = display.draw(0).values()
    assert [(one.frame, one.stamp_ns) for one in placed] == [("map", STAMP_NS), ("odom", STAMP_NS)]


def test_what_is_kept_is_the_same_object_when_another_message_comes():
    display = points(2, keep=3)
    before = display.draw(0)
    display.take(at(2.0))
    after = display.draw(1)
    assert display.draw(2) is after
    assert all(after[path] is placed for path, placed in before.items())


def test_a_message_takes_the_path_of_the_one_that_it_pushes_out():
    display = points(3, keep=3)
    paths = set(display.draw(0))
    for number in range(3, 20):
        display.take(at(number))
        assert set(display.draw(0)) == paths


def test_a_shorter_history_drops_the_oldest_at_once_and_a_longer_one_brings_none_back():
    display = points(6, keep=5)
    display.set("History Length", 2)
    assert places(display) == {4.0, 5.0}
    display.set("History Length", 4)
    assert places(display) == {4.0, 5.0}
    display.take(at(6.0))
    display.take(at(7.0))
    display.take(at(8.0))
    assert places(display) == {5.0, 6.0, 7.0, 8.0}


def test_a_history_has_an_end_whatever_is_asked():
    display = points(1, keep=10**9)
    assert display.values["History Length"] == 2_000


def test_another_property_draws_all_anew():
    display = points(2, keep=2)
    before = display.draw(0)
    display.set("Color", "#00ff00")
    assert all(display.draw(0)[path] is not placed for path, placed in before.items())


def test_a_reset_forgets_all():
    display = points(3, keep=3)
    display.reset()
    assert not display.draw(0)
    display.take(at(5.0))
    assert places(display) == {5.0}


def test_bytes_that_are_no_message_change_nothing():
    display = points(1, keep=1)
    before = display.draw(0)
    with pytest.raises(CdrError):
        display.take(replace_bytes(at(1.0), b"\0\1\0\0\xff"))
    assert display.draw(0) is before


def test_a_message_that_cannot_be_drawn_leaves_what_was_drawn_and_says_so_until_the_next():
    display = points(1, keep=1)
    before = display.draw(0)
    display.take(at(float("nan")))
    assert display.draw(0) is before
    assert said(display) == [("error", "not_finite")]
    with pytest.raises(CdrError):
        display.take(replace_bytes(at(1.0), b""))
    assert said(display) == [("error", "not_finite")]
    display.take(at(2.0))
    assert said(display) == []


def test_an_alpha_of_zero_is_told_with_what_mends_it_as_long_as_it_counts():
    display = PoseDisplay(TYPES, {"Alpha": 0})
    (status,) = display.statuses()
    assert (status.reason, status.mend) == ("transparent", ("Alpha", 1.0))
    display.set("Shape", "Axes")
    assert display.statuses() == ()


def test_a_type_that_somebody_wrote_with_other_fields_is_told_and_leaves_what_was_drawn():
    own = TypeLibrary("jazzy")
    display = PoseDisplay(own)
    good = received("geometry_msgs/msg/PoseStamped", {"pose": pose()})
    display.take(good)
    before = display.draw(0)
    own.add_texts({"geometry_msgs/msg/PoseStamped": "std_msgs/Header header\nfloat64[7] numbers\n"})
    other = PoseDisplay(own)
    with pytest.raises(DisplayMessageError, match="other fields"):
        other.take(good)
    assert not other.draw(0)
    assert display.draw(0) is before


def replace_bytes(message: Received, raw: bytes) -> Received:
    return message._replace(cdr=raw)
