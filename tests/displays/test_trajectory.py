from collections.abc import Mapping

import numpy as np
import pytest
from numpy.testing import assert_allclose

from studio.displays.display import Received
from studio.displays.drawing import LinkParts
from studio.displays.properties import Value
from studio.displays.trajectory import DisplayTrajectoryDisplay, JointTrajectoryDisplay
from studio.errors import DisplayMessageError
from studio.robot.values import Robot
from tests.support.display_messages import TYPES, encoded, received
from tests.support.drawn import said
from tests.support.posed import Posed, seen_arm

JOINTS = "trajectory_msgs/msg/JointTrajectory"
PLAN = "moveit_msgs/msg/DisplayTrajectory"
S = 1_000_000_000
BEGIN_NS = 1_700_000_000 * S


def way(*positions: float, joint: str = "shoulder", every_s: int = 1) -> dict[str, object]:
    """A joint that is at one position after the other."""
    return {
        "joint_names": [joint],
        "points": [
            {"positions": [one], "time_from_start": {"sec": at * every_s}}
            for at, one in enumerate(positions)
        ],
    }


def planned(fields: Mapping[str, object]) -> Received:
    """A plan; it has no header."""
    return Received(PLAN, encoded(PLAN, fields), BEGIN_NS)


def display_with(values: dict[str, Value] | None = None) -> tuple[JointTrajectoryDisplay, Posed]:
    display, robot = JointTrajectoryDisplay(TYPES, values), Posed(seen_arm())
    display.stand(robot)
    return display, robot


def shoulder_at(display: JointTrajectoryDisplay, robot: Posed, after_s: float) -> float:
    """Where the ghost has its shoulder, found by the place of the hand."""
    placed = display.draw(BEGIN_NS + round(after_s * S))["ghost/upper"]
    assert (placed.frame, placed.follows) == ("base", True)
    assert placed.offset is not None
    wxyz, _ = placed.offset
    return 2 * float(np.arctan2(wxyz[1], wxyz[0]))


def test_the_ghost_moves_as_fast_as_is_set():
    display, robot = display_with({"State Display Time": "2x"})
    display.take(received(JOINTS, way(0.0, 0.4, 0.8)))
    at = [shoulder_at(display, robot, after_s) for after_s in (0.0, 0.25, 0.5, 1.0, 9.0)]
    assert_allclose(at, [0.0, 0.2, 0.4, 0.8, 0.8], atol=1e-6)
    assert not display.statuses()


@pytest.mark.parametrize("speed", ["1x", "REALTIME", " 1.0 x"])
def test_as_planned_is_once_as_fast(speed: str):
    display, robot = display_with({"State Display Time": speed})
    display.take(received(JOINTS, way(0.0, 0.4)))
    shoulder_at(display, robot, 0.0)
    assert shoulder_at(display, robot, 0.5) == pytest.approx(0.2)


def test_with_a_time_for_each_state_it_goes_from_one_to_the_next():
    display, robot = display_with({"State Display Time": "0.5s"})
    display.take(received(JOINTS, way(0.0, 0.4, 0.8, every_s=10)))
    at = [shoulder_at(display, robot, after_s) for after_s in (0.0, 0.4, 0.6, 1.1)]
    assert_allclose(at, [0.0, 0.0, 0.4, 0.8], atol=1e-6)


@pytest.mark.parametrize("speed", ["fast", "0x", "3", "-1x", "1e9x", ""])
def test_what_is_no_speed_is_said_and_the_first_one_holds(speed: str):
    display, robot = display_with({"State Display Time": speed})
    display.take(received(JOINTS, way(0.0, 0.6)))
    shoulder_at(display, robot, 0.0)
    assert shoulder_at(display, robot, 0.1) == pytest.approx(0.18)
    assert [one.mend for one in display.statuses()] == [("State Display Time", "3x")]


def test_a_loop_begins_again():
    display, robot = display_with({"State Display Time": "1x", "Loop Animation": True})
    display.take(received(JOINTS, way(0.0, 0.4)))
    at = [shoulder_at(display, robot, after_s) for after_s in (0.0, 0.9, 1.0, 1.5)]
    assert_allclose(at, [0.0, 0.36, 0.0, 0.2], atol=1e-6)


def test_a_new_plan_waits_for_the_end_of_the_one_that_is_shown_unless_it_interrupts():
    display, robot = display_with({"State Display Time": "1x"})
    display.take(received(JOINTS, way(0.0, 0.4)))
    shoulder_at(display, robot, 0.0)
    display.take(received(JOINTS, way(-0.8, -0.4)))
    assert shoulder_at(display, robot, 0.5) == pytest.approx(0.2)
    assert shoulder_at(display, robot, 1.0) == pytest.approx(-0.8)
    display.set("Interrupt Display", value=True)
    display.take(received(JOINTS, way(0.6, 0.7)))
    assert shoulder_at(display, robot, 1.2) == pytest.approx(0.6)


