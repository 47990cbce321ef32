from __future__ import annotations

import dataclasses
from typing import Any, cast

import numpy as np
import pytest

from studio.displays.drawing import (
    BODIES_MAX,
    GridLines,
    Lines,
    MeshFile,
    Points,
    Shape,
    Text,
)
from studio.errors import SceneError
from studio.scene.graph import PROPS_OF
from studio.scene.shapes import Shelves, nodes_of, same_arrays
from tests.support.live_shapes import MESH_URI, RED, every_shape, solids, upright
from tests.support.watched_scene import triangle


def shelves() -> Shelves:
    """With the mesh of `every_shape`."""
    made = Shelves()
    made.meshes.put(MESH_URI, triangle())
    return made


def cloud(count: int, style: str = "squares", *, precise: bool = False) -> Points:
    positions = np.full((count, 3), 12.3, np.float32)
    return Points(positions, RED, 0.1, style, precise=precise)  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize("name", every_shape())
def test_every_shape_is_a_node_that_viser_can_be_told_of(name: str):
    nodes = nodes_of(every_shape()[name], "1", shelves())
    assert nodes
    for made in nodes.values():
        kind: Any = PROPS_OF[made.kind]
        told = cast("dict[str, Any]", vars(kind(**made.props, **made.arrays, **made.flowing)))
        assert made.props.items() <= told.items()
        assert all(array.flags.c_contiguous for array in made.flowing.values())


@pytest.mark.parametrize("name", every_shape())
def test_a_name_of_a_node_holds_no_dot(name: str):
    assert not any("." in part for part in nodes_of(every_shape()[name], "1", shelves()))


def test_points_are_halves_unless_that_would_be_seen():
    (coarse,) = nodes_of(cloud(2), "1", shelves()).values()
    (fine,) = nodes_of(cloud(2, precise=True), "1", shelves()).values()
    assert (coarse.flowing["points"].dtype, fine.flowing["points"].dtype) == (
        np.float16,
        np.float32,
    )
    assert coarse.stream != fine.stream


def test_a_point_beyond_halves_is_no_error():
    far = Points(np.full((1, 3), 1e9, np.float32), RED)
    (drawn,) = nodes_of(far, "1", shelves()).values()
    assert np.isinf(drawn.flowing["points"]).all()


@pytest.mark.parametrize("style", ["boxes", "tiles"])
def test_too_many_boxes_or_tiles_are_drawn_as_squares(style: str):
    assert "many" in nodes_of(cloud(BODIES_MAX, style), "1", shelves())
    assert "points" in nodes_of(cloud(BODIES_MAX + 1, style), "1", shelves())


def test_tiles_are_flat_and_boxes_are_not():
    (box,) = nodes_of(cloud(1, "boxes"), "1", shelves()).values()
    (tile,) = nodes_of(cloud(1, "tiles"), "1", shelves()).values()
    assert box.flowing["batched_scales"].tolist() == [pytest.approx([0.1, 0.1, 0.1])]
    assert tile.flowing["batched_scales"].tolist() == [pytest.approx([0.1, 0.1, 0.0001])]


@pytest.mark.parametrize(
    ("style", "expected"),
    [
        ("points", ("square", "flat", 3.0)),
        ("squares", ("square", "gradient", 0.0)),
        ("flat squares", ("square", "flat", 0.0)),
        ("spheres", ("circle", "gradient", 0.0)),
    ],
)
def test_each_style_of_points_is_drawn_in_its_own_way(style: str, expected: tuple[str, str, float]):
    size_px = 3.0 if style == "points" else 0.0
    shape = dataclasses.replace(cloud(1, style), size_px=size_px)
    (made,) = nodes_of(shape, "1", shelves()).values()
    names = ("point_shape", "point_shading", "studio_point_px")
    assert tuple(made.props[name] for name in names) == expected


@pytest.mark.parametrize(
    "shape",
    [
        cloud(0),
        cloud(0, "boxes"),
        Lines(np.zeros((0, 2, 3), np.float32), RED),
        Text("  \n"),
        dataclasses.replace(
            solids("box", RED),
            positions=np.zeros((0, 3), np.float32),
            wxyz=np.zeros((0, 4), np.float32),
            scales=np.zeros((0, 3), np.float32),
        ),
    ],
    ids=lambda shape: type(shape).__name__,
)
def test_a_shape_without_anything_in_it_is_no_node(shape: Shape):
    assert nodes_of(shape, "1", shelves()) == {}


