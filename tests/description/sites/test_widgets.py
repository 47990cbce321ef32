"""The widget of a value: a table of names and values as they occur in real descriptions."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.description.sites.widgets import infer_widget, keep_range
from studio.description.syntax.annotations import Annotation, read_annotation
from studio.description.values import Widget, WidgetKind

ORIGIN = ("link/visual/origin", "xyz")
ORIGIN_RPY = ("joint/origin", "rpy")
RADIUS = ("link/visual/geometry/cylinder", "radius")
INERTIA = ("link/inertial/inertia", "ixx")
LOWER = ("joint/limit", "lower")
SLIDING_LOWER = ("joint:prismatic/limit", "lower")
MASS = ("link/inertial/mass", "value")
PI = 3.1416


def slider(low: float, high: float, step: float, unit: str = "") -> Widget:
    return Widget(WidgetKind.SLIDER, low, high, step, unit)


def vector(low: float, high: float, step: float, unit: str = "") -> Widget:
    return Widget(WidgetKind.VECTOR, low, high, step, unit)


TEXT = Widget(WidgetKind.TEXT)
SWITCH = Widget(WidgetKind.SWITCH)


@pytest.mark.parametrize(
    ("name", "text", "consumers", "widget"),
    [
        ("wheel_radius", "0.1", (), slider(0.025, 0.4, 0.001, "m")),
        ("wheelRadius", "0.1", (), slider(0.025, 0.4, 0.001, "m")),
        ("base_length", "0.6", (), slider(0.15, 2.4, 0.01, "m")),
        ("track_width", "2", (), slider(0.5, 8, 0.01, "m")),
        ("chassis_height", "0", (), slider(0, 1, 0.01, "m")),
        ("deck_thickness", "0.01", (), slider(0.0025, 0.04, 0.0001, "m")),
        ("size_y", "0.2", (), slider(0.05, 0.8, 0.001, "m")),
        ("wheel_mass", "2.5", (), slider(0.62, 10, 0.01, "kg")),
        ("payload", "10", (), slider(2.5, 40, 0.1, "kg")),
        ("arm_mass", "0", (), slider(0, 1, 0.01, "kg")),
        ("camera_offset_x", "0.05", (), slider(-0.2, 0.2, 0.001, "m")),
        ("lidar_z", "0", (), slider(-1, 1, 0.01, "m")),
        ("shoulder_z", "-2.39e-11", (), slider(-1, 1, 0.01, "m")),
        ("xyz", "0 0 0.5", (), vector(-2, 2, 0.01, "m")),
        ("camera_rpy", "0 0.5 0", (), vector(-PI, PI, 0.01, "rad")),
        ("mount_yaw", "0", (), slider(-PI, PI, 0.01, "rad")),
        ("tilt", "4", (), slider(-6.2832, 6.2832, 0.01, "rad")),
        ("elbow_angle_deg", "45", (), slider(-180, 180, 1, "deg")),
        ("elbow_lower_limit", "-2.0", (), slider(-PI, PI, 0.01, "rad")),
        ("max_velocity", "3.0", (), slider(0.8, 12, 0.1, "rad/s")),
        ("velocity_limit", "3.0", (), slider(0.8, 12, 0.1, "rad/s")),
        ("max_linear_velocity", "1.0", (), slider(0.25, 4, 0.01, "m/s")),
        ("max_acceleration", "8.0", (), slider(2, 32, 0.1, "rad/s^2")),
        ("elbow_effort_limit", "330.0", (), slider(80, 1320, 10, "N m")),
        ("wheel_torque", "5", (), slider(1.2, 20, 0.1, "N m")),
        ("joint_friction", "0.1", (), slider(0.025, 0.4, 0.001)),
        ("damping", "0", (), slider(0, 1, 0.01)),
        ("mu1", "1.0", (), slider(0.25, 4, 0.01)),
        ("safety_k_position", "20", (), slider(5, 80, 0.1)),
        ("mesh_scale", "0.001", (), slider(0.00025, 0.004, 0.00001)),
        ("mesh_scale", "0.001 0.001 0.001", (), vector(0.00025, 0.004, 0.00001)),
        ("rgba", "0.2 0.4 1 1", (), vector(0, 1, 0.01)),
        ("led_red", "0.5", (), slider(0, 1, 0.01)),
        ("ixx", "0.01", (), slider(0.0025, 0.04, 0.0001, "kg m^2")),
        ("ixy", "0", (), slider(-1, 1, 0.01, "kg m^2")),
        ("update_rate", "30", (), slider(8, 120, 1, "Hz")),
        ("wheel_count", "4", (), slider(1, 16, 1)),
        ("lidar_samples", "720", (), slider(180, 2880, 1)),
        ("something", "3", (), slider(0, 12, 1)),
        ("something", "0", (), slider(-1, 1, 1)),
        ("something", "0.0", (), slider(-1, 1, 0.01)),
        ("something", "0.8", (), slider(0.2, 3.2, 0.01)),
        ("something", "-2.0", (), slider(-8, -0.5, 0.01)),
        ("something", "1 -1", (), vector(-4, 4, 0.01)),
        ("reflect", "-1", (), slider(-1, 1, 0.01)),
        ("something", "0.1", (ORIGIN,), slider(-0.4, 0.4, 0.001, "m")),
        ("something", "0.1", (ORIGIN_RPY,), slider(-PI, PI, 0.01, "rad")),
        ("something", "0.1", (INERTIA, RADIUS), slider(0.025, 0.4, 0.001, "m")),
        ("something", "4.0", (INERTIA, ORIGIN, MASS), slider(1, 16, 0.1, "kg")),
        ("something", "-1.0", (LOWER,), slider(-PI, PI, 0.01, "rad")),
        ("something", "-1.0", (SLIDING_LOWER,), slider(-4, 4, 0.01, "m")),
        ("finger_limit", "0.04", (SLIDING_LOWER,), slider(-0.16, 0.16, 0.001, "m")),
        ("pitch_offset", "0.1", (ORIGIN_RPY,), slider(-PI, PI, 0.01, "rad")),
        ("", "0 0 1", (("joint/axis", "xyz"),), vector(-1, 1, 0.01)),
        ("", "-1", (("joint/mimic", "multiplier"),), slider(-4, 4, 0.01)),
        ("joint_limits.elbow.max_position", "1.5", (), slider(-PI, PI, 0.01, "rad")),
        ("kinematics.shoulder.z", "0.18", (), slider(-0.72, 0.72, 0.001, "m")),
        ("inertia_parameters.base_mass", "4.0", (), slider(1, 16, 0.1, "kg")),
        ("use_camera", "true", (), SWITCH),
        ("use_camera", "False", (), SWITCH),
        ("prefix", "left_", (), TEXT),
        ("prefix", "", (), TEXT),
        ("M_PI", "3.14159", (), TEXT),
        ("degrees_to_radians", "0.01745", (), TEXT),
        ("names", "['a', 'b']", (), TEXT),
        ("huge", "1e300", (), TEXT),
        ("numbers", "1 " * 17, (), TEXT),
    ],
)
def test_a_value_gets_the_widget_of_its_name_value_and_use(
    name: str, text: str, consumers: tuple[tuple[str, str], ...], widget: Widget
):
    assert infer_widget(name, text, text.strip(), consumers=consumers) == widget


def test_an_expression_keeps_the_range_of_what_it_came_to():
    widget = infer_widget("wheel_width", "${wheel_radius / 2}", "0.05")
    assert widget == slider(0.012, 0.2, 0.001, "m")
    assert infer_widget("on", "${a and b}", "True") == TEXT
    assert infer_widget("origin_xyz", "${x} 0 0", "0.1 0 0").kind is WidgetKind.VECTOR


def test_conditions_give_the_choices_behind_the_value_itself():
    widget = infer_widget("arm", "long", "long", compared=["short", "long", "", "1", "true"])
    assert widget == Widget(WidgetKind.CHOICE, choices=("long", "short"))


def test_a_comparison_with_nothing_or_a_number_gives_no_choices():
    assert infer_widget("prefix", "left_", "left_", compared=[""]) == TEXT
    assert infer_widget("n", "2", "2", compared=["1"]).kind is WidgetKind.SLIDER


@pytest.mark.parametrize(
    ("comment", "text", "widget"),
    [
        ("[0.05:0.005:0.3] m", "0.1",
         Widget(WidgetKind.SLIDER, 0.05, 0.3, 0.005, "m", annotated=True)),
        ("[0.05:0.3]", "0.1", Widget(WidgetKind.SLIDER, 0.05, 0.3, 0.001, "m", annotated=True)),
        ("[0:10]", "3", Widget(WidgetKind.SLIDER, 0, 10, 1, "m", annotated=True)),
        ("[0:0.1:10] why", "3",
         Widget(WidgetKind.SLIDER, 0, 10, 0.1, "m", help="why", annotated=True)),
        ("[0:1]", "0 0.5", Widget(WidgetKind.VECTOR, 0, 1, 0.01, "m", annotated=True)),
        ("[a, b]", "a", Widget(WidgetKind.CHOICE, choices=("a", "b"), annotated=True)),
        ("[cm]", "10", slider(2.5, 40, 0.1, "cm")),
        ("[deg]", "90", slider(-180, 180, 1, "deg")),
    ],
)  # fmt: skip
def test_a_comment_wins(comment: str, text: str, widget: Widget):
    annotation = read_annotation([comment], text)
    assert infer_widget("wheel_radius", text, text, annotation) == widget


def test_a_speed_that_the_file_gives_in_degrees_stays_a_speed():
    widget = infer_widget("max_velocity", "180.0", "180.0", Annotation(unit="deg"))
    assert widget == slider(45, 720, 1, "deg/s")


@given(st.floats(1e-12, 1e12) | st.floats(-1e12, -1e-12), st.sampled_from(
    ["x", "wheel_radius", "mass", "yaw", "offset", "ixy", "rate", "scale", "what"]
))  # fmt: skip
def test_every_slider_holds_its_value_and_has_steps_enough(value: float, name: str):
    text = repr(value)
    widget = infer_widget(name, text, text)
    low, high, step = widget.minimum, widget.maximum, widget.step
    assert low is not None
    assert high is not None
    assert step is not None
    assert low - step <= value <= high + step
    assert math.isfinite(high - low)
    assert 0 < step <= (high - low)


def test_a_drag_does_not_move_its_own_range():
    before = infer_widget("wheel_radius", "0.1", "0.1")
    after = infer_widget("wheel_radius", "0.3", "0.3")
    assert keep_range(after, [before], "0.3") == before


@pytest.mark.parametrize("shown", ["0.5", "0.01"])
def test_a_value_outside_of_the_range_makes_a_new_one(shown: str):
    before = infer_widget("wheel_radius", "0.1", "0.1")
    after = infer_widget("wheel_radius", shown, shown)
    assert keep_range(after, [before], shown) == after


def test_a_range_from_a_comment_is_never_kept_by_force():
    before = Widget(WidgetKind.SLIDER, 0, 1, 0.1, annotated=True)
    after = replace(before, maximum=2.0)
    assert keep_range(after, [before], "0.5") == after
