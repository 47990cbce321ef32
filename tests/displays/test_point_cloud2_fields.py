import math
import struct
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from numpy.testing import assert_array_equal

from studio.displays.point_cloud2 import RAW_POINTS_MAX, CloudFields
from studio.errors import DisplayMessageError
from studio.ros.cdr import codec_of
from tests.support.clouds import CLOUD, FLOATS, RGB, Layout, cloud, laid_clouds
from tests.support.display_messages import TYPES

POINT = [[(1.0, 2.0, 3.0)]]
CODEC = codec_of(TYPES.message(CLOUD))


def fields_of(layout: Layout, rows: Any, **fields: Any) -> CloudFields:  # noqa: ANN401
    return CloudFields(CODEC.decode(cloud(layout, rows, **fields).cdr))


def as_float32(value: float) -> float:
    """What a number becomes in four bytes; what is too large becomes infinite."""
    try:
        return struct.unpack("<f", struct.pack("<f", value))[0]
    except OverflowError:
        return math.copysign(math.inf, value)


@given(laid_clouds())
def test_every_layout_is_read_as_a_slow_reader_reads_it(
    laid: tuple[Layout, list[list[tuple[float, ...]]]],
):
    layout, rows = laid
    fields = fields_of(layout, rows)
    points = [point for row in rows for point in row]
    at = {name: place for place, (name, _, _) in enumerate(layout.fields)}
    expected = [[as_float32(point[at[name]]) for name in "xyz"] for point in points]
    assert_array_equal(fields.positions()[0], np.array(expected, dtype=np.float32))
    extra = [as_float32(point[at["extra"]]) for point in points]
    assert_array_equal(fields.numbers("extra", None), np.array(extra, dtype=np.float32))
    last = np.array([len(points) - 1])
    assert_array_equal(fields.numbers("extra", last), np.array(extra[-1:], dtype=np.float32))


@pytest.mark.parametrize("big", [False, True])
@pytest.mark.parametrize("datatype", [5, 6, 7])
def test_a_colour_is_packed_into_a_number_of_four_bytes_of_any_type(datatype: int, big: bool):
    order, letter = (">" if big else "<"), {5: "i", 6: "I", 7: "f"}[datatype]
    value = struct.unpack(order + letter, struct.pack(order + "I", 0x00102030))[0]
    layout = Layout((*FLOATS.fields, ("rgb", 12, datatype)), 16, big=big)
    found = fields_of(layout, [[(0.0, 0.0, 0.0, value)] * 2] * 2).colours(None)
    assert_array_equal(found, [[0x10, 0x20, 0x30]] * 4)


def test_colours_of_three_bytes_and_of_three_fractions_are_read():
    parts = tuple((name, 12 + at, 2) for at, name in enumerate("rgb"))
    bytes_each = fields_of(Layout((*FLOATS.fields, *parts), 15), [[(0, 0, 0, 1, 2, 3)]])
    assert_array_equal(bytes_each.colours(None), [[1, 2, 3]])
    assert bytes_each.float_colours(None) is None
    parts = tuple((name, 12 + 4 * at, 7) for at, name in enumerate("rgb"))
    row = [(0, 0, 0, 0.5, 2.0, math.nan)]
    fractions = fields_of(Layout((*FLOATS.fields, *parts), 24), [row])
    assert_array_equal(fractions.float_colours(None), [[128, 255, 0]])
    assert fractions.colours(None) is None


def test_rows_follow_closely_when_their_step_was_left_out():
    rows = [[(1.0, 0.0, 0.0)] * 2, [(2.0, 0.0, 0.0)] * 2]
    found, _ = fields_of(FLOATS, rows, row_step=0).positions()
    assert_array_equal(found[:, 0], [1, 1, 2, 2])


def test_of_two_fields_with_one_name_the_first_counts():
    layout = Layout((*FLOATS.fields, ("i", 12, 7), ("i", 16, 7)), 20)
    fields = fields_of(layout, [[(0, 0, 0, 1, 2)]])
    assert_array_equal(fields.numbers("i", None), [1])
    assert fields.names == ("x", "y", "z", "i")


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"width": 2**32 - 1, "height": 2**32 - 1}, "is shorter than 4,294,967,295 points"),
        ({"width": 2}, "2 x 1 points of 12 bytes need 24 bytes, and it has 12"),
        ({"point_step": 0}, "point_step is 0"),
        ({"height": 2, "row_step": 5}, "row_step of 5 bytes is shorter"),
        ({"data": b""}, "and it has 0"),
        ({"fields": [{"name": "x"}] * 1001}, "1,001 fields"),
    ],
)
def test_sizes_that_the_data_does_not_hold_are_refused(wrong: dict[str, Any], sentence: str):
    with pytest.raises(DisplayMessageError, match=f"PointCloud2 cannot be drawn: .*{sentence}"):
        fields_of(FLOATS, POINT, **wrong)


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ([("x", 0, 7), ("y", 4, 7)], "it has no z, its fields are x, y"),
        ([], "it has no x, its fields are none"),
        ([("x", 0, 7), ("y", 4, 7), ("z", 9, 7)], '"z" ends after the 12 bytes'),
        ([("x", 2**32 - 1, 7), ("y", 4, 7), ("z", 8, 7)], '"x" ends after the 12 bytes'),
        ([("x", 0, 9), ("y", 4, 7), ("z", 8, 7)], '"x" has the unknown datatype 9'),
    ],
)
def test_fields_that_give_no_place_are_refused(fields: list[tuple[str, int, int]], sentence: str):
    given_fields = [
        {"name": name, "offset": offset, "datatype": datatype, "count": 1}
        for name, offset, datatype in fields
    ]
    with pytest.raises(DisplayMessageError, match=sentence):
        fields_of(FLOATS, POINT, fields=given_fields).positions()


def test_a_field_beyond_the_point_is_as_if_it_were_not_there():
    layout = Layout((*FLOATS.fields, ("rgb", 12, 7)), 16)
    wrong = [*FLOATS.fields, ("rgb", 14, 7)]
    given_fields = [{"name": n, "offset": o, "datatype": d, "count": 1} for n, o, d in wrong]
    fields = fields_of(layout, [[(0, 0, 0, 0)]], fields=given_fields)
    assert fields.colours(None) is None
    assert fields.numbers("rgb", None) is None
    assert fields.names == ("x", "y", "z")


def test_a_cloud_without_points_has_no_positions_whatever_its_steps_say():
    fields = fields_of(RGB, [], point_step=0)
    assert fields.count == 0
    assert fields.positions()[0].shape == (0, 3)


def test_of_a_huge_cloud_every_second_point_is_looked_at():
    count = RAW_POINTS_MAX + 2
    layout = Layout((("x", 0, 1), ("y", 0, 1), ("z", 0, 1)), 1)
    data = (np.arange(count) % 100).astype(np.int8)
    fields = fields_of(layout, [[]], width=count, data=data.view(np.uint8), row_step=count)
    positions, raw = fields.positions()
    assert raw is not None
    assert len(positions) == count // 2
    assert_array_equal(positions[:, 2], data[raw])
