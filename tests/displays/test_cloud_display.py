from typing import Any

import pytest
from numpy.testing import assert_array_equal

from studio.displays.cloud_display import CloudDisplay
from studio.displays.display import Limits, Status
from studio.displays.drawing import Drawing, Points
from studio.displays.point_cloud2 import PointCloud2Display
from studio.errors import CdrError, DisplayMessageError
from tests.support.clouds import FLOATS, cloud
from tests.support.display_messages import NOW_NS, TYPES, received

SECOND = 1_000_000_000


def display_with(**values: Any) -> CloudDisplay:  # noqa: ANN401
    return PointCloud2Display(TYPES, {key.replace("_", " "): one for key, one in values.items()})


def take(display: CloudDisplay, x: float, after_s: float, count: int = 1) -> None:
    """A cloud of points at x that comes so many seconds later."""
    message = cloud(FLOATS, [[(x, 0.0, 0.0)] * count])
    display.take(message._replace(received_ns=NOW_NS + round(after_s * SECOND)))


def points(drawing: Drawing) -> dict[str, Points]:
    found = {path: placed.shapes["points"] for path, placed in drawing.items()}
    assert all(isinstance(one, Points) for one in found.values())
    return {path: one for path, one in found.items() if isinstance(one, Points)}


def shown(display: CloudDisplay, after_s: float) -> dict[str, float]:
    """Where the points of each cloud are."""
    drawing = display.draw(NOW_NS + round(after_s * SECOND))
    return {path: float(one.positions[0, 0]) for path, one in points(drawing).items()}


def test_the_newest_cloud_alone_is_seen_on_one_path_however_old_it_becomes():
    display = display_with()
    assert display.draw(NOW_NS) == {}
    assert display.statuses() == ()
    take(display, 1.0, 0.0)
    take(display, 2.0, 0.1)
    assert shown(display, 3600.0) == {"0": 2.0}


def test_clouds_are_seen_until_they_decayed_and_their_paths_are_taken_again():
    display = display_with(Decay_Time=1.0)
    for number in range(3):
        take(display, float(number), number * 0.4)
    assert shown(display, 0.8) == {"0": 0.0, "1": 1.0, "2": 2.0}
    assert shown(display, 1.2) == {"1": 1.0, "2": 2.0}
    take(display, 3.0, 1.3)
    assert shown(display, 1.3) == {"0": 3.0, "1": 1.0, "2": 2.0}
    assert shown(display, 9.0) == {}


def test_a_drawing_and_its_shapes_stay_the_same_objects_until_something_changes():
    display = display_with(Decay_Time=10.0)
    take(display, 1.0, 0.0)
    first = display.draw(NOW_NS)
    assert display.draw(NOW_NS + 1) is first
    take(display, 2.0, 1.0)
    second = display.draw(NOW_NS + SECOND)
    assert second["0"] is first["0"]
    display.set("Alpha", 0.5)
    third = points(display.draw(NOW_NS + SECOND))
    assert third["0"] is not points(first)["0"]
    assert third["0"].positions is points(first)["0"].positions
    assert third["0"].colors is points(first)["0"].colors
    assert third["0"].opacity == 0.5


def test_precision_that_was_needed_once_is_kept_until_points_are_larger():
    display = display_with()
    precise: list[bool] = []
    for x in (7.0, 9.0, 7.0):
        take(display, x, 0.0)
        precise.append(points(display.draw(NOW_NS))["0"].precise)
    display.set("Size (m)", 0.02)
    precise.append(points(display.draw(NOW_NS))["0"].precise)
    assert precise == [False, True, True, False]


def test_without_a_decay_time_the_newest_of_all_stays():
    display = display_with(Decay_Time=10.0)
    for number in range(3):
        take(display, float(number), 0.0)
    display.set("Decay Time", 0.0)
    assert shown(display, 0.0) == {"2": 2.0}
    take(display, 3.0, 0.0)
    assert shown(display, 0.0) == {"0": 3.0}


@pytest.mark.parametrize(
    "limits", [Limits(points=25), Limits(messages=2), Limits(kept_bytes=12 * 25)]
)
def test_the_oldest_clouds_are_left_out_when_there_would_be_too_much(limits: Limits):
    display = display_with(Decay_Time=10.0)
    display.limit(limits)
    for number in range(4):
        take(display, float(number), 0.0, count=10)
    assert set(shown(display, 0.0).values()) == {2.0, 3.0}
    (status,) = display.statuses()
    assert (status.level, status.reason) == ("ok", "thinned")
    assert status.sentence.startswith("Showing the newest 2 messages: ")


def test_one_cloud_of_too_many_points_is_thinned_and_that_is_told():
    display = display_with()
    display.limit(Limits(points=20))
    take(display, 1.0, 0.0, count=1000)
    assert len(points(display.draw(NOW_NS))["0"].positions) == 20
    mend = ("Points at most", 1000)
    assert display.statuses() == (Status("ok", "thinned", "Showing 20 of 1,000 points.", mend),)
    display.set(*mend)
    assert len(points(display.draw(NOW_NS))["0"].positions) == 1000
    assert display.statuses() == ()


def test_fewer_points_at_most_thin_what_came_before_and_leave_out_the_oldest():
    display = display_with(Decay_Time=10.0)
    for number in range(3):
        take(display, float(number), 0.0, count=2000)
    display.set("Points at most", 1000)
    drawn = points(display.draw(NOW_NS))
    assert {path: len(one.positions) for path, one in drawn.items()} == {"2": 1000}
    display.set("Points at most", 4000)
    assert len(points(display.draw(NOW_NS))["2"].positions) == 2000


def test_a_cloud_that_cannot_be_read_leaves_what_was_drawn():
    display = display_with()
    take(display, 1.0, 0.0)
    before = display.draw(NOW_NS)
    good = cloud(FLOATS, [[(2.0, 0.0, 0.0)]])
    with pytest.raises(CdrError):
        display.take(good._replace(cdr=good.cdr[:40]))
    with pytest.raises(DisplayMessageError):
        display.take(cloud(FLOATS, [[(2.0, 0.0, 0.0)]], width=7))
    with pytest.raises(DisplayMessageError, match="other fields than ROS gives it"):
        display.take(received("sensor_msgs/msg/Range", {}))
    assert display.draw(NOW_NS) is before


def test_nothing_is_seen_after_a_reset():
    display = display_with(Decay_Time=10.0)
    display.limit(Limits(messages=1))
    take(display, 1.0, 0.0)
    take(display, 2.0, 0.0)
    display.reset()
    assert display.draw(NOW_NS) == {}
    assert display.statuses() == ()


def test_alpha_0_is_told_with_what_mends_it():
    display = display_with(Alpha=0.0)
    take(display, 1.0, 0.0)
    sentence = "Alpha is 0: nothing is seen."
    assert display.statuses() == (Status("warn", "transparent", sentence, ("Alpha", 1.0)),)
    display.set("Alpha", 1.0)
    assert display.statuses() == ()
    assert_array_equal(points(display.draw(NOW_NS))["0"].positions, [[1, 0, 0]])
