from __future__ import annotations

import numpy as np
import pytest

from studio.displays.drawing import GridLines, Lines
from studio.displays.grid import GridDisplay
from tests.support.display_messages import TYPES
from tests.support.drawn import assert_drawable, only, said


def test_a_grid_is_as_rviz_has_it_at_first():
    display = GridDisplay(TYPES)
    placed = only(display)
    assert (placed.frame, placed.stamp_ns, placed.follows) == ("<Fixed Frame>", 0, True)
    assert placed.shapes == {"layer_0": GridLines("xy", 10, 1.0, 0.0, (160, 160, 164), 0.5)}
    assert display.draw(1) is display.draw(0)
    assert said(display) == []


@pytest.mark.parametrize(
    ("plane", "name", "across"), [("XY", "xy", 2), ("XZ", "xz", 1), ("YZ", "yz", 0)]
)
def test_layers_lie_evenly_to_both_sides_and_are_joined_at_their_corners(
    plane: str, name: str, across: int
):
    display = GridDisplay(
        TYPES,
        {"Plane": plane, "Plane Cell Count": 2, "Normal Cell Count": 3, "Cell Size": 0.5},
    )
    for axis, metres in zip("XYZ", (1.0, 2.0, 4.0), strict=True):
        display.set(f"Offset/{axis}", metres)
    assert_drawable(display.draw(0))
    shapes = dict(only(display).shapes)
    uprights = shapes.pop("uprights")
    assert isinstance(uprights, Lines)
    heights: list[float] = []
    for shape in shapes.values():
        assert isinstance(shape, GridLines)
        assert (shape.plane, shape.cells, shape.cell_m) == (name, 2, 0.5)
        heights.append(shape.position[across])
        rest = [shape.position[axis] for axis in range(3) if axis != across]
        assert rest == [(1.0, 2.0, 4.0)[axis] for axis in range(3) if axis != across]
    middle = (1.0, 2.0, 4.0)[across]
    assert heights == [middle - 0.75, middle - 0.25, middle + 0.25, middle + 0.75]
    assert uprights.ends.shape == (9, 2, 3)
    assert set(uprights.ends[:, 0, across].tolist()) == {middle - 0.75}
    assert set(uprights.ends[:, 1, across].tolist()) == {middle + 0.75}
    corners = {tuple(np.delete(end[0], across).tolist()) for end in uprights.ends}
    assert len(corners) == 9


def test_bands_have_a_width_and_lines_have_none():
    display = GridDisplay(TYPES, {"Line Width": 0.1, "Color": "#010203", "Alpha": 1.0})
    display.set("Normal Cell Count", 1)
    for style, width_m in (("Lines", 0.0), ("Billboards", 0.1)):
        display.set("Line Style", style)
        for shape in only(display).shapes.values():
            assert isinstance(shape, GridLines | Lines)
            assert (shape.width_m, shape.opacity) == (width_m, 1.0)


def test_a_lattice_of_too_many_lines_is_told_and_drawn_without_them():
    display = GridDisplay(TYPES, {"Plane Cell Count": 1e9, "Normal Cell Count": 2})
    assert display.values["Plane Cell Count"] == 1000
    assert set(only(display).shapes) == {"layer_0", "layer_1", "layer_2"}
    assert said(display) == [("warn", "unsupported")]
    (told,) = display.statuses()
    assert told.mend is not None
    display.set(*told.mend)
    assert "uprights" in only(display).shapes
    assert said(display) == []


def test_what_cannot_be_seen_is_told():
    display = GridDisplay(TYPES, {"Alpha": 0.0})
    assert display.draw(0) == {}
    assert said(display) == [("warn", "transparent")]
