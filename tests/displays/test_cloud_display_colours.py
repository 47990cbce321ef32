from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from numpy.typing import NDArray

from studio.displays.cloud_display import CLOUD_PROPERTIES, needs_precision, too_many_bodies
from studio.displays.display import Status
from studio.displays.drawing import BODIES_MAX, Points
from studio.displays.point_cloud2 import PointCloud2Display
from tests.support.clouds import FLOATS, INTENSITY, RGB, Layout, cloud
from tests.support.display_messages import NOW_NS, TYPES

LINE = [[(0.0, 0.0, float(height), 10.0 * height) for height in range(5)]]
PLAIN = [[point[:3] for point in LINE[0]]]
RAINBOW_ENDS = [[255, 0, 0], [255, 0, 255]]


def drawn(
    layout: Layout,
    rows: Any,  # noqa: ANN401
    **values: Any,  # noqa: ANN401
) -> tuple[Points, tuple[Status, ...]]:
    display = PointCloud2Display(TYPES, {key.replace("_", " "): one for key, one in values.items()})
    display.take(cloud(layout, rows))
    shape = display.draw(NOW_NS)["0"].shapes["points"]
    assert isinstance(shape, Points)
    return shape, display.statuses()


def colours(layout: Layout, rows: Any, **values: Any) -> NDArray[np.uint8]:  # noqa: ANN401
    shape, statuses = drawn(layout, rows, **values)
    assert statuses == ()
    return shape.colors


def test_the_properties_have_rvizs_names_and_first_values():
    firsts = {one.name: one.default for one in CLOUD_PROPERTIES}
    assert firsts["Style"] == "Flat Squares"
    assert firsts["Size (m)"] == 0.01
    assert firsts["Channel Name"] == "intensity"
    assert firsts["Max Intensity"] == 4096.0
    assert firsts["Autocompute Value Bounds/Min Value"] == -10.0


def test_the_first_choice_is_sent_colours_then_intensity_then_height():
    assert_array_equal(colours(RGB, [[(0.0, 0.0, 0.0, 0.0)]]), [[0, 0, 0]])
    assert_array_equal(colours(INTENSITY, LINE)[[0, 4]], RAINBOW_ENDS)
    named_otherwise = Layout((*FLOATS.fields, ("intensities", 12, 7)), 16)
    assert_array_equal(colours(named_otherwise, LINE), colours(INTENSITY, LINE))
    assert_array_equal(colours(FLOATS, PLAIN)[[0, 4]], RAINBOW_ENDS)


def test_fractions_are_taken_by_themselves_too():
    parts = tuple((name, 12 + 4 * at, 7) for at, name in enumerate("rgb"))
    layout = Layout((*FLOATS.fields, *parts), 24)
    rows = [[(0, 0, 0, 1, 0.5, 0)]]
    assert_array_equal(colours(layout, rows), [[255, 128, 0]])
    assert_array_equal(colours(layout, rows, Color_Transformer="RGBF32"), [[255, 128, 0]])


def test_one_colour_for_all_is_one_row():
    found = colours(INTENSITY, LINE, Color_Transformer="FlatColor", Color="#0a141e")
    assert_array_equal(found, [10, 20, 30])


def test_values_along_an_axis_lie_between_the_bounds_that_are_given():
    bounds = {
        "Autocompute Value Bounds": False,
        "Autocompute Value Bounds/Min Value": 1.0,
        "Autocompute Value Bounds/Max Value": 3.0,
    }
    found = colours(FLOATS, PLAIN, Color_Transformer="AxisColor", **bounds)
    assert_array_equal(found[[0, 1, 3, 4]], np.repeat(RAINBOW_ENDS, 2, axis=0))
    alike = colours(FLOATS, PLAIN, Color_Transformer="AxisColor", Axis="X")
    assert_array_equal(alike, [RAINBOW_ENDS[0]] * 5)


def test_intensities_lie_between_two_colours_without_a_rainbow():
    two = {"Use rainbow": False, "Min_Color": "#000000", "Max_Color": "#ff8000"}
    found = colours(INTENSITY, LINE, Color_Transformer="Intensity", **two)
    assert_array_equal(found[[0, 2, 4]], [[0, 0, 0], [128, 64, 0], [255, 128, 0]])
    given = {"Autocompute Intensity Bounds": False, "Min Intensity": 20, "Max Intensity": 40}
    found = colours(INTENSITY, LINE, **two, **given)
    assert_array_equal(found, [[0, 0, 0]] * 3 + [[128, 64, 0], [255, 128, 0]])


