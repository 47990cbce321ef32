from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.tf.buffer import TransformBuffer
from tests.support.transforms import HandClock, S, Told, columns

if TYPE_CHECKING:
    from studio.tf.report import FrameReport

MS = S // 1000


class Robot:
    """Feeds a buffer by a clock that goes by hand: publishers come and go."""

    def __init__(self) -> None:
        self.clock = HandClock()
        self.buffer = TransformBuffer(clock=self.clock)
        self.buffer.put(columns(Told("base", "laser")), static=True, publisher="state")

    def run(self, until_s: float, **hz: float) -> None:
        """Let publishers, named after their frames, tell of them so often for so long."""
        due = dict.fromkeys(hz, 0.0)
        for _ in range(round(until_s * 1000)):
            for frame, next_ms in due.items():
                if next_ms <= 0:
                    self.tell(frame)
                    due[frame] += 1000 / hz[frame]
                due[frame] -= 1
            self.clock.now_ns += MS

    def tell(self, frame: str, publisher: str | None = None) -> None:
        parent = {"odom": "map", "base": "odom"}.get(frame, "base")
        told = columns(Told(parent, frame, self.clock.now_ns))
        self.buffer.put(told, publisher=frame if publisher is None else publisher)

    def report(self, fixed: str = "") -> dict[str, FrameReport]:
        return {one.frame: one for one in self.buffer.report(fixed)}


def test_rates_and_ages_are_those_of_each_publisher():
    robot = Robot()
    robot.run(12.0, odom=2.0, base=50.0, wheel=100.0)
    report = robot.report()
    rates = {name: one.rate_hz for name, one in report.items()}
    assert rates["odom"] == pytest.approx(2.0, rel=0.02)
    assert rates["base"] == pytest.approx(50.0, rel=0.02)
    assert rates["wheel"] == pytest.approx(100.0, rel=0.02)
    assert {name: one.state for name, one in report.items()} == dict.fromkeys(report, "fresh")
    assert report["laser"].age_s == pytest.approx(12.0)
    assert report["map"].age_s is None
    ages = [report[name].age_s or 0.0 for name in ("odom", "base", "wheel")]
    assert all(age <= period for age, period in zip(ages, (0.5, 0.02, 0.01), strict=True))


def test_who_falls_silent_becomes_slower_then_stale_then_unknown():
    robot = Robot()
    robot.run(5.0, odom=10.0, base=10.0, wheel=10.0)
    robot.run(0.5, odom=10.0, wheel=10.0)
    report = robot.report()
    assert report["base"].state == "fresh"
    robot.run(2.5, odom=10.0, wheel=10.0)
    report = robot.report()
    assert report["base"].state == "stale"
    assert report["base"].age_s == pytest.approx(3.0, abs=0.11)
    assert report["base"].rate_hz < 7.0
    assert report["odom"].state == report["wheel"].state == "fresh"
    # What hangs on a stale frame is told so, though it is told of itself.
    assert (report["wheel"].behind, report["laser"].behind) == ("base", "base")
    assert report["odom"].behind is report["base"].behind is None
    robot.run(8.0, odom=10.0, wheel=10.0)
    assert robot.report()["base"].rate_hz == 0.0
    robot.run(5.0, odom=10.0, base=10.0, wheel=10.0)
    report = robot.report()
    assert report["base"].state == "fresh"
    assert report["wheel"].behind is None


def test_who_becomes_slower_is_not_stale_but_slow():
    robot = Robot()
    robot.run(3.0, base=100.0)
    robot.run(40.0, base=0.5)
    report = robot.report()
    assert report["base"].rate_hz == pytest.approx(0.5, rel=0.2)
    robot.run(3.0, wheel=1.0)
    assert robot.report()["base"].state == "fresh"
    robot.run(3.0, wheel=1.0)
    assert robot.report()["base"].state == "stale"


def test_a_lossy_wire_shows_in_the_rate():
    robot = Robot()
    for number in range(1000):
        robot.clock.now_ns += 10 * MS
        if number % 4:
            robot.tell("base")
    assert robot.report()["base"].rate_hz == pytest.approx(75.0, rel=0.05)


def test_bursts_are_counted_by_their_number():
    robot = Robot()
    for _ in range(40):
        for late_ms in (8, 6, 4, 2, 0):
            stamp_ns = robot.clock.now_ns - late_ms * MS
            robot.buffer.put(columns(Told("odom", "base", stamp_ns)), publisher="base")
        robot.clock.now_ns += 100 * MS
    assert robot.report()["base"].rate_hz == pytest.approx(50.0, rel=0.1)


def test_two_who_tell_of_one_frame_are_both_named():
    robot = Robot()
    for _ in range(20):
        robot.tell("base", "driver")
        robot.clock.now_ns += MS
        robot.tell("base", "simulation")
        robot.clock.now_ns += 9 * MS
    assert robot.report()["base"].publishers == ("simulation", "driver")
    for _ in range(1200):
        robot.tell("base", "driver")
        robot.clock.now_ns += 10 * MS
    assert robot.report()["base"].publishers == ("driver",)


def test_who_is_late_with_old_stamps_is_named_second():
    robot = Robot()
    robot.tell("base", "driver")
    late = columns(Told("odom", "base", robot.clock.now_ns - S))
    robot.buffer.put(late, publisher="late")
    assert robot.report()["base"].publishers == ("driver", "late")


def test_a_branch_that_nothing_connects_with_the_fixed_frame_is_broken():
    robot = Robot()
    robot.tell("odom")
    robot.tell("wheel")
    report = robot.report()
    # Without a fixed frame the largest tree is the whole one: base, laser, wheel.
    assert {name: one.state for name, one in report.items()} == {
        "base": "fresh", "laser": "fresh", "wheel": "fresh", "map": "broken", "odom": "broken",
    }  # fmt: skip
    assert (report["base"].parent, report["base"].root, report["wheel"].parent) == (
        None,
        "base",
        "base",
    )
    assert robot.report("map")["laser"].state == "broken"
    assert robot.report("/map")["odom"].state == "fresh"
    robot.tell("base")
    assert {one.state for one in robot.report("map").values()} == {"fresh"}
    assert {one.state for one in robot.report("gone").values()} == {"broken"}


def test_the_stamps_between_which_a_frame_is_known_are_told():
    robot = Robot()
    begin_ns = robot.clock.now_ns
    robot.run(3.0, base=1.0)
    report = robot.report()
    assert (report["base"].oldest_ns, report["base"].newest_ns) == (begin_ns, begin_ns + 2 * S)
    assert (report["laser"].static, report["base"].static) == (True, False)


def test_a_thousand_publishers_that_come_and_go_are_not_kept():
    robot = Robot()
    for number in range(5000):
        robot.tell("base", f"publisher {number}")
        robot.clock.now_ns += MS
    assert robot.report()["base"].publishers == ("publisher 4999", "publisher 4998")


def test_of_many_frames_the_first_are_told_of_as_among_all():
    robot = Robot()
    robot.run(3.0, odom=10.0, base=10.0)
    robot.run(3.0, base=10.0, wheel=10.0)
    every = robot.buffer.report("map")
    assert [one.frame for one in every] == ["base", "laser", "map", "odom", "wheel"]
    assert every[1].behind == "odom"
    assert robot.buffer.report("map", most=2) == every[:2]
    assert robot.buffer.count() == 5
