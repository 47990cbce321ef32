from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.robot.checks.extents import extents
from studio.robot.checks.masses import inertia_mend, tensors
from studio.robot.values import (
    Box,
    Collision,
    Cylinder,
    Geometry,
    Inertial,
    Link,
    Mesh,
    Origin,
    Sphere,
    Vector3,
    Visual,
)

sides = st.floats(0.01, 3)
angles = st.floats(-3, 3)


def written(link: Link) -> dict[str, float]:
    """The numbers that the fix of a link writes."""
    mend = inertia_mend(link, extents([link], {"m": ((0, 0, 0), (1, 2, 3))}.get)[link.name])
    assert mend is not None
    assert mend.is_for_one
    return {name: float(text) for name, text in mend.texts}


def solid(geometry: Geometry, rpy: Vector3 = (0, 0, 0), own_rpy: Vector3 = (0, 0, 0)) -> Link:
    shape = Collision(Origin((1, 1, 1), rpy), geometry)
    return Link("l", collisions=(shape,), inertial=Inertial(Origin(rpy=own_rpy), 12.0))


@pytest.mark.parametrize(
    ("geometry", "moments"),
    [
        (Box((1, 2, 3)), (13, 10, 5)),
        (Cylinder(1, 3), (12, 12, 6)),
        (Sphere(1), (4.8, 4.8, 4.8)),
        (Mesh("m"), (13, 10, 5)),
    ],
)
def test_a_solid_has_the_moments_of_the_textbook(geometry: Geometry, moments: Vector3):
    found = written(solid(geometry))
    assert (found["ixx"], found["iyy"], found["izz"]) == pytest.approx(moments)
    assert (found["ixy"], found["ixz"], found["iyz"]) == (0, 0, 0)


def test_a_turned_shape_turns_its_moments():
    found = written(solid(Box((1, 2, 3)), rpy=(0, 0, math.pi / 2)))
    assert (found["ixx"], found["iyy"], found["izz"]) == pytest.approx((10, 13, 5))


def test_axes_that_are_turned_alike_see_the_shape_straight():
    found = written(solid(Box((1, 2, 3)), rpy=(0.3, -1, 2), own_rpy=(0.3, -1, 2)))
    assert (found["ixx"], found["iyy"], found["izz"]) == pytest.approx((13, 10, 5))


@settings(deadline=None)  # of a loaded machine
@given(st.tuples(sides, sides, sides), st.tuples(angles, angles, angles))
def test_what_is_written_is_always_the_inertia_of_a_body(size: Vector3, rpy: Vector3):
    link = solid(Box(size), rpy=rpy)
    assert link.inertial is not None
    (tensor,) = tensors([replace(link.inertial, **written(link))])
    least, middle, most = np.linalg.eigvalsh(tensor)
    assert least > 0
    assert most <= (least + middle) * (1 + 1e-4)


def test_several_shapes_count_as_the_box_around_them():
    two = tuple(Visual(Origin((0, 0, z)), Sphere(0.5)) for z in (-1, 1))
    link = Link("l", two, inertial=Inertial(Origin(), 12.0))
    found = written(link)
    assert (found["ixx"], found["izz"]) == pytest.approx((10, 2))


@pytest.mark.parametrize(
    "link",
    [
        Link("l"),
        Link("l", inertial=Inertial(Origin(), 1.0)),
        replace(solid(Box((1, 1, 1))), inertial=Inertial(Origin(), 0.0)),
        solid(Mesh("of unknown size")),
        solid(Sphere(0)),
    ],
)
def test_without_mass_or_known_shape_nothing_is_offered(link: Link):
    assert inertia_mend(link, extents([link], lambda _: None)["l"]) is None