def test_any_field_gives_colours_and_maps_may_be_inverted():
    layout = Layout((*FLOATS.fields, ("ring", 12, 4)), 14)
    rows = [[(0, 0, 0, 3), (0, 0, 0, 7)]]
    assert_array_equal(colours(layout, rows, Channel_Name="ring"), RAINBOW_ENDS)
    found = colours(layout, rows, Channel_Name="ring", Invert_Rainbow=True)
    assert_array_equal(found, RAINBOW_ENDS[::-1])
    turbo = colours(layout, rows, Channel_Name="ring", Color_Map="Turbo")
    assert_array_equal(turbo, [[48, 18, 59], [122, 4, 3]])


def test_numbers_that_are_none_do_not_move_the_bounds():
    rows = [[(0, 0, 0, value) for value in (np.nan, 0.0, np.inf, 8.0, -np.inf)]]
    found = colours(INTENSITY, rows)
    assert_array_equal(found[[1, 3]], RAINBOW_ENDS)
    assert_array_equal(found[[0, 2, 4]], [RAINBOW_ENDS[0], RAINBOW_ENDS[1], RAINBOW_ENDS[0]])
    none = colours(INTENSITY, [[(0, 0, 0, np.nan)]])
    assert_array_equal(none, RAINBOW_ENDS[:1])


def test_bounds_as_far_apart_as_floats_go_raise_nothing():
    rows = [[(0, 0, 0, value) for value in (-3e38, 3e38)]]
    assert_array_equal(colours(INTENSITY, rows), RAINBOW_ENDS)


@pytest.mark.parametrize(
    ("layout", "values", "sentence", "mend"),
    [
        (
            Layout((*FLOATS.fields, ("ring", 12, 7)), 16),
            {"Color_Transformer": "Intensity"},
            'The messages have no field "intensity": they have x, y, z, ring.',
            ("Channel Name", "ring"),
        ),
        (
            FLOATS,
            {"Color_Transformer": "Intensity", "Channel_Name": "t"},
            'The messages have no field "t": they have x, y, z.',
            ("Color Transformer", "AxisColor"),
        ),
        (
            FLOATS,
            {"Color_Transformer": "RGB8"},
            'The messages have no fields "rgb" or "rgba": they have x, y, z.',
            ("Color Transformer", "Automatic"),
        ),
    ],
)
def test_a_field_that_is_not_there_is_told_with_those_that_are_and_drawn_white(
    layout: Layout, values: dict[str, Any], sentence: str, mend: tuple[str, str]
):
    rows = LINE if len(layout.fields) == 4 else PLAIN
    shape, statuses = drawn(layout, rows, **values)
    assert_array_equal(shape.colors, [255, 255, 255])
    assert statuses == (Status("warn", "unknown_field", sentence, mend),)


def test_a_shape_has_the_size_style_and_opacity_of_the_properties():
    shape, _ = drawn(FLOATS, PLAIN, Style="Boxes", Alpha=0.5, **{"Size (m)": 0.2})
    assert (shape.style, shape.opacity, shape.size_m) == ("boxes", 0.5, 0.2)


def test_only_points_have_a_size_on_the_screen():
    sizes = {"Size (Pixels)": 5}
    assert drawn(FLOATS, PLAIN, Style="Points", **sizes)[0].size_px == 5.0
    assert drawn(FLOATS, PLAIN, Style="Squares", **sizes)[0].size_px == 0.0


@pytest.mark.parametrize("style", ["Boxes", "Tiles"])
def test_more_boxes_or_tiles_than_can_be_drawn_are_told_of_with_what_is_drawn(style: str):
    assert too_many_bodies(BODIES_MAX, {"Style": style}) is None
    said = too_many_bodies(BODIES_MAX + 1, {"Style": style})
    assert said is not None
    assert said.sentence == (
        f"20,001 points are drawn as squares: as {style.lower()} there may be 20,000."
    )
    assert said.mend == ("Style", "Flat Squares")
    assert too_many_bodies(BODIES_MAX + 1, {"Style": "Spheres"}) is None


@pytest.mark.parametrize(
    ("farthest_m", "size_m", "precise"),
    [(7.9, 0.01, False), (8.0, 0.01, True), (-8.0, 0.01, True), (60.0, 0.1, False), (0, 1, False),
     (40_000.0, 100.0, False), (1e9, 100.0, True), (200.0, 0.1, True)],
)  # fmt: skip
def test_full_precision_is_asked_for_where_steps_would_be_seen(
    farthest_m: float, size_m: float, precise: bool
):
    positions = np.array([[0, 0, 0], [0, farthest_m, 0]], dtype=np.float32)
    assert needs_precision(positions, size_m) is precise
    assert not needs_precision(np.empty((0, 3), dtype=np.float32), size_m)
