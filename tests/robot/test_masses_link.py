from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.robot.masses import LinkMass, link_mass, principal_moments
from studio.robot.rotations import matrix_from_rpy
from studio.robot.values import Inertial, Link, Origin, Vector3

angles = st.floats(-3, 3)
moments = st.floats(0.01, 9)


def test_a_link_without_an_inertial_weighs_nothing_that_could_be_said():
    assert link_mass(Link("l")) is None


def test_what_is_written_stays_as_written_even_when_no_body_has_it():
    inertial = Inertial(Origin((1, 2, 3), (0.5, 0, 0)), -1.5, ixx=0.3, iyy=0.1, izz=-0.2)
    found = link_mass(Link("l", inertial=inertial))
    assert found == LinkMass(-1.5, (1, 2, 3), (0.3, 0, 0, 0.1, 0, -0.2), (-0.2, 0.1, 0.3))


@given(st.tuples(moments, moments, moments), st.tuples(angles, angles, angles))
def test_the_principal_moments_are_those_however_the_axes_are_turned(own: Vector3, rpy: Vector3):
    turn = matrix_from_rpy(np.array(rpy))
    tensor = turn @ np.diag(own) @ turn.T
    (ixx, ixy, ixz), (_, iyy, iyz), (_, _, izz) = tensor.tolist()
    found = principal_moments(Inertial(Origin(), 1, ixx, ixy, ixz, iyy, iyz, izz))
    assert found == pytest.approx(sorted(own), rel=1e-9, abs=1e-12)


def test_numbers_too_large_to_turn_give_no_moments_and_no_warning():
    large = Inertial(Origin(), 1, 1e308, 1e308, 1e308, 1e308, 1e308, 1e308)
    found = principal_moments(large)
    assert found is None or np.isfinite(found).all()
