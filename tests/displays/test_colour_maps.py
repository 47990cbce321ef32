import colorsys

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from studio.displays.colour_maps import COLOUR_MAPS, mapped, table

SHARES = np.linspace(0, 1, 101)


def test_the_rainbow_goes_from_red_to_magenta_through_all_hues_between():
    expected = [colorsys.hsv_to_rgb(share * 5 / 6, 1, 1) for share in SHARES]
    assert_allclose(mapped(SHARES, "Rainbow"), np.array(expected) * 255, atol=1)


@pytest.mark.parametrize(
    ("name", "first", "middle", "last"),
    [
        ("Turbo", (48, 18, 59), (164, 252, 60), (122, 4, 3)),
        ("Viridis", (68, 1, 84), (33, 145, 140), (253, 231, 37)),
    ],
)
def test_maps_go_through_the_colours_that_they_are_known_for(
    name: str, first: tuple[int, ...], middle: tuple[int, ...], last: tuple[int, ...]
):
    found = mapped(np.array([0.0, 0.5, 1.0]), name)
    assert_array_equal(found[[0, 2]], [first, last])
    assert_allclose(found[1], middle, atol=20)


@pytest.mark.parametrize("name", COLOUR_MAPS)
def test_an_inverted_map_is_the_same_backwards(name: str):
    inverted = mapped(SHARES, name, inverted=True).astype(int)
    assert_allclose(inverted, mapped(1 - SHARES, name), atol=1)


def test_what_lies_outside_is_as_the_ends_and_what_is_no_number_as_the_beginning():
    found = mapped(np.array([-np.inf, -1, np.nan, 0, 1, 2, np.inf], dtype=np.float32), "Rainbow")
    assert_array_equal(found[:4], [[255, 0, 0]] * 4)
    assert_array_equal(found[4:], [[255, 0, 255]] * 3)


def test_a_table_is_made_once_and_nobody_writes_into_it():
    assert table("Turbo") is table("Turbo")
    assert not table("Turbo").flags.writeable
