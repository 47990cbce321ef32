import math

import numpy as np
from numpy.testing import assert_array_equal

from studio.displays.display import Limits
from studio.displays.drawing import Points
from studio.displays.point_cloud import PointCloudDisplay
from studio.displays.properties import Value
from tests.support.display_messages import NOW_NS, STAMP_NS, TYPES, point, received
from tests.support.drawn import said

KIND = "sensor_msgs/msg/PointCloud"


def display_of(
    points: list[tuple[float, float, float]],
    values: dict[str, Value] | None = None,
    **channels: list[float],
) -> PointCloudDisplay:
    fields = {
        "points": [point(*one) for one in points],
        "channels": [{"name": name, "values": numbers} for name, numbers in channels.items()],
    }
    display = PointCloudDisplay(TYPES, values)
    display.take(received(KIND, fields))
    return display


def points_of(display: PointCloudDisplay) -> Points:
    (placed,) = display.draw(NOW_NS).values()
    assert (placed.frame, placed.stamp_ns) == ("map", STAMP_NS)
    shape = placed.shapes["points"]
    assert isinstance(shape, Points)
    return shape


def packed(*colours: int) -> list[float]:
    return np.array(colours, np.uint32).view(np.float32).tolist()


def test_packed_colours_are_red_green_and_blue():
    shape = points_of(display_of([(1, 2, 3), (4, 5, 6)], rgb=packed(0xFF8000, 0x000102)))
    assert_array_equal(shape.positions, [[1, 2, 3], [4, 5, 6]])
    assert_array_equal(shape.colors, [[255, 128, 0], [0, 1, 2]])


def test_fractions_are_colours_too():
    shape = points_of(display_of([(0, 0, 0)], r=[1.0], g=[0.5], b=[-3.0]))
    assert_array_equal(shape.colors, [[255, 128, 0]])


def test_intensities_go_from_the_least_to_the_greatest():
    values: dict[str, Value] = {"Use rainbow": False}
    shape = points_of(display_of([(0, 0, 0), (1, 0, 0)], values, intensity=[5.0, 7.0]))
    assert_array_equal(shape.colors, [[0, 0, 0], [255, 255, 255]])


def test_a_point_without_a_place_takes_its_colour_with_it():
    shape = points_of(display_of([(math.nan, 0, 0), (1, 1, 1)], rgb=packed(0xFFFFFF, 0x010203)))
    assert_array_equal(shape.colors, [[1, 2, 3]])


def test_a_channel_of_another_length_than_the_points_is_as_if_it_were_not_there():
    values: dict[str, Value] = {"Color Transformer": "Intensity"}
    display = display_of([(0, 0, 0), (1, 0, 0)], values, intensity=[5.0])
    points_of(display)
    assert said(display) == [("warn", "unknown_field")]


def test_the_limit_holds_and_is_said():
    display = PointCloudDisplay(TYPES)
    display.limit(Limits(points=100))
    fields = {"points": [point(at, 0, 0) for at in range(1000)]}
    display.take(received(KIND, fields))
    assert len(points_of(display).positions) == 100
    assert said(display) == [("ok", "thinned")]


def test_a_cloud_without_points_says_so():
    assert said(display_of([])) == [("warn", "no_points")]
