from __future__ import annotations

import pytest

from studio.displays import robot_model
from studio.displays.display import Received
from studio.displays.drawing import NOTHING, Axes
from studio.displays.robot_model import RobotModelDisplay
from studio.errors import CdrError, DisplayMessageError, DisplayPropertyError
from studio.ros.cdr import Codec
from tests.support.display_messages import TYPES

STRING = "std_msgs/msg/String"
BOTH_ORDERS = pytest.mark.parametrize("little", [True, False], ids=["little", "big"])


def described(text: str, *, little: bool = True) -> Received:
    kind = TYPES.message(STRING)
    return Received(STRING, bytes(Codec(kind).encode(kind(data=text), little_endian=little)), 0)


def rover(**values: object) -> RobotModelDisplay:
    display = RobotModelDisplay(TYPES)
    display.know_links(["base", "wheel", "tool/Alpha"])
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


def test_at_first_all_links_are_shown_as_they_look_at_frames_of_their_names():
    look = rover().look()
    assert (look.visual, look.collision, look.mass, look.inertia) == (True, False, False, False)
    assert look.opacities == {"base": 1.0, "wheel": 1.0, "tool/Alpha": 1.0}
    assert look.frames == {"base": "base", "wheel": "wheel", "tool/Alpha": "tool/Alpha"}


@pytest.mark.parametrize("prefix", ["r1", "r1/", "/r1/"])
def test_a_prefix_stands_before_each_frame_with_one_slash(prefix: str):
    assert rover(TF_Prefix=prefix).look().frames["base"] == "r1/base"


def test_alpha_of_a_link_counts_with_that_of_the_robot():
    display = rover(Alpha=0.5)
    display.set("Links/wheel/Alpha", 0.5)
    assert display.look().opacities == {"base": 0.5, "wheel": 0.25, "tool/Alpha": 0.5}


def test_links_are_switched_one_by_one_and_all_at_once():
    display = rover()
    display.set("Links/tool/Alpha", value=False)
    assert list(display.look().opacities) == ["base", "wheel"]
    display.set("Links/All Links Enabled", value=False)
    assert display.look().opacities == {}


def test_each_link_that_is_known_has_properties():
    assert [one.name for one in RobotModelDisplay(TYPES).properties()][-1] == (
        "Links/All Links Enabled"
    )
    display = rover()
    names = [one.name for one in display.properties()]
    assert names[-9:-6] == ["Links/base", "Links/base/Alpha", "Links/base/Show Axes"]
    for one in display.properties():
        assert one.checked(one.default) == one.default
    display.know_links(f"link{number}" for number in range(5000))
    assert len(display.properties()) == len(display.PROPERTIES) + 3 * robot_model.LINKS_MAX


def test_what_was_saved_of_a_link_counts_when_it_comes(monkeypatch: pytest.MonkeyPatch):
    display = RobotModelDisplay(TYPES, {"Links/base": False, "Links/wheel/Alpha": 0.2})
    display.know_links(["base", "wheel"])
    assert display.look().opacities == {"wheel": 0.2}
    monkeypatch.setattr(display, "SETTINGS_MAX", 1)
    with pytest.raises(DisplayPropertyError, match="one too many"):
        display.set("Links/more", value=False)


def test_axes_of_links_follow_their_frames():
    display = rover(TF_Prefix="r1")
    assert display.draw(0) == NOTHING
    display.set("Links/wheel/Show Axes", value=True)
    [placed] = display.draw(0).values()
    assert (placed.frame, placed.follows) == ("r1/wheel", True)
    axes = placed.shapes["axes"]
    assert isinstance(axes, Axes)
    assert (axes.length_m, axes.radius_m) == (0.1, 0.01)
    assert display.draw(1) is display.draw(2)
    display.set("Links/wheel", value=False)
    assert display.draw(0) == NOTHING


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
