"""Drawings of plug-ins there and back, and what is refused of them."""

import math
from typing import Any

import numpy as np
import pytest

from studio.displays.display import TopicRole
from studio.displays.drawing import (
    Arrows,
    Axes,
    Drawing,
    Frustum,
    GridLines,
    Lines,
    LinkParts,
    MeshFile,
    Picture,
    Placed,
    Points,
    Shape,
    Solids,
    Text,
    Triangles,
)
from studio.displays.plugins.packing import (
    ShapeBook,
    ShapeShelf,
    pack_property,
    pack_role,
    unpack_property,
    unpack_role,
)
from studio.displays.plugins.requests import CODEC, Drawn
from studio.displays.properties import Property
from studio.errors import DisplayError, DisplayPropertyError
from studio.robot.values import Link, Robot
from tests.support.drawn import assert_drawable, plain

RED = np.array([255, 0, 0], np.uint8)
ONE = np.array([[1.0, 2.0, 3.0]], np.float32)
UP = np.array([[1.0, 0.0, 0.0, 0.0]], np.float32)
ENDS = np.array([[[0, 0, 0], [1, 1, 1]]], np.float32)
CORNERS = np.eye(3, dtype=np.float32)
FACE = np.array([[0, 1, 2]], np.uint32)
PIXELS = np.arange(16, dtype=np.uint8).reshape(2, 2, 4)
SHAPES: dict[str, Shape] = {
    "points": Points(ONE, RED, 0.1, "boxes", 0.5, precise=True, size_px=3.0),
    "lines": Lines(ENDS, np.zeros((1, 2, 3), np.uint8), 0.1),
    "arrows": Arrows(ENDS, RED, 0.1, 0.2, 0.3),
    "axes": Axes(ONE, UP, 2.0),
    "solids": Solids("cone", ONE, UP, ONE, RED, np.array([0.5], np.float32)),
    "faded": Solids("box", ONE, UP, ONE, RED, 0.25),
    "triangles": Triangles(CORNERS, FACE, RED),
    "mesh": MeshFile("package://a/b.stl", (1.0, 2.0, 3.0), None, 0.5, (1.0, 0.0, 0.0)),
    "text": Text("word", (0.0, 0.0, 1.0), 0.2, (1, 2, 3)),
    "picture": Picture(PIXELS, (2.0, 3.0), behind=True),
    "indexed": Picture(np.zeros((2, 2), np.uint8), (2.0, 3.0),
                       palette=np.zeros((256, 4), np.uint8)),
    "frustum": Frustum(1.0, 1.5, 2.0, np.zeros((2, 3, 3), np.uint8)),
    "edges": Frustum(1.0, 1.5, 2.0),
    "grid": GridLines("xz", 4, 0.5),
}  # fmt: skip


def sent(drawing: Drawing, book: ShapeBook, shelf: ShapeShelf) -> Drawing:
    """A drawing as it comes out of the pipe."""
    groups, shapes = book.pack(drawing)
    frame = CODEC.pack(Drawn(groups, shapes, (), "", (), ()))
    drawn = CODEC.unpack(bytes(frame)[4:])
    return shelf.unpack(drawn.groups, drawn.shapes)


@pytest.mark.parametrize("name", SHAPES)
def test_a_shape_is_the_same_at_the_other_end(name: str):
    offset = (1.0, 0.0, 0.0, 0.0), (1.0, 2.0, 3.0)
    placed = Placed("map", 5, {"a": SHAPES[name]}, follows=True, turns=False, offset=offset)
    got = sent({"p/q": placed}, ShapeBook(), ShapeShelf())
    assert_drawable(got)
    made = got["p/q"]
    assert plain(made.shapes["a"]) == plain(SHAPES[name])
    assert (made.frame, made.stamp_ns, made.follows, made.turns) == ("map", 5, True, False)
    assert made.offset == offset


