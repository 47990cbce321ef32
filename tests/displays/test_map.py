import math
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from studio.displays.display import Limits, Received, Status
from studio.displays.drawing import Picture, Placed
from studio.displays.map import TILE_CELLS, MapDisplay
from studio.errors import DisplayMessageError
from tests.support.display_messages import NOW_NS, STAMP_NS, TYPES, pose, received

MAP, UPDATE = "nav_msgs/msg/OccupancyGrid", "map_msgs/msg/OccupancyGridUpdate"
CELLS = [[0, 100, -1], [50, 0, 0]]
WHITE, BLACK, GREY = [255, 255, 255, 178], [0, 0, 0, 178], [0x70, 0x89, 0x86, 178]


def grid(cells: Any, *, little: bool = True, **info: Any) -> Received:  # noqa: ANN401
    """A map of cells, row by row from the smallest y on, each 10 cm wide."""
    rows = np.asarray(cells, dtype=np.int8)
    size = {"width": rows.shape[-1], "height": rows.shape[0], "resolution": 0.1}
    fields = {"info": {"origin": pose((1.0, 2.0, 0.0)), **size, **info}, "data": rows.ravel()}
    return received(MAP, fields, little=little)


def update(cells: Any, x: int, y: int, *, little: bool = True, **fields: Any) -> Received:  # noqa: ANN401
    rows = np.asarray(cells, dtype=np.int8)
    size = {"x": x, "y": y, "width": rows.shape[-1], "height": rows.shape[0]}
    return received(UPDATE, {**size, "data": rows.ravel(), **fields}, little=little)


def placed(display: MapDisplay) -> Placed:
    (one,) = display.draw(NOW_NS).values()
    return one


def picture(display: MapDisplay) -> Picture:
    (shape,) = placed(display).shapes.values()
    assert isinstance(shape, Picture)
    return shape


def shown(cells: Any, **values: Any) -> MapDisplay:  # noqa: ANN401
    display = MapDisplay(TYPES, {key.replace("_", " "): one for key, one in values.items()})
    display.take(grid(cells))
    return display


@pytest.mark.parametrize("little", [True, False])
def test_a_map_is_a_picture_from_its_origin_on(little: bool):
    display = MapDisplay(TYPES)
    display.take(grid(CELLS, little=little))
    found = picture(display)
    assert_array_equal(found.rgba[0], [WHITE, BLACK, GREY])
    assert_array_equal(found.rgba[1, 0], [128, 128, 128, 178])
    assert found.size_m == pytest.approx((0.3, 0.2))
    assert found.position == (1.0, 2.0, 0.0)
    assert found.wxyz == (1.0, 0.0, 0.0, 0.0)
    assert not found.behind
    assert display.statuses() == ()


def test_a_map_moves_with_its_frame_unless_its_stamp_is_used():
    one = placed(shown(CELLS))
    assert (one.frame, one.stamp_ns, one.follows) == ("map", 0, True)
    one = placed(shown(CELLS, Use_Timestamp=True))
    assert (one.frame, one.stamp_ns, one.follows) == ("map", STAMP_NS, False)


def test_a_map_without_a_frame_is_in_the_frame_map():
    display = MapDisplay(TYPES)
    info = {"width": 1, "height": 1, "resolution": 1.0}
    display.take(received(MAP, {"header": {"frame_id": ""}, "info": info, "data": [0]}))
    assert placed(display).frame == "map"


@pytest.mark.parametrize("little", [True, False])
def test_an_update_changes_its_cells_and_leaves_the_message_alone(little: bool):
    display, message = MapDisplay(TYPES), grid(CELLS)
    display.take(message)
    before = picture(display)
    display.take(update([[100], [100]], 2, 0, little=little), "updates")
    after = picture(display)
    assert_array_equal(after.rgba[:, 2], [BLACK, BLACK])
    assert_array_equal(after.rgba[:, :2], before.rgba[:, :2])
    assert_array_equal(before.rgba[0, 2], GREY)
    display.take(message)
    assert_array_equal(picture(display).rgba, before.rgba)


def test_an_update_before_any_map_is_passed_over():
    display = MapDisplay(TYPES)
    display.take(update([[100]], 0, 0), "updates")
    assert display.draw(NOW_NS) == {}
    assert display.statuses() == ()


@pytest.mark.parametrize(("sec", "taken"), [(0, True), (11, False), (12, True), (13, True)])
def test_an_update_from_before_the_map_is_passed_over(sec: int, taken: bool):
    display = shown(CELLS)
    header = {"stamp": {"sec": sec, "nanosec": 500 if sec else 0}}
    display.take(update([[100]], 0, 0, header=header), "updates")
    assert_array_equal(picture(display).rgba[0, 0], BLACK if taken else WHITE)


@pytest.mark.parametrize(("x", "y"), [(-1, 0), (0, -1), (2, 0), (0, 2), (2**31 - 1, 0)])
def test_an_update_that_reaches_beyond_the_map_is_refused(x: int, y: int):
    display = shown(CELLS)
    before = display.draw(NOW_NS)
    with pytest.raises(DisplayMessageError, match="reach beyond the map of 3 x 2"):
        display.take(update([[100, 100]], x, y), "updates")
    assert display.draw(NOW_NS) is before


