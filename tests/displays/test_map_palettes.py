import numpy as np
import pytest
from numpy.testing import assert_array_equal

from studio.displays.map import SCHEMES, palette

UNKNOWN = 255
GREEN, OCCUPIED = [0, 255, 0, 255], [0, 0, 0, 255]


@pytest.mark.parametrize(
    ("scheme", "value", "rgba"),
    [
        ("map", 0, [255, 255, 255, 255]),
        ("map", 1, [253, 253, 253, 255]),
        ("map", 50, [128, 128, 128, 255]),
        ("map", 100, OCCUPIED),
        ("costmap", 0, [0, 0, 0, 0]),
        ("costmap", 1, [2, 0, 253, 255]),
        ("costmap", 98, [249, 0, 6, 255]),
        ("costmap", 99, [0, 255, 255, 255]),
        ("costmap", 100, [255, 0, 255, 255]),
        ("raw", 0, OCCUPIED),
        ("raw", 100, [100, 100, 100, 255]),
        ("raw", UNKNOWN, [255, 255, 255, 255]),
    ],
)
def test_values_have_rvizs_colours(scheme: str, value: int, rgba: list[int]):
    assert_array_equal(palette(scheme)[value], rgba)


@pytest.mark.parametrize("scheme", ["map", "costmap"])
@pytest.mark.parametrize("threshold", [None, 0, 65, 100])
def test_values_that_no_map_has_stand_out(scheme: str, threshold: int | None):
    colours = palette(scheme, threshold)
    assert_array_equal(colours[101:128], [GREEN] * 27)
    assert_array_equal(colours[[128, 254]], [[255, 0, 0, 255], [255, 255, 0, 255]])
    assert_array_equal(colours[UNKNOWN], [0x70, 0x89, 0x86, 255])


def test_with_a_threshold_there_are_two_colours():
    colours = palette("map", 65)
    assert_array_equal(colours[[0, 64]], [[255, 255, 255, 255]] * 2)
    assert_array_equal(colours[[65, 100]], [OCCUPIED] * 2)
    colours = palette("costmap", 65)
    assert_array_equal(colours[[0, 64]], [[0, 0, 255, 255]] * 2)
    assert_array_equal(colours[[65, 100]], [[255, 0, 0, 255]] * 2)
    colours = palette("raw", 65)
    assert_array_equal(colours[[0, 64]], [OCCUPIED] * 2)
    assert_array_equal(colours[[65, UNKNOWN]], [[255, 255, 255, 255]] * 2)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_at_the_ends_a_threshold_leaves_one_colour(scheme: str):
    assert len(np.unique(palette(scheme, 0)[:101], axis=0)) == 1
    assert len(np.unique(palette(scheme, 100)[:100], axis=0)) == 1
    assert not palette(scheme, 0).flags.writeable
