import math
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from studio.displays.display import Limits, Received, Status
from studio.displays.drawing import Points
from studio.displays.laser_scan import LaserScanDisplay
from studio.errors import DisplayMessageError
from tests.support.display_messages import NOW_NS, STAMP_NS, TYPES, received

SCAN = "sensor_msgs/msg/LaserScan"
NAN, INF = math.nan, math.inf
QUARTERS = {"angle_min": -math.pi / 2, "angle_increment": math.pi / 2}


def scan(ranges: Any, *, little: bool = True, **fields: Any) -> Received:  # noqa: ANN401
    """A scan whose beams go to the right, ahead, to the left and back."""
    limits = {"range_min": 0.5, "range_max": 10.0}
    return received(SCAN, {**QUARTERS, **limits, "ranges": ranges, **fields}, little=little)


def drawn(display: LaserScanDisplay) -> Points:
    (placed,) = display.draw(NOW_NS).values()
    shape = placed.shapes["points"]
    assert isinstance(shape, Points)
    return shape


@pytest.mark.parametrize("little", [True, False])
def test_each_return_lies_at_its_range_along_its_beam(little: bool):
    display = LaserScanDisplay(TYPES)
    display.take(scan([1.0, 2.0, 3.0, 4.0], intensities=[0.0, 1.0, 2.0, 4.0], little=little))
    placed = display.draw(NOW_NS)["0"]
    assert (placed.frame, placed.stamp_ns, placed.follows) == ("map", STAMP_NS, False)
    shape = drawn(display)
    assert_allclose(shape.positions, [[0, -1, 0], [2, 0, 0], [0, 3, 0], [-4, 0, 0]], atol=1e-6)
    assert shape.positions.dtype == np.float32
    assert_array_equal(shape.colors[[0, 3]], [[255, 0, 0], [255, 0, 255]])
    assert display.statuses() == ()


def test_the_least_range_counts_and_the_greatest_does_not():
    ranges = [0.5, 0.4999, 10.0, 9.999, NAN, INF, -INF, -1.0, 0.0]
    display = LaserScanDisplay(TYPES, {"Color Transformer": "Intensity", "Channel Name": "index"})
    display.take(scan(ranges))
    shape = drawn(display)
    assert_allclose(np.linalg.norm(shape.positions, axis=1), [0.5, 9.999], rtol=1e-6)
    assert_array_equal(shape.colors, [[255, 0, 0], [255, 0, 255]])


def test_a_scan_without_intensities_is_of_one_colour():
    display = LaserScanDisplay(TYPES)
    display.take(scan([1.0, 2.0]))
    assert_array_equal(drawn(display).colors, [[255, 0, 0]] * 2)
    display.set("Color Transformer", "Intensity")
    display.draw(NOW_NS)
    (status,) = display.statuses()
    assert status.sentence == 'The messages have no field "intensity": they have range, index.'
    display.set(*(status.mend or ("", "")))
    assert_array_equal(drawn(display).colors, [[255, 0, 0], [255, 0, 255]])
    assert display.statuses() == ()


def test_intensities_of_another_number_than_ranges_are_none():
    display = LaserScanDisplay(TYPES)
    display.take(scan([1.0, 2.0], intensities=[1.0]))
    assert_array_equal(drawn(display).colors, [[255, 0, 0]] * 2)


@pytest.mark.parametrize(
    ("ranges", "reason", "sentence"),
    [
        ([], "no_points", "The scan has no ranges."),
        ([NAN] * 3, "not_finite", "All 3 ranges are NaN."),
        ([0.1, 20.0], "out_of_range",
         "All 2 ranges are outside of 0.5 to 10 m, as the scan itself names them."),
        ([NAN, INF, INF], "out_of_range",
         "All 3 ranges are outside of 0.5 to 10 m, as the scan itself names them, 2 of them "
         "infinite: nothing came back."),
    ],
)  # fmt: skip
def test_a_scan_that_shows_nothing_says_why(ranges: list[float], reason: Any, sentence: str):  # noqa: ANN401
    display = LaserScanDisplay(TYPES)
    display.take(scan(ranges))
    assert display.draw(NOW_NS) == {}
    assert display.statuses() == (Status("warn", reason, sentence),)


@pytest.mark.parametrize("field", ["angle_min", "angle_increment"])
@pytest.mark.parametrize("value", [NAN, INF])
def test_angles_that_are_no_numbers_are_refused(field: str, value: float):
    wrong: dict[str, Any] = {field: value}
    with pytest.raises(DisplayMessageError, match=r"its angle_min or angle_increment is no number"):
        LaserScanDisplay(TYPES).take(scan([1.0], **wrong))


def test_more_beams_than_a_lidar_has_are_refused():
    with pytest.raises(DisplayMessageError, match=r"4,000,001 ranges, at most 4,000,000"):
        LaserScanDisplay(TYPES).take(scan(np.ones(4_000_001, dtype=np.float32)))


def test_limits_of_a_scan_that_are_no_numbers_show_nothing():
    display = LaserScanDisplay(TYPES)
    display.take(scan([1.0], range_max=NAN))
    assert display.statuses()[0].reason == "out_of_range"


def test_ranges_that_are_infinite_are_left_out_whatever_the_limits_of_the_scan():
    display = LaserScanDisplay(TYPES)
    display.take(scan([-INF, 2.0, INF], range_min=-INF, range_max=INF))
    assert_array_equal(drawn(display).positions[:, :2].round(3).shape, (1, 2))
    display.take(scan([-INF, -INF], range_min=-INF, range_max=INF))
    assert display.statuses()[0].reason == "out_of_range"


def test_too_many_returns_are_thinned():
    display = LaserScanDisplay(TYPES)
    display.limit(Limits(points=100))
    display.take(scan(np.ones(1000, dtype=np.float32)))
    assert len(drawn(display).positions) == 100
    assert display.statuses()[0].sentence == "Showing 100 of 1,000 points."


@pytest.mark.parametrize(
    ("fields", "until_ns"),
    [
        ({"time_increment": 0.01}, STAMP_NS + 30_000_000),
        ({"time_increment": -0.01}, STAMP_NS - 30_000_000),
        ({"time_increment": 0.0}, None),
        ({"time_increment": NAN}, None),
        ({"time_increment": INF}, None),
        ({"time_increment": 1e6}, None),
        ({"time_increment": 0.01, "header": {"frame_id": "map"}}, None),
    ],
)
def test_beams_that_were_sent_one_after_the_other_say_when(
    fields: dict[str, Any], until_ns: int | None
):
    display = LaserScanDisplay(TYPES)
    display.take(scan([1.0, NAN, 3.0, 4.0], **fields))
    sweep = display.draw(NOW_NS)["0"].sweep
    assert (sweep is None) is (until_ns is None)
    if sweep:
        assert sweep.until_ns == pytest.approx(until_ns, abs=10)
        assert_allclose(sweep.shares, [0, 2 / 3, 1], rtol=1e-6)


def test_a_scan_of_one_beam_takes_no_time():
    display = LaserScanDisplay(TYPES)
    display.take(scan([1.0], time_increment=0.01))
    assert display.draw(NOW_NS)["0"].sweep is None