def test_a_shape_that_is_the_same_object_is_sent_once():
    book, shelf = ShapeBook(), ShapeShelf()
    first, second = Text("a"), Text("b")
    before = sent({"p": Placed("map", 0, {"one": first})}, book, shelf)
    after = sent({"p": Placed("map", 0, {"one": first, "two": second})}, book, shelf)
    assert after["p"].shapes["one"] is before["p"].shapes["one"]
    assert book.pack({"p": Placed("map", 0, {"one": first})})[1] == ()


def test_lists_and_doubles_become_what_the_shape_promises():
    shape: Any = Points([[1, 2, 3]], np.array([0.0, 128.0, 255.0]), np.float64(0.5))  # pyright: ignore[reportArgumentType]
    got = sent({"p": Placed("map", 0, {"a": shape})}, ShapeBook(), ShapeShelf())
    assert_drawable(got)


NAN = np.array([[math.nan, 0, 0]], np.float32)
ODD: list[tuple[Shape, str]] = [
    (Points(NAN, RED), "1 numbers in positions of Points are NaN"),
    (Points(ONE, RED, math.inf), "size_m of Points is NaN, infinite"),
    (Points(ONE[:, :2], RED), r"positions of Points has the size \(1, 2\)"),
    (Points(ONE, np.zeros((2, 3), np.uint8)), r"colors of Points has the size \(2, 3\)"),
    (Points(ONE, RED, style="stars"), "style of Points is one of"),  # pyright: ignore[reportArgumentType]
    (Axes(ONE, 0 * UP), "quaternion in wxyz of Axes has the length 0"),
    (Triangles(CORNERS, FACE + 1, RED), "name a corner"),
    (Text("a", (0.0, 0.0)), "position of Text has 3 numbers"),  # pyright: ignore[reportArgumentType]
    (Text(7), "text of Text cannot be '7'"),  # pyright: ignore[reportArgumentType]
    (Text("a", height_m="high"), "height_m of Text cannot be 'high'"),  # pyright: ignore[reportArgumentType]
]


@pytest.mark.parametrize(("shape", "reason"), ODD, ids=[reason for _, reason in ODD])
def test_a_shape_that_makes_no_sense_is_refused_with_its_field(shape: Shape, reason: str):
    with pytest.raises(DisplayError, match=reason):
        sent({"p": Placed("map", 0, {"a": shape})}, ShapeBook(), ShapeShelf())


def test_links_of_robots_and_other_things_are_no_shapes_of_plugins():
    link: Any = LinkParts(Link("a"), Robot("r"))
    words: Any = "words"
    for odd in (link, words):
        with pytest.raises(DisplayError, match="its shapes are"):
            ShapeBook().pack({"p": Placed("map", 0, {"a": odd})})


TURN = (1.0, 0.0, 0.0, math.nan)


@pytest.mark.parametrize(
    "placed",
    [
        Placed("map", -1),
        Placed("map", 0, offset=((0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))),
        Placed("map", 0, offset=(TURN, (0.0, 0.0, 0.0))),
    ],
)
def test_a_place_that_makes_no_sense_is_refused(placed: Placed):
    with pytest.raises(DisplayError):
        sent({"p": placed}, ShapeBook(), ShapeShelf())


def test_roles_and_properties_are_the_same_at_the_other_end():
    role = TopicRole("a", ("b/msg/C",), "/d", newest_only=False, latched=True, depth=3)
    assert unpack_role(pack_role(role)) == role
    one = Property("A", "choice", "x", "It.", choices=("x", "y"), when=("B", (True,)))
    assert unpack_property(pack_property(one)) == one
    number = Property("A", "number", 1.0, "It.", low=0.0)
    assert unpack_property(pack_property(number)) == number


def test_a_property_whose_default_is_none_of_its_values_is_refused():
    with pytest.raises(DisplayPropertyError):
        pack_property(Property("A", "switch", 3, "It."))
