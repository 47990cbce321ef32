"""Rows of the nodes of a shape lead back to rows of the shape, whatever of it is not drawn."""

from __future__ import annotations

import numpy as np
import pytest

from studio.displays.drawing import Arrows, Lines, Points, Solids, Text, Triangles
from studio.scene.picked_rows import rows_of
from studio.scene.shapes import Shelves, nodes_of
from tests.support.live_shapes import every_shape

NAN = float("nan")
GREY = np.full(3, 128, np.uint8)


def ends(*pairs: tuple[float, float]) -> np.ndarray[tuple[int, ...], np.dtype[np.float32]]:
    """Lines along x."""
    return np.array([[[a, 0, 0], [b, 0, 0]] for a, b in pairs], np.float32)


def of(shape: object, node: str, *rows: int) -> list[int]:
    return rows_of(shape, node, np.array(rows, np.intp)).tolist()  # type: ignore[arg-type]


def test_lines_to_nowhere_are_not_drawn_and_not_counted():
    shape = Lines(ends((0, 1), (NAN, 1), (2, 3), (4, 5)), GREY)
    (node,) = nodes_of(shape, "s", Shelves())
    assert of(shape, node, 0, 1, 2) == [0, 2, 3]


def test_short_arrows_are_counted_apart():
    shape = Arrows(ends((0, 5), (0, 0.1), (0, 5), (0, 0.2)), GREY, 0.1, 0.2, 1.0)
    assert set(nodes_of(shape, "s", Shelves())) == {"arrows", "many"}
    assert of(shape, "arrows", 0, 1) == [0, 2]
    assert of(shape, "many", 1) == [3]


def test_solids_of_one_opacity_are_counted_apart():
    places = np.zeros((4, 3), np.float32)
    turns = np.tile(np.array([1, 0, 0, 0], np.float32), (4, 1))
    opacities = np.array([1.0, 0.5, 0.0, 0.5], np.float32)
    shape = Solids("box", places, turns, np.ones((4, 3), np.float32), GREY, opacities)
    assert set(nodes_of(shape, "s", Shelves())) == {"many", "many-16"}
    assert of(shape, "many", 0) == [0]
    assert of(shape, "many-16", 0, 1) == [1, 3]


def test_triangles_without_a_corner_are_not_counted():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [NAN, 0, 0]], np.float32)
    faces = np.array([[0, 1, 3], [0, 1, 9], [0, 1, 2]], np.uint32)
    assert of(Triangles(vertices, faces, GREY), "surface", 0) == [2]


def test_a_shape_with_items_answers_with_those_and_each_once():
    shape = Points(np.zeros((4, 3), np.float32), GREY, items=np.array([7, 7, 9, 7]))
    assert of(shape, "points", 0, 1, 3) == [7]
    assert of(shape, "points", 2, 0) == [7, 9]


@pytest.mark.parametrize("name", sorted(every_shape()))
def test_rows_that_a_shape_does_not_have_are_none(name: str):
    shape = every_shape()[name]
    for node in (*nodes_of(shape, "s", Shelves()), "many-x", ""):
        found = of(shape, node, 1 << 30)
        assert found in ([], [1 << 30])  # without rows of its own, its display knows better


def test_what_has_no_rows_keeps_them_as_they_are():
    assert of(Text("words"), "text", 0) == [0]
