from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest

from studio.displays.drawing import Axes, Lines, Placed, Solids, Text
from studio.displays.tf import NAMES_MAX, TfDisplay
from studio.errors import DisplayPropertyError
from studio.tf.buffer import TransformBuffer
from tests.support.display_messages import TYPES
from tests.support.drawn import assert_drawable, said
from tests.support.transforms import HandClock, S, Told, about_z, columns

if TYPE_CHECKING:
    from studio.displays.drawing import Drawing
    from studio.displays.properties import Value


class Robot:
    """A base that turned a quarter left at (2, 1), a wheel 1 m to its left, and a stray camera."""

    def __init__(self) -> None:
        self.clock = HandClock()
        self.buffer = TransformBuffer(clock=self.clock)
        self.buffer.put(columns(Told("camera", "lens", S)), static=True)
        self.buffer.put(columns(Told("base", "wheel", S, (0.0, 1.0, 0.0))), static=True)
        self.turn(math.pi / 2)

    def turn(self, angle_rad: float) -> None:
        told = Told("odom", "base", self.clock.now_ns, (2.0, 1.0, 0.0), about_z(angle_rad))
        self.buffer.put(columns(told))


def shown(robot: Robot, **values: Value) -> TfDisplay:
    display = TfDisplay(TYPES)
    for name, value in values.items():
        display.set(name.replace("_", " "), value)
    display.see(robot.buffer.all_in("odom"))
    return display


def names_in(drawing: Drawing) -> set[str]:
    return {path.removeprefix("names/") for path in drawing if path.startswith("names/")}


def frames_of(drawing: Drawing) -> Placed:
    assert_drawable(drawing)
    return drawing["frames"]


def axes_of(drawing: Drawing) -> Axes:
    axes = frames_of(drawing).shapes["axes"]
    assert isinstance(axes, Axes)
    return axes


def solids_of(drawing: Drawing, name: str) -> Solids:
    solids = frames_of(drawing).shapes[name]
    assert isinstance(solids, Solids)
    return solids


def test_frames_are_crosses_where_they_are_in_the_fixed_frame():
    drawing = shown(Robot()).draw(0)
    assert (drawing["frames"].frame, drawing["frames"].follows) == ("odom", True)
    axes = axes_of(drawing)
    places = sorted(axes.positions.round(6).tolist())
    assert places == [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 1.0, 0.0]]
    assert (axes.length_m, axes.radius_m, axes.opacity) == (0.2, 0.01, 1.0)


def test_names_follow_their_frames():
    drawing = shown(Robot()).draw(0)
    assert names_in(drawing) == {"odom", "base", "wheel"}
    name = drawing["names/wheel"]
    assert (name.frame, name.stamp_ns, name.follows) == ("wheel", 0, True)
    assert name.shapes["name"] == Text("wheel")


def test_arrows_lead_from_child_to_parent():
    drawing = shown(Robot()).draw(0)
    heads, shafts = solids_of(drawing, "heads"), solids_of(drawing, "shafts")
    assert (heads.kind, shafts.kind) == ("cone", "cylinder")
    # Tips are at the parents: those of base and of wheel.
    assert sorted(heads.positions.round(5).tolist()) == [[0.0, 0.0, 0.0], [2.0, 1.0, 0.0]]
    lengths = sorted((heads.scales[:, 2] + shafts.scales[:, 2]).round(5).tolist())
    assert lengths == pytest.approx([1.0, math.sqrt(5)], abs=1e-5)
    assert heads.scales[:, :2].tolist() == pytest.approx(np.full((2, 2), 0.04))
    for at in range(2):
        # A cone opens along its z: back from the parent, through the middle of the shaft.
        w, x, y, z = heads.wxyz[at].tolist()
        along = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
        middle = heads.positions[at] + along * (heads.scales[at, 2] + shafts.scales[at, 2] / 2)
        assert middle == pytest.approx(shafts.positions[at], abs=1e-5)


