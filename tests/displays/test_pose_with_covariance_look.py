from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.displays.drawing import Solids
from studio.displays.pose_with_covariance import (
    COVARIANCE_PROPERTIES,
    covariance_shapes,
    is_covariance,
    spread_of,
)
from studio.displays.poses import Poses
from studio.displays.turning import Floats, turned

VALUES = {one.name: one.default for one in COVARIANCE_PROPERTIES}
QUARTER_ABOUT_Z = np.array([[math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]])
HERE = Poses(np.array([[1.0, 2.0, 3.0]]), QUARTER_ABOUT_Z)


def shapes(covariance: Floats, **values: Any) -> dict[str, Solids]:  # noqa: ANN401
    spread = spread_of(HERE, covariance.reshape(-1))
    assert spread is not None
    said = {name.replace("_", " "): value for name, value in values.items()}
    made = covariance_shapes(spread, VALUES | said)
    return {name: shape for name, shape in made.items() if isinstance(shape, Solids)}


def with_values(covariance: Floats, values: dict[str, Any]) -> dict[str, Solids]:
    spread = spread_of(HERE, covariance.reshape(-1))
    assert spread is not None
    made = covariance_shapes(spread, VALUES | values)
    return {name: shape for name, shape in made.items() if isinstance(shape, Solids)}


def axis(solids: Solids, which: int, of: int = 0) -> Floats:
    """Where an axis of a solid points."""
    wxyz = solids.wxyz[of : of + 1].astype(np.float64)
    return turned(wxyz, np.eye(3)[which])[0]


def test_an_ellipsoid_measures_two_deviations_along_the_axes_of_the_frame():
    solid = shapes(np.diag([0.04, 0.09, 0.16, 0.01, 0.01, 0.01]))["position"]
    assert (solid.kind, solid.opacities, solid.colors.tolist()) == ("sphere", 0.3, [204, 51, 204])
    np.testing.assert_allclose(solid.positions, [[1.0, 2.0, 3.0]])
    # The pose is turned, and the ellipsoid is not: its axes are those of the frame.
    np.testing.assert_allclose(solid.scales, [[0.4, 0.6, 0.8]], rtol=1e-5)
    np.testing.assert_allclose(
        np.abs([axis(solid, which) for which in range(3)]), np.eye(3), atol=1e-6
    )


def test_an_ellipsoid_is_turned_as_its_numbers_belong_together():
    covariance = np.diag([0.0, 0.0, 0.01, 0.01, 0.01, 0.01])
    covariance[:2, :2] = [[0.5, 0.5], [0.5, 0.5]]
    solid = shapes(covariance)["position"]
    longest = int(np.argmax(solid.scales[0]))
    assert solid.scales[0, longest] == pytest.approx(2.0)
    np.testing.assert_allclose(
        np.abs(axis(solid, longest)), [math.sqrt(0.5), math.sqrt(0.5), 0.0], atol=1e-6
    )


def test_discs_lie_across_the_tips_of_the_axes_of_the_pose():
    solid = shapes(np.diag([0, 0, 0, 0.01, 0.04, 0.09]))["orientation"]
    assert (solid.kind, solid.opacities) == ("cylinder", 0.5)
    # The pose is turned by a quarter about z: its x is the y of the frame.
    np.testing.assert_allclose(
        solid.positions, [[1.0, 3.0, 3.0], [0.0, 2.0, 3.0], [1.0, 2.0, 4.0]], atol=1e-6
    )
    for of, normal in enumerate(([0, 1, 0], [-1, 0, 0], [0, 0, 1])):
        np.testing.assert_allclose(axis(solid, 2, of), normal, atol=1e-6)
    np.testing.assert_allclose(solid.scales[:, 2], 0.001, rtol=1e-5)


@pytest.mark.parametrize(
    ("of", "tip_along", "deviation_rad"),
    [(0, 1, 0.3), (0, 2, 0.2), (1, 0, 0.3), (1, 2, 0.1), (2, 0, 0.2), (2, 1, 0.1)],
)
def test_a_disc_is_as_wide_as_its_tip_moves(of: int, tip_along: int, deviation_rad: float):
    """Yaw moves the tip of x along y, pitch along z, and so on: the cross product."""
    flat = Poses(np.zeros((1, 3)), np.array([[1.0, 0.0, 0.0, 0.0]]))
    spread = spread_of(flat, np.diag([0, 0, 0, 0.01, 0.04, 0.09]).reshape(-1))
    assert spread is not None
    solid = covariance_shapes(spread, VALUES)["orientation"]
    assert isinstance(solid, Solids)
    widths = [solid.scales[of, which] * abs(axis(solid, which, of)[tip_along]) for which in (0, 1)]
    assert max(widths) == pytest.approx(2 * math.tan(deviation_rad), rel=1e-4)


def test_discs_of_the_fixed_frame_lie_on_its_axes():
    solid = with_values(
        np.diag([0, 0, 0, 0.01, 0.01, 0.01]), {"Covariance/Orientation/Frame": "Fixed"}
    )["orientation"]
    np.testing.assert_allclose(
        solid.positions, [[2.0, 2.0, 3.0], [1.0, 3.0, 3.0], [1.0, 2.0, 4.0]], atol=1e-6
    )


