from __future__ import annotations

import numpy as np
import pytest

from studio.displays import robot_model
from studio.displays.display import Received
from studio.displays.drawing import NOTHING, Arrows, Axes, Lines, LinkParts
from studio.displays.robot_model import RobotModelDisplay
from studio.errors import CdrError, DisplayError, DisplayMessageError, DisplayPropertyError
from studio.robot.urdf_text import robot_from_urdf
from studio.robot.values import Link, Origin, Robot, Sphere, Visual
from studio.ros.cdr import codec_of
from studio.tf.buffer import TransformBuffer
from tests.support.display_messages import TYPES
from tests.support.transforms import Told, columns

STRING = "std_msgs/msg/String"
BALL = Visual(Origin(), Sphere(0.1))
BOTH_ORDERS = pytest.mark.parametrize("little", [True, False], ids=["little", "big"])


def described(text: str, *, little: bool = True) -> Received:
    kind = TYPES.message(STRING)
    return Received(STRING, bytes(codec_of(kind).encode(kind(data=text), little_endian=little)), 0)


ROVER = robot_from_urdf(
    """<robot name="rover"><link name="base"/><link name="wheel"/><link name="tool/Alpha"/>
    <joint name="a" type="fixed"><parent link="base"/><child link="wheel"/></joint>
    <joint name="b" type="fixed"><parent link="base"/><child link="tool/Alpha"/></joint></robot>"""
)


def rover(**values: object) -> RobotModelDisplay:
    display = RobotModelDisplay(TYPES)
    display.show(ROVER)
    for name, value in values.items():
        display.set(name.replace("_", " "), value)
    return display


@BOTH_ORDERS
def test_the_description_of_the_topic_is_kept_whatever_jumps(little: bool):
    display = RobotModelDisplay(TYPES)
    assert display.description == ""
    display.take(described(" \n<robot name='ü'/>", little=little))
    display.reset()
    assert display.description == " \n<robot name='ü'/>"