def test_paused_it_stands_where_it_is_put_and_goes_on_afterwards():
    display, robot = display_with({"State Display Time": "1x"})
    display.take(received(JOINTS, way(0.0, 0.4, 0.8)))
    shoulder_at(display, robot, 0.0)
    shoulder_at(display, robot, 0.5)
    display.set("Pause", value=True)
    display.set("Pause/Place", 0.75)
    assert shoulder_at(display, robot, 5.0) == pytest.approx(0.6)
    display.set("Pause", value=False)
    assert shoulder_at(display, robot, 7.0) == pytest.approx(0.2)
    assert shoulder_at(display, robot, 7.5) == pytest.approx(0.4)


def test_a_trail_has_the_states_that_were_passed_and_is_not_made_again():
    display, _ = display_with({"State Display Time": "1x", "Show Trail": True})
    display.take(received(JOINTS, way(*np.linspace(0, 0.9, 10).tolist())))
    display.set("Trail Step Size", 4)
    display.draw(BEGIN_NS)
    first = display.draw(BEGIN_NS + 5 * S)
    robots = {path.partition("/")[0] for path in first}
    assert robots == {"ghost", "0", "4"}
    last = display.draw(BEGIN_NS + 20 * S)
    assert {path.partition("/")[0] for path in last} == {"ghost", "0", "4", "8", "9"}
    assert last["4/hand"] is first["4/hand"]
    assert last["ghost/hand"].shapes["link"] is first["ghost/hand"].shapes["link"]


def test_a_long_trail_is_thinned_and_says_so():
    display, _ = display_with({"Show Trail": True})
    display.take(received(JOINTS, way(*np.linspace(0, 0.9, 3000).tolist())))
    drawn = display.draw(BEGIN_NS) or display.draw(BEGIN_NS)
    drawn = display.draw(BEGIN_NS + 10_000 * S)
    assert len(drawn) <= 4_004
    assert ("ok", "thinned") in said(display)


def test_its_looks_are_those_that_are_set():
    display, _ = display_with({"Robot Alpha": 0.25})
    display.take(received(JOINTS, way(0.0)))

    def part() -> LinkParts:
        found = display.draw(BEGIN_NS)["ghost/hand"].shapes["link"]
        assert isinstance(found, LinkParts)
        return found

    assert (part().opacity, part().rgb, part().visual, part().collision) == (
        0.25,
        None,
        True,
        False,
    )
    display.set("Color Enabled", value=True)
    assert part().rgb == (150, 50, 150)
    display.set("Show Robot Visual", value=False)
    assert not display.draw(BEGIN_NS)
    assert said(display) == [("warn", "empty")]


def test_another_robot_moves_from_now_on():
    display, robot = display_with()
    display.take(received(JOINTS, way(0.1)))
    assert "ghost/hand" in display.draw(BEGIN_NS)
    robot.become(Robot("none"))
    display.stand(robot)
    assert not display.draw(BEGIN_NS)
    assert said(display) == [("error", "empty")]


def test_joints_that_the_robot_does_not_have_are_named():
    display, _ = display_with()
    display.take(received(JOINTS, way(0.1, joint="tail")))
    display.draw(BEGIN_NS)
    (status,) = display.statuses()
    assert "no joint tail" in status.sentence


def test_a_bad_message_leaves_the_one_before():
    display, robot = display_with()
    display.take(received(JOINTS, way(0.3)))
    with pytest.raises(DisplayMessageError):
        display.take(received(JOINTS, {"joint_names": ["shoulder"], "points": [{}]}))
    assert shoulder_at(display, robot, 0.0) == pytest.approx(0.3)


def test_a_plan_for_another_robot_is_drawn_and_said():
    display = DisplayTrajectoryDisplay(TYPES)
    display.stand(Posed(seen_arm()))
    plan = {"model_id": "panda", "trajectory": [{"joint_trajectory": way(0.3, 0.4)}]}
    display.take(planned(plan))
    assert display.draw(BEGIN_NS)
    assert said(display) == [("warn", "other_robot")]
    display.take(planned({**plan, "model_id": "arm"}))
    assert said(display) == [("warn", "other_robot")], "the plan that waits is not shown yet"
    assert display.draw(BEGIN_NS + 100 * S)
    assert not display.statuses()


def test_a_robot_that_flies_is_where_the_plan_has_its_root():
    base = {
        "header": {"frame_id": "world"},
        "joint_names": ["virtual"],
        "points": [{"transforms": [{"translation": {"z": 2.0}, "rotation": {"w": 1.0}}]}],
    }
    display = DisplayTrajectoryDisplay(TYPES)
    display.stand(Posed(seen_arm()))
    display.take(planned({"trajectory": [{"multi_dof_joint_trajectory": base}]}))
    placed = display.draw(BEGIN_NS)["ghost/hand"]
    assert placed.frame == "world"
    assert placed.offset is not None
    assert_allclose(placed.offset[1], (0.5, 0.0, 2.0))