def test_more_than_a_browser_can_draw_is_refused_with_a_sentence():
    positions = np.broadcast_to(np.zeros(3, np.float32), (5_000_001, 3))
    with pytest.raises(SceneError, match=r"has 5000001 points, and the 3D view draws 5000000"):
        nodes_of(Points(positions, RED), "1", shelves())


def test_a_mesh_is_waited_for_and_one_that_failed_has_a_sign():
    made = Shelves()
    assert nodes_of(MeshFile(MESH_URI), "1", made) == {}
    made.meshes.put(MESH_URI, None)
    (sign,) = nodes_of(MeshFile(MESH_URI), "1", made).values()
    assert sign.props["wireframe"]


def test_a_mesh_shows_its_own_colours_unless_it_is_given_one():
    made = Shelves()
    made.meshes.put(MESH_URI, triangle(glb=b"glTF"))
    own, given = (
        nodes_of(MeshFile(MESH_URI, rgb=rgb, opacity=0.5), "1", made)["mesh"]
        for rgb in (None, (1, 2, 3))
    )
    assert own.props["studio_opacity"] == 0.5
    assert (given.props["color"], given.props["opacity"]) == ((1, 2, 3), 0.5)


def test_shapes_that_differ_in_small_values_have_the_same_arrays():
    one = cloud(2)
    assert same_arrays(one, dataclasses.replace(one, size_m=1.0, opacity=0.1))
    assert not same_arrays(one, dataclasses.replace(one, colors=RED.copy()))
    assert not same_arrays(None, one)
    assert not same_arrays(Text("a"), one)


def test_lines_with_an_end_that_is_nowhere_are_left_out():
    ends = np.array([[(0, 0, 0), (1, 0, 0)], [(0, 0, 0), (np.nan, np.inf, 0)]], np.float32)
    colors = np.zeros((2, 2, 3), np.uint8)
    drawn = nodes_of(Lines(ends, colors), "1", shelves())["lines"].flowing
    assert (drawn["points"].shape, drawn["colors"].shape) == ((1, 2, 3), (1, 2, 3))
    assert nodes_of(Lines(ends[1:], RED), "1", shelves()) == {}


def test_solids_of_different_opacities_are_a_node_for_each_opacity():
    count = 5
    several = dataclasses.replace(
        solids("box", RED),
        positions=np.arange(3 * count, dtype=np.float32).reshape(count, 3),
        wxyz=upright(count),
        scales=np.ones((count, 3), np.float32),
        colors=np.tile(RED, (count, 1)),
        opacities=np.array([1, 0.5, 0, 0.501, float("nan")], np.float32),
    )
    drawn = nodes_of(several, "1", shelves())
    seen = {made.props["opacity"]: len(made.flowing["batched_colors"]) for made in drawn.values()}
    assert seen == {None: 1, 0.5: 2}
    assert drawn["many-16"].flowing["batched_positions"][:, 0].tolist() == [3, 9]
    alike = dataclasses.replace(several, opacities=0.25)
    (made,) = nodes_of(alike, "1", shelves()).values()
    assert (made.props["opacity"], len(made.flowing["batched_scales"])) == (0.25, count)
    assert nodes_of(dataclasses.replace(several, opacities=0.0), "1", shelves()) == {}


def test_a_grid_has_a_line_more_than_cells_each_way_around_its_middle():
    for plane, missing in (("xy", 2), ("xz", 1), ("yz", 0)):
        shape = GridLines(plane, 10, 0.5, position=(1, 2, 3))  # pyright: ignore[reportArgumentType]
        ends = nodes_of(shape, "1", shelves())["lines"].flowing["points"]
        assert ends.shape == (22, 2, 3)
        spans = np.ptp(ends.reshape(-1, 3), axis=0)
        assert spans.tolist() == [0 if axis == missing else 5 for axis in range(3)]
        np.testing.assert_allclose(ends.reshape(-1, 3).mean(axis=0), (1, 2, 3), atol=1e-6)


def test_text_that_never_ends_is_cut():
    (drawn,) = nodes_of(Text("x" * 100_000), "1", shelves()).values()
    assert len(drawn.props["text"]) == 500
