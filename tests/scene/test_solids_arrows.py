from __future__ import annotations

import numpy as np
import pytest

from studio.displays.drawing import Arrows
from studio.scene.solids import arrows_of

RED = np.array([255, 0, 0], np.uint8)


def arrows(*tips: tuple[float, float, float], head_m: float = 0.3) -> Arrows:
    """From the origin."""
    ends = np.array([[(0, 0, 0), tip] for tip in tips], np.float32)
    return Arrows(ends, np.tile(RED, (len(tips), 1)), 0.1, 0.2, head_m)


def test_an_arrow_longer_than_its_head_is_one_of_visers():
    (name,) = (drawn := arrows_of(arrows((1, 0, 0), (0, 2, 0)), "1"))
    assert name == "arrows"
    assert drawn[name].flowing["points"].shape == (2, 2, 3)
    assert drawn[name].props["head_radius"] == pytest.approx(0.1)


def test_an_arrow_shorter_than_its_head_is_a_smaller_head_alone():
    drawn = arrows_of(arrows((1, 0, 0), (0.15, 0, 0)), "1")
    assert drawn["arrows"].flowing["points"].shape == (1, 2, 3)
    heads = drawn["many"].flowing
    np.testing.assert_allclose(heads["batched_scales"], [[0.1, 0.1, 0.15]], rtol=1e-6)
    np.testing.assert_allclose(heads["batched_positions"], [[0.15, 0, 0]], rtol=1e-6)


@pytest.mark.parametrize("tip", [(0, 0, 0.1), (0, 0, -0.1), (0.1, 0, 0), (0, -0.05, 0.02)])
def test_the_base_of_a_short_head_lies_at_the_tail(tip: tuple[float, float, float]):
    heads = arrows_of(arrows(tip), "1")["many"].flowing
    w, x, y, z = heads["batched_wxyzs"][0]
    length_m = heads["batched_scales"][0, 2]
    # Where the quaternion turns z to: the third column of its matrix.
    toward = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
    np.testing.assert_allclose(heads["batched_positions"][0] + length_m * toward, 0, atol=1e-6)


def test_an_arrow_without_length_is_not_drawn():
    assert arrows_of(arrows((0, 0, 0)), "1") == {}
    assert arrows_of(arrows((0, 0, 0), head_m=0.0), "1") == {}
    assert arrows_of(arrows((float("nan"), 0, 0), (float("inf"), 0, 0)), "1") == {}
