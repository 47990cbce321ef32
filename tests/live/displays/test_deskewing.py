"""Points of a turning lidar, against one beam after the other as laser_geometry computes them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from studio.displays.drawing import Lines, Placed, Points, Pose, Sweep
from studio.displays.laser_scan import LaserScanDisplay
from studio.live.displays.deskewing import Deskewing, deskewed_points
from studio.live.displays.placing import Placing
from studio.tf.buffer import TransformBuffer
from studio.tf.rotations import compose, inverse
from tests.support.display_messages import NOW_NS, TYPES, received
from tests.support.transforms import S, Told, about_z, columns, matrix_of, slerp

if TYPE_CHECKING:
    from numpy.typing import NDArray

Quaternion = tuple[float, float, float, float]
SCAN = "sensor_msgs/msg/LaserScan"
WHITE = np.full(3, 255, np.uint8)
STILL: Pose = ((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


def beam_by_beam(points: Any, shares: Any, begin: Pose, end: Pose) -> NDArray[np.float64]:  # noqa: ANN401
    """Where each point is in the fixed frame: its own pose of the sensor, times the point."""
    placed = np.empty((len(points), 3))
    for number, (point, share) in enumerate(zip(points, shares, strict=True)):
        at = [one + share * (other - one) for one, other in zip(begin[1], end[1], strict=True)]
        matrix = np.array(matrix_of((*slerp(begin[0], end[0], share), *at)))
        placed[number] = (matrix @ [*point, 1.0])[:3]
    return placed


def in_fixed(points: Any, pose: Pose | None) -> NDArray[np.float64]:  # noqa: ANN401
    assert pose is not None
    matrix = np.array(matrix_of((*pose[0], *pose[1])))
    return np.asarray(points, np.float64) @ matrix[:3, :3].T + matrix[:3, 3]


def unit(parts: list[float]) -> Quaternion:
    length = math.hypot(*parts)
    w, x, y, z = (part / length for part in parts)
    return w, x, y, z


TURNS = (
    st.lists(st.floats(-1, 1), min_size=4, max_size=4)
    .filter(lambda parts: math.hypot(*parts) > 0.1)
    .map(unit)
)
PLACES = st.tuples(*[st.floats(-5, 5)] * 3)
POSES = st.tuples(TURNS, PLACES)


@given(POSES, POSES)
def test_each_point_is_where_its_own_beam_met_it(begin: Pose, end: Pose):
    angles = np.linspace(-2.0, 2.0, 9)
    points = np.stack([3 * np.cos(angles), 3 * np.sin(angles), 0 * angles], axis=1)
    shares = np.linspace(0.0, 1.0, 9)
    motion = compose(inverse((*begin[0], *begin[1])), (*end[0], *end[1]))
    if abs(motion[0]) < 1e-3:
        return  # half a turn has two shortest ways
    carried = deskewed_points(points.astype(np.float32), shares.astype(np.float32), motion)
    wanted = beam_by_beam(points, shares, begin, end)
    assert_allclose(in_fixed(carried, begin), wanted, atol=1e-5)


def scan_at(stamp_ns: int, count: int, took_s: float, radius_m: float = 4.0) -> Any:  # noqa: ANN401
    """A lidar that turns once; every beam comes back from the same distance."""
    stamp = {"sec": stamp_ns // S, "nanosec": stamp_ns % S}
    return received(
        SCAN,
        {
            "header": {"frame_id": "laser", "stamp": stamp},
            "angle_min": -math.pi,
            "angle_increment": 2 * math.pi / count,
            "time_increment": took_s / (count - 1),
            "range_min": 0.1,
            "range_max": 30.0,
            "ranges": [radius_m] * count,
        },
    )


def driving_robot() -> TransformBuffer:
    """It drives a curve with a lidar in front: 2 m/s, and 1.5 rad/s."""
    buffer = TransformBuffer()
    buffer.put(columns(Told("base", "laser", 0, (0.4, 0.1, 0.3))), static=True)
    for step in range(41):
        at_s = step / 20
        place = (2.0 * at_s, 0.3 * at_s, 0.0)
        buffer.put(columns(Told("odom", "base", S + step * S // 20, place, about_z(1.5 * at_s))))
    return buffer


def test_a_scan_of_a_driving_robot_lies_where_laser_geometry_puts_it():
    buffer, placing, display = driving_robot(), Placing(), LaserScanDisplay(TYPES)
    begin_ns, count, took_s = S + 300_000_000, 360, 0.1

    def lookup(frame: str, stamp_ns: int) -> Pose:
        pose = buffer.fixed_from("odom", frame, stamp_ns)
        return pose.wxyz, pose.xyz

    display.take(scan_at(begin_ns, count, took_s))
    placing.offer(display.draw(NOW_NS), NOW_NS)
    shown = placing.step(lookup, NOW_NS)
    assert shown is not None
    shape, pose = shown.drawing["0"].shapes["points"], shown.poses["0"]
    assert isinstance(shape, Points)
    begin, end = lookup("laser", begin_ns), lookup("laser", begin_ns + round(took_s * S))
    assert pose == begin
    angles = -math.pi + 2 * math.pi / count * np.arange(count)
    beams = np.stack([4 * np.cos(angles), 4 * np.sin(angles), 0 * angles], axis=1)
    wanted = beam_by_beam(beams, np.arange(count) / (count - 1), begin, end)
    assert_allclose(in_fixed(shape.positions, begin), wanted, atol=2e-5)
    # As if all had been met at once, the last beam would be off by what the robot moved meanwhile.
    off_m = np.linalg.norm(in_fixed(beams, begin) - wanted, axis=1)
    assert off_m[0] < 1e-5
    assert off_m[-1] > 0.3


def test_it_waits_for_the_transform_of_its_last_beam():
    placing, display = Placing(), LaserScanDisplay(TYPES)
    buffer = TransformBuffer()

    def lookup(frame: str, stamp_ns: int) -> Pose:
        pose = buffer.fixed_from("odom", frame, stamp_ns)
        return pose.wxyz, pose.xyz

    buffer.put(columns(Told("odom", "laser", 10 * S)))
    display.take(scan_at(10 * S, 36, 0.1))
    placing.offer(display.draw(NOW_NS), NOW_NS)
    assert placing.step(lookup, NOW_NS) is None
    buffer.put(columns(Told("odom", "laser", 10 * S + S // 10, (1.0, 0.0, 0.0))))
    shown = placing.step(lookup, NOW_NS)
    assert shown is not None
    shape = shown.drawing["0"].shapes["points"]
    assert isinstance(shape, Points)
    assert_allclose(shape.positions[-1, 0] - shape.positions[0, 0], 1.0, atol=0.1)


def group(count: int = 3, *, until_ns: int = 20) -> Placed:
    points = Points(np.ones((count, 3), np.float32), WHITE)
    lines = Lines(np.ones((1, 2, 3), np.float32), WHITE)
    sweep = Sweep(until_ns, np.linspace(0, 1, count, dtype=np.float32))
    return Placed("laser", 10, {"points": points, "lines": lines}, sweep=sweep)


def test_what_stood_still_is_the_very_same_drawing():
    drawing = {"0": group()}
    assert Deskewing().deskewed(drawing, {"0": STILL}, {"0": STILL}) is drawing
    assert Deskewing().deskewed(drawing, {"0": None}, {}) is drawing


def test_what_was_carried_before_is_not_carried_again():
    carrying, moved = Deskewing(), (STILL[0], (0.5, 0.0, 0.0))
    first = group()
    once = carrying.deskewed({"0": first}, {"0": STILL}, {"0": moved})
    assert once["0"].shapes["lines"] is first.shapes["lines"]
    again = carrying.deskewed(
        {"0": first, "1": group()}, {"0": STILL, "1": STILL}, {"0": moved, "1": moved}
    )
    assert again["0"] is once["0"]
    assert again["1"] is not once["0"]