def test_a_pose_in_a_plane_has_a_flat_ellipse_and_a_wedge_for_its_yaw():
    covariance = np.diag([0.04, 0.09, 0, 0, 0, 0.01])
    drawn = shapes(covariance)
    np.testing.assert_allclose(drawn["position"].scales, [[0.4, 0.6, 0.001]], rtol=1e-5)
    wedge = drawn["orientation"]
    assert wedge.kind == "cone"
    np.testing.assert_allclose(wedge.positions, [[1.0, 2.0, 3.0]])
    np.testing.assert_allclose(wedge.scales, [[0.001, 2 * math.tan(0.1), 1.0]], rtol=1e-5)
    # It opens along the x of the pose, which is the y of the frame, and lies flat.
    np.testing.assert_allclose(axis(wedge, 2), [0, 1, 0], atol=1e-6)
    np.testing.assert_allclose(np.abs(axis(wedge, 0)), [0, 0, 1], atol=1e-6)


@pytest.mark.parametrize(
    ("name", "value", "what", "seen"),
    [
        ("Covariance/Position/Scale", 3.0, "position", [[1.2, 1.8, 2.4]]),
        ("Covariance/Orientation/Offset", 2.0, "orientation", None),
    ],
)
def test_scales_and_offsets_change_what_is_drawn(
    name: str, value: float, what: str, seen: list[list[float]] | None
):
    covariance = np.diag([0.04, 0.09, 0.16, 0.01, 0.01, 0.01])
    before, after = with_values(covariance, {})[what], with_values(covariance, {name: value})[what]
    if seen is not None:
        np.testing.assert_allclose(after.scales, seen, rtol=1e-5)
    else:
        np.testing.assert_allclose(after.scales[:, :2], 2.0 * before.scales[:, :2], rtol=1e-5)
        from_pose = before.positions - HERE.xyz
        np.testing.assert_allclose(after.positions - HERE.xyz, 2.0 * from_pose, atol=1e-6)


def test_a_spread_is_never_wider_than_a_turn_can_be():
    covariance = np.diag([0, 0, 0, 1e6, 1e6, 1e6])
    solid = with_values(covariance, {"Covariance/Orientation/Scale": 1000.0})["orientation"]
    assert solid.scales.max() == pytest.approx(2 * math.tan(math.radians(89)), rel=1e-4)


def test_colours_are_one_or_those_of_the_axes():
    covariance = np.diag([0, 0, 0, 0.01, 0.01, 0.01])
    assert shapes(covariance)["orientation"].colors.tolist() == [[255, 255, 127]] * 3
    colours = with_values(covariance, {"Covariance/Orientation/Color Style": "RGB"})
    assert colours["orientation"].colors.tolist() == [[255, 0, 0], [0, 255, 0], [0, 0, 255]]
    flat = np.diag([0, 0, 0, 0, 0, 0.01])
    wedge = with_values(flat, {"Covariance/Orientation/Color Style": "RGB"})["orientation"]
    assert wedge.colors.tolist() == [[0, 0, 255]]


@pytest.mark.parametrize(
    ("values", "left"),
    [
        ({"Covariance": False}, set[str]()),
        ({"Covariance/Position": False}, {"orientation"}),
        ({"Covariance/Orientation": False}, {"position"}),
        ({"Covariance/Orientation/Offset": 0.0}, {"position"}),
        ({"Covariance/Position/Scale": 0.0}, {"orientation"}),
    ],
)
def test_each_part_can_be_switched_off(values: dict[str, Any], left: set[str]):
    assert set(with_values(np.eye(6), values)) == left


def test_what_is_sure_is_not_drawn():
    assert shapes(np.zeros((6, 6))) == {}
    assert set(shapes(np.diag([0.0, 0.0, 0.0, 0.1, 0.0, 0.0]))) == {"orientation"}
    assert set(shapes(np.diag([0.1, 0.0, 0.0, 0.0, 0.0, 0.0]))) == {"position"}


@pytest.mark.parametrize(
    ("diagonal", "sound"),
    [
        ([1, 1, 1, 1, 1, 1], True),
        ([-1, 1, 1, 1, 1, 1], False),
        ([1, 1, 1, 1, 1, -1], False),
        ([1, 1, -1, -1, -1, 1], True),
        ([1, 1, -1e-20, 1, 1, 1], True),
        ([0, 0, 0, 0, 0, 0], True),
    ],
)
def test_a_variance_below_zero_is_noticed_where_it_would_be_drawn(
    diagonal: list[float], sound: bool
):
    spread = spread_of(HERE, np.diag(diagonal).astype(np.float64).reshape(-1))
    assert spread is not None
    assert is_covariance(spread) is sound


def test_what_is_no_covariance_is_not_drawn():
    drawn = shapes(np.diag([-1.0, 1, 1, 0.1, 0.1, 0.1]))
    assert set(drawn) == {"orientation"}


@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf, 1e308])
def test_numbers_that_cannot_be_drawn_are_none(number: float):
    assert spread_of(HERE, np.full(36, number)) is None


@settings(max_examples=200, deadline=None)
@given(st.lists(st.floats(-1e24, 1e24), min_size=36, max_size=36))
def test_any_numbers_make_solids_of_finite_numbers(numbers: list[float]):
    for solid in shapes(np.array(numbers)).values():
        for array in (solid.positions, solid.wxyz, solid.scales):
            assert array.dtype == np.float32
            assert np.isfinite(array).all()
        np.testing.assert_allclose(np.linalg.norm(solid.wxyz, axis=1), 1.0, atol=1e-5)
