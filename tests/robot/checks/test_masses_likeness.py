from __future__ import annotations

import pytest

from studio.problems import Severity
from tests.support.checked import box, checked, codes, inertial, link, mended, problem_of, robot

MESH = '<visual><geometry><mesh filename="m.stl"/></geometry></visual>'


def body(mass_kg: float, moment: float, shape: str) -> str:
    return robot(link("base", inertial(mass_kg, moment, moment, moment), shape))


def about(urdf: str) -> list[str]:
    return [code for code in codes(urdf) if code in {"density", "inertia-size"}]


@pytest.mark.parametrize(
    ("mass_kg", "severity", "said"),
    [
        (21.0, Severity.WARNING, "heavier than any metal (2.1e+04 kg/m³)"),
        (0.0045, Severity.INFO, "lighter than foam (4.5 kg/m³)"),
    ],
)
def test_a_mass_that_does_not_fit_its_size_is_found(mass_kg: float, severity: Severity, said: str):
    one = body(mass_kg, mass_kg / 600, box("visual", "0.1 0.1 0.1"))
    problem = problem_of(checked(one), "density")
    assert problem.severity is severity
    assert said in problem.sentence


@pytest.mark.parametrize("mass_kg", [19.0, 1.0, 0.006])
def test_lead_wood_and_a_shell_are_left_alone(mass_kg: float):
    assert not about(body(mass_kg, mass_kg / 600, box("visual", "0.1 0.1 0.1")))


def test_a_sheet_has_some_thickness():
    assert not about(body(0.1, 0.0001, box("visual", "0.1 0.1 0")))


@pytest.mark.parametrize(
    ("moment", "said"),
    [(0.012, "more than its mass can have"), (1.6e-5, "less than a hundredth")],
)
def test_moments_of_another_size_are_found_and_mended(moment: float, said: str):
    one = body(1.0, moment, box("visual", "0.1 0.1 0.1"))
    problem = problem_of(checked(one), "inertia-size")
    assert said in problem.sentence
    after = mended(one, "inertia-size")
    assert 'ixx="0.00166667"' in after
    assert not about(after)


@pytest.mark.parametrize("moment", [0.0075, 1 / 600, 2e-5])
def test_moments_that_some_body_of_that_size_has_are_left_alone(moment: float):
    assert not about(body(1.0, moment, box("visual", "0.1 0.1 0.1")))


def test_a_centre_of_mass_far_out_allows_larger_moments():
    far = body(1.0, 0.1, box("visual", "0.1 0.1 0.1", xyz="1 0 0"))
    assert not about(far)


def test_what_only_marks_a_frame_says_nothing():
    assert not about(body(1.0, 1.0, box("visual", "0.01 0.01 0.01")))
    assert about(body(1.0, 1.0, box("visual", "0.011 0.01 0.01"))) == ["density"]


def test_a_mesh_counts_once_its_size_is_known():
    one = body(1.0, 100.0, MESH)
    assert not about(one)
    assert "inertia-size" in codes(one, {"m.stl": ((0, 0, 0), (0.1, 0.1, 0.1))})


def test_an_impossible_inertia_is_not_told_twice():
    seen = box("visual", "0.1 0.1 0.1")
    assert not about(body(1.0, -5.0, seen))
    assert about(body(1.0, 5.0, seen)) == ["inertia-size"]
    assert not about(body(1.0, 5.0, seen).replace('izz="5.0"', 'izz="11"'))
