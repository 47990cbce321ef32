import math

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from studio.displays.display import Limits, Status
from studio.displays.drawing import Points
from studio.displays.point_cloud2 import PointCloud2Display
from tests.support.clouds import CLOUD, FLOATS, RGB, Layout, cloud
from tests.support.display_messages import NOW_NS, STAMP_NS, TYPES

NAN = math.nan


def drawn(display: PointCloud2Display) -> Points:
    (placed,) = display.draw(NOW_NS).values()
    shape = placed.shapes["points"]
    assert isinstance(shape, Points)
    return shape


@pytest.mark.parametrize("little", [True, False])
@pytest.mark.parametrize("big", [True, False])
def test_a_cloud_is_drawn_in_its_frame_at_its_stamp(little: bool, big: bool):
    layout = Layout((("y", 0, 8), ("x", 9, 7), ("z", 13, 7), ("rgb", 17, 6)), 24, 3, big=big)
    rows = [[(2.0, 1.0, 3.0, 0xFF8000), (5.0, 4.0, 6.0, 0x000102)], [(8.0, 7.0, 9.0, 0)] * 2]
    display = PointCloud2Display(TYPES)
    display.take(cloud(layout, rows, little=little))
    (path, placed), *others = display.draw(NOW_NS).items()
    assert not others
    assert (path, placed.frame, placed.stamp_ns, placed.follows) == ("0", "map", STAMP_NS, False)
    shape = drawn(display)
    assert shape.positions.dtype == np.float32
    assert_array_equal(shape.positions, [[1, 2, 3], [4, 5, 6], [7, 8, 9], [7, 8, 9]])
    assert_array_equal(shape.colors, [[255, 128, 0], [0, 1, 2], [0, 0, 0], [0, 0, 0]])
    assert (shape.style, shape.size_m, shape.opacity) == ("flat squares", 0.01, 1.0)
    assert shape.precise
    assert display.statuses() == ()


def test_points_without_a_place_are_left_out_with_their_colours():
    first = [(1, 0, 0, 0.0), (NAN, 0, 0, 1.0), (0, math.inf, 0, 1.0), (0, 0, -math.inf, 1.0)]
    second = [(2, 0, 0, 0.0), (math.inf, -math.inf, 0, 1.0), (3e38, 3e38, 0, 1.0), (3, 0, 0, 0.0)]
    rows = [first, second]
    display = PointCloud2Display(TYPES)
    display.take(cloud(RGB, rows))
    shape = drawn(display)
    assert_array_equal(shape.positions[:, 0], [1, 2, 3])
    assert_array_equal(shape.colors, np.zeros((3, 3)))


def test_a_place_that_no_float_of_four_bytes_holds_is_none():
    layout = Layout((("x", 0, 8), ("y", 8, 8), ("z", 16, 8)), 24)
    display = PointCloud2Display(TYPES)
    display.take(cloud(layout, [[(1e308, 0, 0), (500_000.25, 0, 0)]]))
    assert_array_equal(drawn(display).positions, [[500_000.25, 0, 0]])


@pytest.mark.parametrize(
    ("rows", "status"),
    [
        ([], Status("warn", "no_points", "The cloud has no points.")),
        (
            [[(NAN, 0, 0)] * 4] * 3,
            Status(
                "warn",
                "not_finite",
                "None of the 12 points has a place: all are NaN or infinite.",
            ),
        ),
    ],
)
def test_a_cloud_that_shows_nothing_says_why(rows: list[list[tuple[float, ...]]], status: Status):
    display = PointCloud2Display(TYPES)
    display.take(cloud(FLOATS, rows))
    assert display.draw(NOW_NS) == {}
    assert display.statuses() == (status,)


def test_points_without_a_place_do_not_count_against_the_limit():
    row = [(NAN if number % 2 else float(number), 0.0, 0.0) for number in range(100)]
    display = PointCloud2Display(TYPES)
    display.limit(Limits(points=50))
    display.take(cloud(FLOATS, [row]))
    assert len(drawn(display).positions) == 50
    assert display.statuses() == ()
    display.limit(Limits(points=49))
    display.take(cloud(FLOATS, [row]))
    shown = len(drawn(display).positions)
    assert 25 < shown <= 49
    assert display.statuses()[0].sentence == f"Showing {shown} of 50 points."


def test_the_same_points_of_a_still_cloud_are_shown_each_time_with_their_own_colours():
    row = [(float(n), 0.0, 0.0, float(n)) for n in range(1000)]
    display = PointCloud2Display(TYPES, {"Color Transformer": "AxisColor", "Axis": "X"})
    display.limit(Limits(points=100))
    display.take(cloud(RGB, [row]))
    first = drawn(display)
    display.take(cloud(RGB, [row]))
    assert_array_equal(drawn(display).positions, first.positions)
    by_channel = PointCloud2Display(
        TYPES, {"Color Transformer": "Intensity", "Channel Name": "rgb"}
    )
    by_channel.limit(Limits(points=100))
    by_channel.take(cloud(RGB, [row]))
    assert_array_equal(drawn(by_channel).colors, first.colors)


def test_near_clouds_are_sent_in_half_precision():
    display = PointCloud2Display(TYPES)
    display.take(cloud(FLOATS, [[(1.0, 2.0, 3.0)]]))
    assert not drawn(display).precise


def test_the_type_that_is_drawn_is_the_one_that_is_known():
    (role,) = PointCloud2Display.TOPICS
    assert role.types == (CLOUD,)
