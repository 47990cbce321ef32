from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from studio.displays.drawing import Arrows, Lines
from studio.displays.effort import RINGS_MAX, EffortDisplay
from studio.errors import DisplayMessageError, DisplayPropertyError
from studio.ros.cdr import codec_of
from tests.support.display_messages import STAMP_NS, TYPES, received
from tests.support.drawn import assert_drawable, said

STATES, TEXT = "sensor_msgs/msg/JointState", "std_msgs/msg/String"
ROBOT = """<robot name="arm">
  <link name="base"/><link name="upper"/><link name="wheel"/><link name="rail"/>
  <joint name="elbow" type="revolute"><parent link="base"/><child link="upper"/>
    <axis xyz="0 2 0"/><limit lower="-1" upper="1" effort="10" velocity="1"/></joint>
  <joint name="spin" type="continuous"><parent link="upper"/><child link="wheel"/>
    <axis xyz="0 0 1"/></joint>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="rail"/>
    <limit lower="0" upper="1" effort="5" velocity="1"/></joint>
</robot>"""


def display_of(
    efforts: dict[str, float],
    *,
    robot: str | None = ROBOT,
    little: bool = True,
    **values: Any,  # noqa: ANN401
) -> EffortDisplay:
    display = EffortDisplay(TYPES, {name.replace("_", " "): one for name, one in values.items()})
    if robot is not None:
        describe(display, robot)
    take(display, list(efforts), list(efforts.values()), little)
    return display


def describe(display: EffortDisplay, urdf: str) -> None:
    kind = TYPES.message(TEXT)
    raw = bytes(codec_of(kind).encode(kind(data=urdf)))
    display.take(received(STATES, {})._replace(type_name=TEXT, cdr=raw), "description")


def take(
    display: EffortDisplay, names: list[str], efforts: list[float], little: bool = True
) -> None:
    display.take(received(STATES, {"name": names, "effort": efforts}, little=little))


def ring(display: EffortDisplay, of: str = "0/0") -> tuple[Lines, Arrows]:
    placed = display.draw(0)[of]
    line, head = placed.shapes["ring"], placed.shapes["head"]
    assert isinstance(line, Lines)
    assert isinstance(head, Arrows)
    return line, head


@pytest.mark.parametrize("little", [True, False])
def test_an_effort_is_a_ring_about_the_axis_of_its_joint_in_the_frame_of_its_child(little: bool):
    display = display_of({"elbow": 5.0, "spin": 0.25, "slide": 1.0}, little=little)
    drawn = display.draw(0)
    assert [(one.frame, one.stamp_ns) for one in drawn.values()] == [
        ("upper", STAMP_NS), ("wheel", STAMP_NS),
    ]  # fmt: skip
    line, head = ring(display)
    # Half of the greatest effort, with RViz's least share of 0.05 twice.
    np.testing.assert_allclose(np.linalg.norm(line.ends, axis=2), 0.05 + 0.55 / 2, rtol=1e-5)
    np.testing.assert_allclose(line.ends[:, :, 1], 0.0, atol=1e-6)
    assert (line.width_m, head.head_length_m, head.head_diameter_m) == (0.02, 0.04, 0.08)
    assert len(line.ends) == 29
    wheel, _ = ring(display, "0/1")
    np.testing.assert_allclose(np.linalg.norm(wheel.ends, axis=2), 0.05 + 0.3 / 2, rtol=1e-5)
    assert_drawable(drawn)


@pytest.mark.parametrize("effort", [3.0, -3.0])
@pytest.mark.parametrize(("joint", "axis"), [("elbow", [0, 1, 0]), ("spin", [0, 0, 1])])
def test_the_head_goes_round_the_axis_as_the_joint_pushes(
    effort: float, joint: str, axis: list[int]
):
    _, head = ring(display_of({joint: effort}))
    tail, tip = head.ends[0].astype(np.float64)
    assert np.sign(np.cross(tail, tip) @ axis) == np.sign(effort)


def test_more_effort_is_larger_and_red_and_never_more_than_the_greatest():
    weak, _ = ring(display_of({"elbow": 0.0}))
    most, _ = ring(display_of({"elbow": 10.0}))
    beyond, _ = ring(display_of({"elbow": 1e9}))
    np.testing.assert_array_equal(most.ends, beyond.ends)
    assert np.abs(most.ends).max() > np.abs(weak.ends).max()
    assert most.colors.tolist() == [255, 0, 0]
    assert weak.colors[2] > 200


