import math
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from studio.displays.pinhole import Pinhole, distorted, distortion_px, pinhole_of

K = [500.0, 0, 320, 0, 510, 240, 0, 0, 1]
P = [400.0, 0, 300, -40, 0, 410, 230, 82, 0, 0, 1, 0]
BARREL = [-0.3, 0.1, 0.001, -0.002, 0.0]


def info(roi: dict[str, int] | None = None, **fields: object) -> SimpleNamespace:
    region = {"x_offset": 0, "y_offset": 0, "width": 0, "height": 0} | (roi or {})
    made = {"k": K, "p": P, "d": [], "width": 640, "height": 480, "distortion_model": "plumb_bob"}
    return SimpleNamespace(**{**made, **fields}, roi=SimpleNamespace(**region))


def test_the_matrix_that_is_asked_for_comes_first():
    assert pinhole_of(info(), (640, 480), "k") == Pinhole(500, 510, 320, 240)
    assert pinhole_of(info(), (640, 480), "p") == Pinhole(400, 410, 300, 230, 0.1, -0.2)


def test_the_other_matrix_counts_where_one_has_no_focal_length():
    assert pinhole_of(info(p=[0.0] * 12), (640, 480), "p") == Pinhole(500, 510, 320, 240)


@pytest.mark.parametrize("value", [0.0, math.nan, math.inf, -3.0])
def test_a_calibration_without_a_focal_length_is_none(value: float):
    k, p = [value, *K[1:]], [value, *P[1:]]
    assert pinhole_of(info(k=k, p=p), (640, 480), "k") is None


def test_a_binned_picture_has_a_binned_pinhole():
    assert pinhole_of(info(), (320, 240), "k") == Pinhole(250, 255, 160, 120)


def test_a_region_of_interest_moves_the_principal_point():
    roi = {"x_offset": 100, "y_offset": 50, "width": 320, "height": 240}
    assert pinhole_of(info(roi=roi), (320, 240), "k") == Pinhole(500, 510, 220, 190)
    assert pinhole_of(info(roi=roi), (160, 120), "k") == Pinhole(250, 255, 110, 95)


def test_a_pinhole_is_the_projection_of_opencvs_formula():
    """u = P (X + t): the eye of a stereo pair's right camera is beside the frame."""
    pinhole = pinhole_of(info(), (640, 480), "p")
    assert pinhole is not None
    place = np.array([0.3, -0.2, 2.0])
    u, v, w = np.array(P).reshape(3, 4) @ np.append(place, 1.0)
    x, y = place[0] - pinhole.x_m, place[1] - pinhole.y_m
    ours = (pinhole.fx * x / 2.0 + pinhole.cx, pinhole.fy * y / 2.0 + pinhole.cy)
    assert_allclose(ours, (u / w, v / w))


def test_what_a_lens_does_is_opencvs_formula():
    x, y = np.array([0.4]), np.array([-0.3])
    k1, k2, p1, p2, k3 = d = np.array([-0.2, 0.05, 0.01, -0.02, 0.003])
    r2 = 0.25
    radial = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
    there = distorted(x, y, d)
    assert_allclose(there[0], 0.4 * radial + 2 * p1 * 0.4 * -0.3 + p2 * (r2 + 2 * 0.16))
    assert_allclose(there[1], -0.3 * radial + p1 * (r2 + 2 * 0.09) + 2 * p2 * 0.4 * -0.3)


def test_how_far_the_lens_moves_the_edge_is_told():
    found = distortion_px(info(d=BARREL), (640, 480))
    assert found is not None
    assert found > 20
    half = distortion_px(info(d=BARREL), (320, 240))
    assert half == pytest.approx(found / 2)


def test_no_distortion_and_one_that_is_not_computed_are_not_the_same():
    assert distortion_px(info(d=[0.0] * 5), (640, 480)) == 0.0
    assert distortion_px(info(d=BARREL, distortion_model="equidistant"), (640, 480)) is None
    assert distortion_px(info(d=[math.nan]), (640, 480)) is None
