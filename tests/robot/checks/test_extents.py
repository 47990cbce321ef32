from __future__ import annotations

import math

import numpy as np
import pytest

from studio.robot.checks.extents import Extent, extents, is_marker
from studio.robot.values import Box, Collision, Cylinder, Link, Mesh, Origin, Visual

FLAT = Visual(Origin((1, 0, 0), (0, 0, math.pi / 2)), Box((2, 4, 6)))
ROD = Collision(Origin((0, 0, 5), (math.pi / 2, 0, 0)), Cylinder(1, 8))


def of(
    link: Link, **meshes: tuple[tuple[float, float, float], tuple[float, float, float]]
) -> Extent:
    return extents([link], meshes.get)[link.name]


def test_boxes_are_moved_and_turned_into_the_frame_of_the_link():
    extent = of(Link("l", (FLAT,), (ROD,)))
    assert extent.visual is not None
    assert extent.collision is not None
    np.testing.assert_allclose(extent.visual, [(-1, -1, -3), (3, 1, 3)], atol=1e-12)
    np.testing.assert_allclose(extent.collision, [(-1, -4, 4), (1, 4, 6)], atol=1e-12)
    assert extent.whole is not None
    np.testing.assert_allclose(extent.whole, [(-1, -4, -3), (3, 4, 6)], atol=1e-12)


def test_a_mirrored_mesh_has_its_least_corner_first():
    mesh = Visual(Origin(), Mesh("m", (-1, 1, 0.001)))
    extent = of(Link("l", (mesh,)), m=((0, 0, 0), (1, 2, 3)))
    assert extent.visual is not None
    np.testing.assert_allclose(extent.visual, [(-1, 0, 0), (0, 2, 0.003)])


def test_a_side_with_an_unknown_mesh_is_unknown_as_a_whole():
    extent = of(Link("l", (FLAT, Visual(Origin(), Mesh("m"))), (ROD,)))
    assert extent.visual is None
    assert extent.collision is not None
    assert extent.whole is not None
    np.testing.assert_array_equal(extent.whole, extent.collision)


def test_a_frame_has_no_extent():
    assert of(Link("l")).whole is None


@pytest.mark.parametrize(("side_m", "marks"), [(0.001, True), (0.01, True), (0.0101, False)])
def test_a_centimetre_is_a_marker(side_m: float, marks: bool):
    low, high = np.zeros(3), np.array([0.001, side_m, 0.001])
    assert is_marker((low, high)) is marks