def test_a_change_paints_only_the_tiles_that_it_touches():
    cells = np.zeros((10, TILE_CELLS + 10))
    display = shown(cells)
    before = placed(display).shapes
    display.take(update([[100]], TILE_CELLS + 1, 5), "updates")
    middle = placed(display).shapes
    assert [name for name in before if before[name] is not middle[name]] == ["0-1"]
    display.take(grid(cells))
    after = placed(display).shapes
    assert [name for name in middle if middle[name] is not after[name]] == ["0-1"]


@pytest.mark.parametrize(
    ("values", "first"),
    [
        ({"Color_Scheme": "raw"}, [0, 0, 0, 178]),
        ({"Color_Scheme": "costmap"}, [0, 0, 0, 0]),
        ({"Alpha": 1.0}, [255, 255, 255, 255]),
        ({"Binary_representation": True, "Binary_threshold": 0}, [0, 0, 0, 178]),
    ],
)
def test_properties_change_the_colours(values: dict[str, Any], first: list[int]):
    display = shown(CELLS)
    assert_array_equal(picture(display).rgba[0, 0], WHITE)
    for name, value in values.items():
        display.set(name.replace("_", " "), value)
    assert_array_equal(picture(display).rgba[0, 0], first)
    assert picture(shown(CELLS, Draw_Behind=True)).behind


def test_of_too_many_cells_the_highest_of_each_square_is_shown():
    cells = np.zeros((5, 7), dtype=np.int8)
    cells[0, 0], cells[1, 1], cells[4, 6] = -1, 100, -1
    display = MapDisplay(TYPES, {"Color Scheme": "raw", "Alpha": 1.0})
    display.limit(Limits(cells=12))
    display.take(grid(cells))
    found = picture(display)
    assert_array_equal(found.rgba[..., 0], [[100, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 255]])
    assert found.size_m == pytest.approx((0.8, 0.6))
    sentence = "Showing the highest of every 2 x 2 cells of 7 x 5."
    assert display.statuses() == (Status("ok", "thinned", sentence),)
    display.take(update([[7, 7]], 5, 4), "updates")
    assert_array_equal(picture(display).rgba[2, ..., 0], [0, 0, 7, 7])


@pytest.mark.parametrize(
    ("message", "sentence"),
    [
        (grid(CELLS, width=4), "4 x 2 cells need as many values, and it has 6"),
        (grid(CELLS, width=2**32 - 1, height=2**32 - 1), "at most 268,435,456 are drawn"),
        (grid(CELLS, resolution=0.0), "its resolution is 0 m"),
        (grid(CELLS, resolution=math.nan), "its resolution is nan m"),
        (grid(CELLS, resolution=math.inf), "its resolution is inf m"),
        (grid(CELLS, origin=pose((math.nan, 0, 0))), "its origin is NaN"),
        (grid(CELLS, origin=pose((1e300, 0, 0))), "its origin is NaN, infinite or out of reach"),
        (grid(CELLS, origin=pose((0, 0, 0), (math.inf, 0, 0, 0))), "its origin is NaN"),
    ],
)
def test_a_map_that_makes_no_sense_is_refused_and_the_one_before_stays(
    message: Received, sentence: str
):
    display = shown(CELLS)
    before = display.draw(NOW_NS)
    with pytest.raises(DisplayMessageError, match=f"OccupancyGrid cannot be drawn: .*{sentence}"):
        display.take(message)
    assert display.draw(NOW_NS) is before


def test_an_origin_without_a_turn_is_turned_as_its_frame():
    display = MapDisplay(TYPES)
    display.take(grid(CELLS, origin=pose((0, 0, 0), (0, 0, 0, 0))))
    assert picture(display).wxyz == (1.0, 0.0, 0.0, 0.0)
    display.take(grid(CELLS, origin=pose((0, 0, 0), (0, 0, 0, 2))))
    assert picture(display).wxyz == (0.0, 0.0, 0.0, 1.0)


def test_a_map_without_cells_says_so():
    display = MapDisplay(TYPES)
    display.take(grid(np.zeros((0, 3))))
    assert display.draw(NOW_NS) == {}
    assert display.statuses() == (Status("warn", "empty", "The map has no cells: it is 3 x 0."),)


def test_a_costmap_of_zeros_and_an_alpha_of_0_are_told_with_what_mends_them():
    display = shown(np.zeros((2, 2)), Color_Scheme="costmap")
    (status,) = display.statuses()
    assert (status.reason, status.mend) == ("transparent", ("Color Scheme", "map"))
    display = shown(CELLS, Alpha=0.0)
    (status,) = display.statuses()
    assert (status.reason, status.mend) == ("transparent", ("Alpha", 0.7))


def test_nothing_is_seen_after_a_reset():
    display = shown(CELLS)
    display.reset()
    assert display.draw(NOW_NS) == {}
    display.take(update([[1]], 0, 0), "updates")
    assert display.draw(NOW_NS) == {}