@pytest.mark.parametrize("text", ["", "no robot", "x" * 50])
def test_a_text_that_is_no_description_leaves_the_one_before(
    text: str, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(robot_model, "DESCRIPTION_MAX", 40)
    display = RobotModelDisplay(TYPES)
    display.take(described("<robot/>"))
    with pytest.raises(DisplayMessageError, match=r"^The description cannot be drawn: .*\.$"):
        display.take(described(text))
    with pytest.raises(CdrError):
        display.take(Received(STRING, b"\0\1\0\0\xff\xff\xff\xff", 0))
    assert display.description == "<robot/>"


def parts(display: RobotModelDisplay) -> dict[str, LinkParts]:
    """What is drawn of each link."""
    drawn = display.draw(0)
    found = {link: placed.shapes.get("link") for link, placed in drawn.items()}
    return {link: shape for link, shape in found.items() if isinstance(shape, LinkParts)}


def test_at_first_all_links_are_shown_as_they_look_at_frames_of_their_names():
    drawn = rover().draw(0)
    assert [(link, placed.frame) for link, placed in drawn.items()] == [
        (link, link) for link in ("base", "wheel", "tool/Alpha")
    ]
    assert all(placed.follows and placed.stamp_ns == 0 for placed in drawn.values())
    for link, shape in parts(rover()).items():
        assert (shape.link.name, shape.opacity) == (link, 1.0)
        assert (shape.visual, shape.collision, shape.mass, shape.inertia) == (
            (True, False, False, False)
        )


def test_what_is_switched_on_is_drawn():
    display = rover(Visual_Enabled=False, Collision_Enabled=True)
    display.set("Mass Properties/Inertia", value=True)
    [shape, *_] = parts(display).values()
    assert (shape.visual, shape.collision, shape.mass, shape.inertia) == (
        (False, True, False, True)
    )


@pytest.mark.parametrize("prefix", ["r1", "r1/", "/r1/"])
def test_a_prefix_stands_before_each_frame_with_one_slash(prefix: str):
    assert rover(TF_Prefix=prefix).draw(0)["base"].frame == "r1/base"


def test_alpha_of_a_link_counts_with_that_of_the_robot():
    display = rover(Alpha=0.5)
    display.set("Links/wheel/Alpha", 0.5)
    opacities = {link: shape.opacity for link, shape in parts(display).items()}
    assert opacities == {"base": 0.5, "wheel": 0.25, "tool/Alpha": 0.5}
    display.set("Links/wheel/Alpha", 0.0)
    assert list(parts(display)) == ["base", "tool/Alpha"]


def test_links_are_switched_one_by_one_and_all_at_once():
    display = rover()
    display.set("Links/tool/Alpha", value=False)
    assert list(display.draw(0)) == ["base", "wheel"]
    display.set("Links/All Links Enabled", value=False)
    assert display.draw(0) == NOTHING


def test_only_what_is_shown_of_a_link_asks_for_its_meshes():
    robot = robot_from_urdf(
        """<robot name="r"><link name="l">
        <visual><geometry><mesh filename="package://p/looks.dae"/></geometry></visual>
        <collision><geometry><mesh filename="package://p/touch.stl"/></geometry></collision>
        </link></robot>"""
    )
    link = robot.links["l"]
    assert LinkParts(link, robot).mesh_uris() == {"package://p/looks.dae"}
    assert LinkParts(link, robot, visual=False, collision=True).mesh_uris() == {
        "package://p/touch.stl"
    }


def test_each_link_that_is_known_has_properties():
    assert [one.name for one in RobotModelDisplay(TYPES).properties()][-1] == (
        "Links/All Links Enabled"
    )
    display = rover()
    names = [one.name for one in display.properties()]
    links = [one for one in names if one.startswith("Links/base")]
    assert links == [f"Links/base{part}" for part in ("", "/Alpha", "/Show Axes", "/Show Trail")]
    joints = [one for one in names if one.startswith("Joints/")]
    assert joints == [f"Joints/{name}" for name in
                      ("a/Joint", "a/Show Axes", "b/Joint", "b/Show Axes")]  # fmt: skip
    for one in display.properties():
        assert one.kind == "fact" or one.checked(one.default) == one.default
    names = [f"link{number}" for number in range(5000)]
    display.show(Robot("large", {name: Link(name) for name in names}))
    assert len(display.properties()) == len(display.PROPERTIES) + 4 * robot_model.LINKS_MAX
    assert display.statuses()[0].sentence == "3,000 links are left out: 2,000 are shown at most."


def test_what_was_saved_of_a_link_counts_when_it_comes(monkeypatch: pytest.MonkeyPatch):
    display = RobotModelDisplay(TYPES, {"Links/base": False, "Links/wheel/Alpha": 0.2})
    display.show(ROVER)
    assert parts(display)["wheel"].opacity == 0.2
    assert "base" not in display.draw(0)
    monkeypatch.setattr(display, "SETTINGS_MAX", 1)
    with pytest.raises(DisplayPropertyError, match="one too many"):
        display.set("Links/more", value=False)


def test_axes_of_links_follow_their_frames():
    display = rover(TF_Prefix="r1")
    display.set("Links/wheel/Show Axes", value=True)
    placed = display.draw(0)["wheel"]
    assert (placed.frame, placed.follows) == ("r1/wheel", True)
    axes = placed.shapes["axes"]
    assert isinstance(axes, Axes)
    assert (axes.length_m, axes.radius_m) == (0.1, 0.01)
    assert display.draw(1) is display.draw(2)
    display.set("Links/wheel", value=False)
    assert "wheel" not in display.draw(0)


def test_it_listens_to_a_topic_only_as_long_as_its_description_comes_from_there():
    display = rover()
    assert display.roles() == display.TOPICS
    display.set("Description Source", "Parameter")
    assert display.roles() == ()
    assert display.source == ("Parameter", "/robot_state_publisher", "robot_description")
    display.set("Description Source", "File")
    display.set("Description File", " package://p/robot.urdf ")
    assert display.source == ("File", "package://p/robot.urdf", "")


def test_its_interval_is_told_in_nanoseconds():
    assert rover().interval_ns == 0
    assert rover(Update_Interval=0.5).interval_ns == 500_000_000


def test_a_fault_of_the_description_is_told_and_what_was_there_stays():
    display = rover()
    display.fail("The description cannot be shown: it ends too early.")
    [status] = display.statuses()
    assert status.sentence == "The description cannot be shown: it ends too early."
    assert len(display.draw(0)) == 3
    display.fail("")
    assert display.statuses() == ()


def test_a_description_that_is_being_read_is_told_to_be_on_its_way():
    display = RobotModelDisplay(TYPES)
    assert display.statuses() == ()
    display.take(described("<robot name='r'/>"))
    [status] = display.statuses()
    assert status.sentence == "The description of the robot is on its way."


@pytest.mark.parametrize(
    ("links", "said"),
    [
        ({"x" * 301: Link("x" * 301)}, "a name of 301 letters"),
        ({"l": Link("l", (BALL,) * (robot_model.PARTS_MAX + 1))}, "10,001 shapes"),
    ],
)
def test_what_is_more_than_can_be_drawn_is_refused_and_what_was_there_stays(
    links: dict[str, Link], said: str
):
    display = rover()
    with pytest.raises(DisplayError, match=said):
        display.show(Robot("large", links))
    assert display.robot is ROVER


@pytest.mark.parametrize(
    ("off", "mend"),
    [
        (["Alpha"], ("Alpha", 1.0)),
        (["Visual Enabled"], ("Visual Enabled", True)),
        (["Links/All Links Enabled"], ("Links/All Links Enabled", True)),
        (["Links/base", "Links/wheel", "Links/tool/Alpha"], ("Links/base", True)),
    ],
)
def test_settings_that_hide_the_robot_are_told_with_what_shows_it(
    off: list[str], mend: tuple[str, object]
):
    display = rover()
    assert display.statuses() == ()
    for name in off:
        display.set(name, 0.0 if name == "Alpha" else False)
    [status] = display.statuses()
    assert status.mend == mend
    display.set(*mend)
    assert display.statuses() == ()


ARM = robot_from_urdf(
    """<robot name="arm"><link name="base"/><link name="hand"/><link name="pole"/>
    <joint name="turn" type="revolute"><parent link="base"/><child link="hand"/>
      <origin xyz="1 2 3" rpy="0 0 1.5707963"/><axis xyz="0 2 0"/>
      <limit lower="-0.5" upper="1.25" effort="1" velocity="1"/></joint>
    <joint name="mount" type="fixed"><parent link="base"/><child link="pole"/></joint></robot>"""
)


def test_a_joint_says_what_it_is_and_shows_its_axis_where_it_is_mounted():
    display = RobotModelDisplay(TYPES)
    display.show(ARM)
    facts = {one.name: one.default for one in display.properties() if one.kind == "fact"}
    assert facts == {
        "Joints/turn/Joint": "revolute, axis 0 2 0, -0.5 to 1.25 rad",
        "Joints/mount/Joint": "fixed",
    }
    assert "Joints/mount/Show Joint Axis" not in {one.name for one in display.properties()}
    display.set("Joints/turn/Show Joint Axis", value=True)
    display.set("Joints/turn/Show Axes", value=True)
    placed = display.draw(0)[" joints/turn"]
    assert (placed.frame, placed.follows) == ("base", True)
    assert placed.offset is not None
    assert placed.offset[1] == (1.0, 2.0, 3.0)
    assert placed.offset[0] == pytest.approx((2**-0.5, 0, 0, 2**-0.5))
    arrow, cross = placed.shapes["axis"], placed.shapes["axes"]
    assert isinstance(arrow, Arrows)
    assert isinstance(cross, Axes)
    np.testing.assert_allclose(arrow.ends, [[[0, 0, 0], [0, 0.2, 0]]], atol=1e-6)
    with pytest.raises(DisplayPropertyError, match="cannot be set"):
        display.set("Joints/turn/Joint", "prismatic")


def test_a_link_leaves_a_trail_of_two_metres():
    display = RobotModelDisplay(TYPES, {"TF Prefix": "r1"})
    display.show(ARM)
    display.set("Links/hand/Show Trail", value=True)
    assert display.wants_frames
    buffer = TransformBuffer()

    def go_to(x: float) -> Lines | None:
        buffer.put(columns(Told("map", "r1/hand", 0, (x, 0.0, 0.0))), static=True)
        display.see(buffer.all_in("map"))
        drawing = display.draw(0)
        assert display.draw(0) is drawing
        found = drawing[" trails"].shapes["lines"] if " trails" in drawing else None
        assert found is None or isinstance(found, Lines)
        return found

    assert go_to(0.0) is None
    for at in range(1, 40):
        go_to(at / 10)
    way = go_to(4.0)
    assert way is not None
    assert way.ends[0, 0, 0] == pytest.approx(2.0, abs=1e-5)
    assert (way.ends[-1, 1, 0], way.width_m) == (4.0, 0.01)
    assert go_to(4.001) is way
    display.set("Links/hand/Show Trail", value=False)
    assert not display.wants_frames
    assert " trails" not in display.draw(0)
