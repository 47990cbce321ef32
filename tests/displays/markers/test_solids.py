from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from studio.displays.drawing import Points, Solids
from studio.displays.markers.kinds import Kind
from studio.displays.markers.solids import MANY
from tests.support.markers import HALF, QUARTER_ABOUT_Z, marker, shown

BOTH_ORDERS = pytest.mark.parametrize("little", [True, False], ids=["little", "big"])


def solids(*markers: object, name: str, little: bool = True) -> Solids:
    found = shown(*markers, little=little)
    assert list(found) == [name]
    made = found[name]
    assert isinstance(made, Solids)
    return made


@BOTH_ORDERS
@pytest.mark.parametrize(
    ("kind", "name", "solid"),
    [(Kind.CUBE, "boxes", "box"), (Kind.SPHERE, "balls", "sphere"),
     (Kind.CYLINDER, "cylinders", "cylinder")],
)  # fmt: skip
def test_solids_have_their_edges_or_diameters_as_scale(
    kind: Kind, name: str, solid: str, little: bool
):
    made = solids(marker(kind, wxyz=QUARTER_ABOUT_Z), name=name, little=little)
    assert made.kind == solid
    assert_allclose(made.positions, [[1, 2, 3]])
    assert_allclose(made.wxyz, [[HALF, 0, 0, HALF]], rtol=1e-6)
    assert_allclose(made.scales, [[0.5, 0.25, 2]])
    assert made.colors.tolist() == [255, 0, 51]
    assert made.opacities == 1.0
    assert made.positions.dtype == made.wxyz.dtype == made.scales.dtype == np.float32
    assert made.colors.dtype == np.uint8


@BOTH_ORDERS
@pytest.mark.parametrize(("kind", "name"), [(Kind.CUBE_LIST, "boxes"), (Kind.SPHERE_LIST, "balls")])
def test_lists_of_solids_are_placed_by_the_pose_and_all_turned_alike(
    kind: Kind, name: str, little: bool
):
    points = [(1.0, 0.0, 0.0), (0.0, 2.0, 0.0)]
    colors = [(1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 0.5)]
    one = marker(kind, wxyz=QUARTER_ABOUT_Z, points=points, colors=colors)
    made = solids(one, name=name, little=little)
    assert_allclose(made.positions, [[1, 3, 3], [-1, 2, 3]], atol=1e-6)
    assert_allclose(made.wxyz, [[HALF, 0, 0, HALF]] * 2, rtol=1e-6)
    assert_allclose(made.scales, [[0.5, 0.25, 2]] * 2)
    assert made.colors.tolist() == [[255, 0, 0], [0, 255, 0]]
    assert_allclose(made.opacities, [1.0, 128 / 255], rtol=1e-6)


def test_a_list_whose_colours_are_not_as_many_as_its_points_has_the_colour_of_the_marker():
    points = [(0.0, 0.0, 0.0)] * 3
    made = solids(
        marker(Kind.CUBE_LIST, points=points, colors=[(1.0, 1.0, 1.0, 1.0)] * 2), name="boxes"
    )
    assert made.colors.tolist() == [255, 0, 51]


def test_boxes_and_lists_of_boxes_of_one_namespace_are_one_shape():
    two = marker(Kind.CUBE_LIST, 1, points=[(0.0, 0.0, 0.0)] * 2, rgba=(0.0, 0.0, 1.0, 0.5))
    made = solids(marker(Kind.CUBE), two, marker(Kind.CUBE, 2), name="boxes")
    assert len(made.positions) == 4
    assert made.colors.tolist() == [[255, 0, 51], [255, 0, 51], [0, 0, 255], [0, 0, 255]]
    assert_allclose(made.opacities, [1, 1, 128 / 255, 128 / 255], rtol=1e-6)


def test_a_quaternion_of_zeros_is_no_turn_and_another_length_means_nothing():
    made = solids(
        marker(Kind.CUBE, 0, wxyz=(0.0, 0.0, 0.0, 0.0)),
        marker(Kind.CUBE, 1, wxyz=(0.0, 0.0, 0.0, 30.0)),
        name="boxes",
    )
    assert_allclose(made.wxyz, [[1, 0, 0, 0], [0, 0, 0, 1]])


def test_negative_scales_are_lengths_and_colours_beyond_their_range_are_held_within():
    made = solids(
        marker(Kind.CUBE, scale=(-1.0, 2.0, -3.0), rgba=(7.0, -1.0, 0.0, 9.0)), name="boxes"
    )
    assert made.scales.tolist() == [[1, 2, 3]]
    assert made.colors.tolist() == [255, 0, 0]
    assert made.opacities == 1.0


def test_what_is_clear_is_not_drawn():
    assert shown(marker(Kind.CUBE, rgba=(1.0, 0.0, 0.0, 0.0))) == {}


@pytest.mark.parametrize(
    ("kind", "name", "style"),
    [(Kind.CUBE_LIST, "many-boxes-0", "boxes"), (Kind.SPHERE_LIST, "many-balls-0", "spheres")],
)
def test_a_long_list_of_equal_solids_is_a_cloud(kind: Kind, name: str, style: str):
    points = [(float(each), 0.0, 0.0) for each in range(MANY)]
    found = shown(marker(kind, points=points, scale=(0.1, 0.1, 0.1)))
    assert list(found) == [name]
    cloud = found[name]
    assert isinstance(cloud, Points)
    assert cloud.style == style
    assert_allclose(cloud.size_m, 0.1)
    assert_allclose(cloud.positions[:2], [[1, 2, 3], [2, 2, 3]])
    assert cloud.colors.tolist() == [255, 0, 51]
    assert cloud.precise


@pytest.mark.parametrize("look", [{"wxyz": QUARTER_ABOUT_Z}, {"scale": (0.1, 0.2, 0.1)}])
def test_a_long_list_that_is_turned_or_uneven_stays_one_of_solids(look: dict[str, object]):
    points = [(0.0, 0.0, 0.0)] * MANY
    shape = {"scale": (0.1, 0.1, 0.1)} | look
    assert list(shown(marker(Kind.CUBE_LIST, points=points, **shape))) == ["boxes"]  # pyright: ignore[reportArgumentType]
