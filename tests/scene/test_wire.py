from __future__ import annotations

import pytest
from viser._messages import SetOrientationMessage, SetPositionMessage

from studio.scene.wire import Encoder
from tests.support.viser_frames import messages_of

TURNED = (0.267261241912424, 0.534522483824849, 0.801783725737273, 0.0)


@pytest.mark.parametrize(
    ("position_m", "error_m"),
    [
        ((0.1, -99.9, 1e-9), 4e-6),
        ((500_000.123456, 5_000_000.123456, 0.1), 0.0),
        ((0.0, float("inf"), 0.0), 0.0),
    ],
    ids=["near", "far", "nowhere"],
)
def test_a_pose_takes_half_the_bytes_near_the_origin_and_is_exact_far_away(
    position_m: tuple[float, float, float], error_m: float
):
    sent = [SetPositionMessage("/a", position_m), SetOrientationMessage("/a", TURNED)]
    moved, turned = messages_of(Encoder().frame(sent))
    assert moved["position"] == pytest.approx(position_m, abs=error_m, rel=0)
    assert turned["wxyz"] == pytest.approx(TURNED, abs=6e-8, rel=0)