def test_frames_stay_where_they_are_for_as_long_as_is_chosen():
    robot = Robot()
    display = shown(robot, Update_Interval=0.5)
    first = display.draw(S)
    robot.turn(0.0)
    display.see(robot.buffer.all_in("odom"))
    assert display.draw(S + S // 4) is first
    assert sorted(axes_of(display.draw(S + S // 2)).positions.round(6).tolist())[1:] == [
        [2.0, 1.0, 0.0],
        [2.0, 2.0, 0.0],
    ]


def test_another_setting_fixed_frame_or_a_clock_put_back_is_not_waited_for():
    robot = Robot()
    display = shown(robot, Update_Interval=3600.0)
    display.draw(S)
    display.set("Show Names", value=False)
    assert not names_in(display.draw(S))
    display.see(robot.buffer.all_in("base"))
    assert frames_of(display.draw(S)).frame == "base"
    robot.turn(0.0)
    display.see(robot.buffer.all_in("base"))
    still = display.draw(S)
    assert display.draw(0) is not still


@pytest.mark.parametrize("distance_m", [0.0, 0.0005, 0.05, 3.0])
@pytest.mark.parametrize("scale", [0.01, 1.0, 100.0])
def test_arrows_of_any_length_are_as_long_as_the_way(distance_m: float, scale: float):
    buffer = TransformBuffer()
    buffer.put(columns(Told("a", "b", S, (0.0, 0.0, distance_m))))
    display = TfDisplay(TYPES, {"Marker Scale": scale})
    display.see(buffer.all_in("a"))
    drawing = display.draw(0)
    assert_drawable(drawing)
    if distance_m < 0.001:
        assert set(drawing["frames"].shapes) == {"axes"}
        return
    heads, shafts = solids_of(drawing, "heads"), solids_of(drawing, "shafts")
    assert float(heads.scales[0, 2] + shafts.scales[0, 2]) == pytest.approx(distance_m, rel=1e-5)
    assert (heads.scales >= 0).all()
    assert (shafts.scales >= 0).all()


@pytest.mark.parametrize(
    ("switch", "gone"),
    [
        ("Show_Axes", {"axes"}),
        ("Show_Arrows", {"heads", "shafts"}),
    ],
)
def test_axes_and_arrows_can_be_switched_off(switch: str, gone: set[str]):
    everything = set(shown(Robot()).draw(0)["frames"].shapes)
    assert everything == {"axes", "heads", "shafts"}
    drawing = shown(Robot(), **{switch: False}).draw(0)
    assert set(drawing["frames"].shapes) == everything - gone


def test_with_all_switched_off_nothing_is_drawn():
    display = shown(Robot(), Show_Axes=False, Show_Arrows=False)
    assert set(display.draw(0)) == {"names/odom", "names/base", "names/wheel"}
    display.set("Show Names", value=False)
    assert display.draw(0) == {}


def test_scale_and_opacity_hold_for_all():
    drawing = shown(Robot(), Marker_Scale=2.0, Marker_Alpha=0.5, Name_Height=0.25).draw(0)
    axes = axes_of(drawing)
    assert (axes.length_m, axes.radius_m, axes.opacity) == (0.4, 0.02, 0.5)
    assert solids_of(drawing, "heads").opacities == 0.5
    assert drawing["names/odom"].shapes["name"] == Text("odom", height_m=0.5, opacity=0.5)


def test_frames_that_stand_still_are_the_same_drawing_and_names_the_same_objects():
    robot = Robot()
    display = shown(robot)
    first = display.draw(0)
    robot.clock.now_ns += S
    robot.turn(math.pi / 2)
    display.see(robot.buffer.all_in("odom"))
    assert display.draw(1) is first
    robot.turn(1.0)
    display.see(robot.buffer.all_in("odom"))
    moved = display.draw(2)
    assert moved["frames"] is not first["frames"]
    assert moved["names/wheel"] is first["names/wheel"]


def test_who_creeps_is_drawn_anew_when_he_has_come_far_enough():
    robot = Robot()
    display = shown(robot)
    drawings = {id(display.draw(0)): display.draw(0)}
    for step in range(1, 101):
        robot.clock.now_ns += S // 100
        robot.turn(math.pi / 2 + step * 1e-7)
        display.see(robot.buffer.all_in("odom"))
        drawings[id(display.draw(0))] = display.draw(0)
    assert 3 < len(drawings) < 30


def test_a_frame_without_news_turns_grey_then_fades_then_is_gone():
    robot = Robot()

    def after(age_s: float) -> Drawing:
        display = TfDisplay(TYPES)
        now_ns = robot.clock.now_ns + round(age_s * S)
        display.see(robot.buffer.all_in("odom", now_ns=now_ns))
        return display.draw(0)

    assert "old_axes" not in after(5.0)["frames"].shapes
    # Of a third of 15 s, half of it to grey.
    greyed = after(7.5)
    assert len(axes_of(greyed).positions) == 1
    old = solids_of(greyed, "old_axes")
    assert old.opacities == 1.0
    assert sorted(old.colors[:3].tolist()) == [[89, 89, 217], [89, 217, 89], [217, 89, 89]]
    assert greyed["names/wheel"].shapes["name"] == Text("wheel", rgb=(217, 217, 217))
    faded = solids_of(after(12.5), "old_axes")
    assert isinstance(faded.opacities, np.ndarray)
    assert faded.opacities.tolist() == [0.5] * 6
    assert faded.colors.tolist() == [[179, 179, 179]] * 6
    assert names_in(after(15.1)) == {"odom"}


def test_an_axis_of_a_faded_cross_lies_along_its_frame():
    robot = Robot()
    display = TfDisplay(TYPES)
    display.see(robot.buffer.all_in("odom", now_ns=robot.clock.now_ns + 9 * S))
    old = solids_of(display.draw(0), "old_axes")
    base = [row for row in range(6) if abs(float(old.positions[row, 0]) - 2.0) < 0.15
            and abs(float(old.positions[row, 1]) - 1.0) < 0.15]  # fmt: skip
    from_base = [(old.positions[row] - (2.0, 1.0, 0.0)).round(5).tolist() for row in base]
    # Its x points to y of odom, since it turned left; its y points back.
    assert from_base == [[0.0, 0.1, 0.0], [-0.1, 0.0, 0.0], [0.0, 0.0, 0.1]]


def test_frames_are_chosen_by_patterns_and_by_name():
    display = shown(Robot())
    display.set("Filter (whitelist)", "^(odom|wheel)$")
    assert names_in(display.draw(0)) == {"odom", "wheel"}
    display.set("Filter (blacklist)", "wh")
    assert names_in(display.draw(0)) == {"odom"}
    display.set("Filter (blacklist)", "")
    display.set("Filter (whitelist)", "")
    display.set("Frames/base", value=False)
    assert names_in(display.draw(0)) == {"odom", "wheel"}
    display.set("Frames", value=False)
    assert display.draw(0) == {}
    display.set("Frames/wheel", value=True)
    assert names_in(display.draw(0)) == {"wheel"}
    display.set("Frames", value=True)
    assert names_in(display.draw(0)) == {"odom", "base", "wheel"}


def test_each_frame_has_a_check_from_when_it_is_there():
    display = TfDisplay(TYPES, {"Frames/base": False})
    fixed = len(display.properties())
    display.see(Robot().buffer.all_in("odom"))
    added = [one.name for one in display.properties()[fixed:]]
    every = ("base", "camera", "lens", "odom", "wheel")
    assert added == [f"{kind}/{name}" for kind in ("Frames", "Trails") for name in every]
    assert names_in(display.draw(0)) == {"odom", "wheel"}
    display.set("Frames", value=False)
    assert [one.default for one in display.properties()[fixed:]] == [False] * 10


def test_frames_leave_trails_for_as_long_as_is_set():
    robot = Robot()
    display = TfDisplay(TYPES, {"Trails/base": True, "Trail Time": 2.0})

    def go_to(x: float, at_s: int) -> Lines | None:
        told = Told("odom", "base", robot.clock.now_ns, (x, 1.0, 0.0))
        robot.clock.now_ns += S
        robot.buffer.put(columns(told))
        display.see(robot.buffer.all_in("odom"))
        found = frames_of(display.draw(at_s * S)).shapes.get("trails")
        assert found is None or isinstance(found, Lines)
        return found

    assert go_to(2.0, 10) is None
    way = go_to(3.0, 11)
    assert way is not None
    np.testing.assert_allclose(way.ends, [[[2, 1, 0], [3, 1, 0]]])
    way = go_to(4.0, 12)
    assert way is not None
    assert len(way.ends) == 2
    assert go_to(4.001, 12) is way
    way = go_to(5.0, 14)
    assert way is not None
    np.testing.assert_allclose(way.ends, [[[4, 1, 0], [5, 1, 0]]])
    display.see(robot.buffer.all_in("base"))
    assert "trails" not in frames_of(display.draw(14 * S)).shapes
    display.set("Trails", value=False)
    assert go_to(6.0, 15) is None


def test_ages_are_written_and_coloured_from_green_to_red():
    robot = Robot()
    display = shown(robot, Show_Ages=True)

    def name_of(frame: str) -> Text:
        text = display.draw(0)[f"names/{frame}"].shapes["name"]
        assert isinstance(text, Text)
        return text

    assert (name_of("base").text, name_of("base").rgb) == ("base", (90, 220, 130))
    display.see(robot.buffer.all_in("odom", now_ns=robot.clock.now_ns + 9 * S))
    fresh, old = name_of("odom"), name_of("base")
    assert (fresh.text, old.text) == ("odom", "base (9 s)")
    assert old.rgb[0] > 150 > old.rgb[1]
    docs = {one.name: one.doc for one in display.properties()}
    assert docs["Frames/base"] == "Shows this frame; its oldest transform came 9 s ago."


def test_a_pattern_that_is_none_is_refused_and_the_former_stays():
    display = shown(Robot())
    display.set("Filter (whitelist)", "base")
    with pytest.raises(DisplayPropertyError, match=r"Filter \(whitelist\) .* not closed"):
        display.set("Filter (whitelist)", "(base")
    assert names_in(display.draw(0)) == {"base"}
    with pytest.raises(DisplayPropertyError):
        TfDisplay(TYPES, {"Filter (blacklist)": "("})


@pytest.mark.parametrize(
    ("values", "status"),
    [
        ({"Marker Alpha": 0.0}, ("warn", "transparent")),
        ({"Filter (whitelist)": "nowhere"}, ("warn", "empty")),
        ({"Filter (blacklist)": "."}, ("warn", "empty")),
        ({"Frames": False}, ("warn", "empty")),
    ],
)
def test_why_no_frame_is_seen_is_told_with_what_mends_it(
    values: dict[str, Value], status: tuple[str, str]
):
    display = TfDisplay(TYPES, values)
    display.see(Robot().buffer.all_in("odom"))
    assert display.draw(0) == {}
    assert said(display) == [status]
    (told,) = display.statuses()
    assert told.mend is not None
    display.set(*told.mend)
    assert display.draw(0)


def test_frames_of_another_tree_are_told():
    display = shown(Robot())
    display.draw(0)
    (told,) = display.statuses()
    assert (told.level, told.reason) == ("error", "not_connected_frame")
    assert told.sentence == "Nothing connects camera, lens with odom."
    display.set("Frames/camera", value=False)
    display.set("Frames/lens", value=False)
    assert display.statuses() == ()


def test_before_any_transform_came_that_is_told():
    display = TfDisplay(TYPES)
    assert display.draw(0) == {}
    assert said(display) == [("warn", "empty")]
    display.see(Robot().buffer.all_in("odom"))
    assert display.draw(0)
    display.reset()
    assert display.draw(0) == {}


def test_many_frames_are_drawn_and_so_many_names_are_written():
    buffer = TransformBuffer()
    count = 3 * NAMES_MAX
    buffer.put(columns(*(Told("map", f"f{at}", S, (float(at), 0.0, 0.0)) for at in range(count))))
    display = TfDisplay(TYPES)
    display.see(buffer.all_in("map"))
    drawing = display.draw(0)
    assert len(axes_of(drawing).positions) == count + 1
    assert len(names_in(drawing)) == NAMES_MAX
    assert said(display) == [("warn", "unsupported")]


def test_places_at_the_end_of_the_world_are_drawn_or_left_out():
    buffer = TransformBuffer()
    for at in range(3):
        buffer.put(columns(Told(f"f{at}", f"f{at + 1}", S, (1e12, -1e12, 1e12))))
    display = TfDisplay(TYPES)
    display.see(buffer.all_in("f0"))
    assert_drawable(display.draw(0))


def test_settings_of_frames_are_bounded():
    display = TfDisplay(TYPES)
    others = len(display.values)
    for number in range(25_000 - others):
        display.set(f"Frames/{number}", value=False)
    with pytest.raises(DisplayPropertyError, match="one too many"):
        display.set("Frames/more", value=False)
    display.set("Frames/0", value=True)


def test_without_names_axes_and_arrows_it_says_what_would_show_frames():
    display = shown(Robot(), Show_Names=False, Show_Axes=False, Show_Arrows=False)
    assert not display.draw(0)
    (status,) = display.statuses()
    assert (status.level, status.reason, status.mend) == ("warn", "empty", ("Show Axes", True))
    display.set("Show Axes", value=True)
    assert frames_of(display.draw(0)).shapes
