from __future__ import annotations

import numpy as np
import pytest

from studio.displays.tf import shades_of


@pytest.mark.parametrize(
    ("age_s", "grey", "opacity"),
    [
        (0.0, 0.0, 1.0),
        (5.0, 0.0, 1.0),
        (7.5, 0.5, 1.0),
        (10.0, 1.0, 1.0),
        (12.5, 1.0, 0.5),
        (15.0, 1.0, 0.0),
        (1e9, 1.0, 0.0),
    ],
)
def test_a_frame_fades_by_thirds_of_its_timeout(age_s: float, grey: float, opacity: float):
    shades = shades_of(np.array([age_s]), 15.0)
    assert (shades.grey.tolist(), shades.opacity.tolist()) == ([grey], [opacity])
    assert shades.fresh.tolist() == [grey == 0.0]


def test_fading_goes_in_few_steps():
    shades = shades_of(np.linspace(0.0, 15.0, 5000), 15.0)
    assert len(np.unique(shades.grey)) == len(np.unique(shades.opacity)) == 33