def test_width_scale_opacity_and_prefix_can_be_set():
    display = display_of({"elbow": 10.0}, Width=0.1, Scale=2.0, Alpha=0.5, TF_Prefix="left")
    line, _ = ring(display)
    assert (line.width_m, line.opacity) == (0.1, 0.5)
    np.testing.assert_allclose(np.linalg.norm(line.ends, axis=2), 0.05 + 1.05, rtol=1e-5)
    assert display.draw(0)["0/0"].frame == "left/upper"
    display.set("Width", 0.0)
    assert set(display.draw(0)["0/0"].shapes) == {"ring"}


def test_a_description_that_comes_later_is_taken():
    display = display_of({"elbow": 5.0}, robot=None)
    assert not display.draw(0)
    assert said(display) == [("warn", "empty")]
    assert "robot_description" in display.statuses()[0].sentence
    describe(display, ROBOT)
    assert len(display.draw(0)) == 1
    assert said(display) == []


@pytest.mark.parametrize("text", ["", "<robot", "<sdf/>", "x" * 5_000_000])
def test_a_description_that_is_none_is_told_and_the_last_one_counts(text: str):
    display = display_of({"elbow": 5.0})
    before = display.draw(0)
    with pytest.raises(DisplayMessageError, match="robot description"):
        describe(display, text)
    assert display.draw(0) is before


def test_joint_states_without_efforts_are_told():
    display = display_of({})
    take(display, ["elbow"], [])
    assert said(display)[-1] == ("error", "empty")
    take(display, ["elbow"], [1.0, 2.0])
    assert said(display)[-1] == ("error", "bad_message")


def test_joints_of_another_robot_are_told():
    display = display_of({"shoulder": 1.0})
    assert not display.draw(0)
    assert said(display) == [("warn", "empty")]


@pytest.mark.parametrize("number", [math.nan, math.inf, 1e308])
def test_efforts_that_cannot_be_drawn_are_left_out_or_told(number: float):
    assert len(display_of({"elbow": 1.0, "spin": number}).draw(0)) == 1
    display = display_of({"spin": number})
    assert not display.draw(0)
    assert said(display) == [("error", "not_finite")]


def test_a_joint_without_an_axis_has_no_ring():
    display = display_of({"elbow": 1.0, "spin": 1.0}, robot=ROBOT.replace("0 2 0", "0 0 0"))
    assert [one.frame for one in display.draw(0).values()] == ["wheel"]


def test_each_joint_can_be_switched_off_and_is_named_when_it_is_known():
    display = display_of({"elbow": 1.0, "spin": 1.0}, robot=None)
    display.set("Joints/elbow", False)
    assert [one.name for one in display.properties() if "/" in one.name] == []
    describe(display, ROBOT)
    assert [one.name for one in display.properties()[-2:]] == ["Joints/elbow", "Joints/spin"]
    assert [one.frame for one in display.draw(0).values()] == ["wheel"]
    display.set("Joints/elbow", True)
    assert len(display.draw(0)) == 2


def test_settings_of_joints_have_an_end():
    display = display_of({})
    for number in range(10_000 - len(display.values)):
        display.set(f"Joints/{number}", False)
    with pytest.raises(DisplayPropertyError, match="too many"):
        display.set("Joints/elbow", False)
    display.set("Joints/7", True)


def test_a_joint_that_is_named_often_has_one_ring_and_a_message_has_an_end():
    display = display_of({})
    take(display, ["elbow"] * 50_000, [1.0] * 50_000)
    assert len(display.draw(0)) == 1
    joints = "".join(
        f'<link name="l{n}"/><joint name="j{n}" type="continuous"><parent link="base"/>'
        f'<child link="l{n}"/><axis xyz="0 0 1"/></joint>'
        for n in range(RINGS_MAX + 1)
    )
    display = display_of(
        {f"j{n}": 1.0 for n in range(RINGS_MAX + 1)},
        robot=f'<robot name="hedgehog"><link name="base"/>{joints}</robot>',
    )
    assert len(display.draw(0)) == RINGS_MAX


def test_as_many_messages_are_seen_as_the_history_is_long():
    display = display_of({"elbow": 1.0, "spin": 1.0}, History_Length=2)
    for effort in (2.0, 3.0):
        take(display, ["elbow", "spin"], [effort, effort])
    assert len(display.draw(0)) == 4
