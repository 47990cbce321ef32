"""The display of interactive markers: groups in the scene, moves, drags and limits."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from studio.displays.drawing import Axes
from studio.displays.interactive_marker import ControlModel, MarkerModel
from studio.displays.interactive_markers import (
    CONTROLS_MAX,
    MARKERS_MAX,
    NAMESPACE,
    InteractiveMarkersDisplay,
)
from studio.ros.interactive_markers.names import Mode, OrientationMode
from tests.support.display_messages import TYPES
from tests.support.drawn import said

if TYPE_CHECKING:
    from studio.displays.drawing import Pose
    from studio.displays.interactive_markers import ShownMarker
    from studio.displays.properties import Value

NO_TURN = (1.0, 0.0, 0.0, 0.0)
SHAPES = {"arrows": Axes.__new__(Axes)}
"""Stands for any shape: the display hands them on."""


def control(name: str, facing: OrientationMode = OrientationMode.INHERIT) -> ControlModel:
    mode = int(Mode.ROTATE_AXIS)
    return ControlModel(name, "", mode, int(facing), NO_TURN, False, False, SHAPES)


def marker(
    name: str = "one",
    x: float = 0.0,
    controls: tuple[ControlModel, ...] = (control("c"),),
    stamp_ns: int = 0,
) -> MarkerModel:
    pose = (NO_TURN, (x, 0.0, 0.0))
    return MarkerModel(name, "", "base", stamp_ns, pose, 1.0, controls, SHAPES, ())


def at(x: float) -> Pose:
    return NO_TURN, (x, 0.0, 0.0)


def display_of(*markers: MarkerModel, **values: Value) -> InteractiveMarkersDisplay:
    display = InteractiveMarkersDisplay(TYPES, values)
    display.put(markers)
    return display


def shown(display: InteractiveMarkersDisplay, number: int = 1) -> ShownMarker:
    found = display.marker(number)
    assert found is not None
    return found


def place(display: InteractiveMarkersDisplay, group: str = "m1-body") -> float:
    offset = display.draw(0)[group].offset
    assert offset is not None
    return offset[1][0]


def test_a_marker_is_a_frame_a_body_a_title_and_a_group_for_each_control_that_turns_by_itself():
    controls = (
        control("in"),
        control("fixed", OrientationMode.FIXED),
        control("eye", OrientationMode.VIEW_FACING),
    )
    drawing = display_of(marker(x=2.0, controls=controls)).draw(0)
    numbers = {"in": 0, "fixed": 1, "eye": 2}
    kept = shown(display := display_of(marker(controls=controls))).control_numbers
    assert kept == numbers
    assert {path: tuple(one.shapes) for path, one in drawing.items()} == {
        "m1": (),
        "m1-body": ("c0-arrows",),
        "m1-f1": ("c1-arrows",),
        "m1-v2": ("c2-arrows",),
        "m1-title": ("arrows",),
    }
    assert all(one.frame == "base" and one.follows for one in drawing.values())
    assert drawing["m1"].offset is None
    assert drawing["m1-body"].offset == at(2.0)
    assert not display.statuses()


def test_one_with_a_stamp_stays_where_its_frame_was():
    drawing = display_of(marker(stamp_ns=5)).draw(0)
    assert all(not one.follows and one.stamp_ns == 5 for one in drawing.values())


def test_descriptions_and_axes_are_shown_as_they_are_set():
    values: dict[str, Value] = {"Show Descriptions": False, "Show Axes": True}
    display = InteractiveMarkersDisplay(TYPES, values)
    display.put([marker()])
    drawing = display.draw(0)
    assert "m1-title" not in drawing
    assert "axes" in drawing["m1-body"].shapes
    display.set("Show Axes", False)
    assert "axes" not in display.draw(0)["m1-body"].shapes


def test_a_pose_moves_the_same_shapes():
    display = display_of(marker(), marker("two"))
    before, version = display.draw(0), display.version
    assert display.draw(0) is before
    assert display.move("one", at(3.0))
    after = display.draw(0)
    assert place(display) == 3.0
    assert after["m1-body"].shapes is before["m1-body"].shapes
    assert after["m2-body"] is before["m2-body"]
    assert display.version == version, "nothing else can be done with it"
    assert not display.move("nobody", at(0.0))


def test_while_a_marker_is_dragged_the_poses_of_its_server_wait():
    display = display_of(marker())
    one = shown(display)
    display.drag(one, at(1.0), (0, 0.0))
    display.move("one", at(7.0))
    assert place(display) == 1.0
    display.put([marker(x=8.0, controls=(control("other"), control("c")))])
    assert place(display) == 1.0
    assert shown(display).control_numbers == {"c": 0, "other": 1}, "the drag goes on"
    display.let_go(one)
    assert place(display) == 8.0
    display.drag(one, at(2.0), (0, 0.0))
    display.let_go(one)
    assert place(display) == 2.0, "the server wanted nothing else"


def test_a_control_that_keeps_its_axes_shows_how_far_it_was_turned():
    display = display_of(marker(controls=(control("f", OrientationMode.FIXED),)))
    display.drag(shown(display), at(0.0), (0, math.pi / 2))
    offset = display.draw(0)["m1-f0"].offset
    assert offset is not None
    assert [round(part, 6) for part in offset[0]] == [0.707107, 0.707107, 0.0, 0.0]


def test_what_is_erased_is_gone_and_its_number_is_not_given_again():
    display = display_of(marker())
    display.erase(["one", "nobody"])
    assert not display.draw(0)
    display.put([marker()])
    assert display.marker(1) is None
    assert display.marker(2) is not None


def test_more_markers_than_can_be_shown_are_left_out_and_said():
    many = [marker(str(number), controls=()) for number in range(MARKERS_MAX + 5)]
    display = display_of(*many)
    assert len(display.markers) == MARKERS_MAX
    assert said(display) == [("error", "thinned")]
    large = marker("large", controls=tuple(control(str(n)) for n in range(CONTROLS_MAX)))
    display = display_of(large, marker())
    assert [len(one.model.controls) for one in display.markers] == [CONTROLS_MAX, 0]
    assert said(display) == [("error", "thinned")]


def test_many_are_drawn_a_few_at_a_time():
    display = display_of(*(marker(str(number)) for number in range(250)))
    counts = [sum(len(one.shapes) for one in display.draw(0).values()) for _ in range(10)]
    assert counts[0] < counts[1] < counts[-1] == 500
    assert counts == sorted(counts)


def test_a_namespace_is_named_as_topics_are_and_another_one_has_other_markers():
    display = display_of(marker())
    version = display.version
    display.set(NAMESPACE, " basic_controls/ ")
    assert display.namespace == "/basic_controls"
    assert not display.draw(0)
    assert display.version > version
    settings = InteractiveMarkersDisplay.settings_for("/a/b/update")
    assert settings == {NAMESPACE: "/a/b"}
    assert InteractiveMarkersDisplay.settings_for("") == {}


def test_a_reset_forgets_all_and_says_so_to_its_client():
    display = display_of(marker())
    display.reset()
    assert not display.draw(0)
    assert display.resets == 1
