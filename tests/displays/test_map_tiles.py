import math

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from studio.displays.map import TILE_CELLS, Sheet, Tiles, paint_of, palette

ROWS, COLUMNS = TILE_CELLS + 3, 2 * TILE_CELLS + 5
HALF_TURN = math.sqrt(0.5)
SHEET = Sheet(ROWS, COLUMNS, 0.5, (10.0, 20.0, 30.0), (HALF_TURN, 0.0, 0.0, HALF_TURN))
RAW = paint_of(palette("raw"), 1.0, behind=True)


def numbered() -> np.ndarray[tuple[int, int], np.dtype[np.int8]]:
    return (np.arange(ROWS * COLUMNS) % 100).astype(np.int8).reshape(ROWS, COLUMNS)


def laid() -> Tiles:
    tiles = Tiles()
    tiles.lay(SHEET, numbered())
    return tiles


def test_tiles_hold_every_cell_once_where_it_lies():
    pictures = laid().painted(RAW)
    assert set(pictures) == {f"{row}-{column}" for row in range(2) for column in range(3)}
    rows = [
        np.concatenate([pictures[f"{row}-{column}"].rgba for column in range(3)], axis=1)
        for row in range(2)
    ]
    assert_array_equal(np.concatenate(rows)[..., 0], numbered())
    last = pictures["1-2"]
    assert last.size_m == (2.5, 1.5)
    # A quarter turn to the left: columns go along y and rows against x.
    assert_allclose(last.position, (10 - TILE_CELLS / 2, 20 + TILE_CELLS, 30))
    assert last.wxyz == SHEET.wxyz
    assert last.behind


def test_only_tiles_whose_cells_changed_are_painted_anew():
    tiles = laid()
    before = tiles.painted(RAW)
    other = numbered()
    other[-1, 0] += 1
    tiles.lay(SHEET, other)
    after = tiles.painted(RAW)
    assert [name for name in before if before[name] is not after[name]] == ["1-0"]
    assert after["1-0"].rgba[-1, 0, 0] == other[-1, 0]


def test_a_spoilt_part_is_painted_anew_in_all_tiles_that_it_touches():
    tiles = laid()
    before = tiles.painted(RAW)
    tiles.spoil(slice(0, 1), slice(TILE_CELLS - 1, TILE_CELLS + 1))
    after = tiles.painted(RAW)
    assert [name for name in before if before[name] is not after[name]] == ["0-0", "0-1"]
    tiles.repaint()
    assert not set(after.values()) & set(tiles.painted(RAW).values())


def test_a_map_that_lies_elsewhere_is_painted_anew():
    tiles = laid()
    before = tiles.painted(RAW)
    tiles.lay(Sheet(ROWS, COLUMNS, 0.5, (0.0, 0.0, 0.0), SHEET.wxyz), numbered())
    assert not set(before.values()) & set(tiles.painted(RAW).values())


def test_without_a_map_there_is_nothing():
    tiles = Tiles()
    tiles.spoil(slice(0, 1), slice(0, 1))
    assert tiles.painted(RAW) == {}


@pytest.mark.parametrize(("alpha", "seen"), [(1.0, 255), (0.7, 178), (0.0, 0)])
def test_opacity_is_that_of_the_colour_times_alpha(alpha: float, seen: int):
    colours = paint_of(palette("costmap"), alpha, behind=False).colours.view(np.uint8)
    assert_array_equal(colours.reshape(256, 4)[[0, 99]], [[0, 0, 0, 0], [0, 255, 255, seen]])
