from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.errors import MessageValueError
from studio.ros.types.convert import Brevity, from_dict, from_yaml, to_csv, to_dict, to_yaml
from studio.ros.types.library import TypeLibrary
from tests.support.ros_values import values_of

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue

LIBRARY = TypeLibrary("jazzy")


def made(name: str) -> type[MessageValue]:
    return LIBRARY.message(name)


TWIST = made("geometry_msgs/msg/Twist")
STATE = made("sensor_msgs/msg/JointState")


def test_a_message_is_printed_as_ros2_topic_echo_does():
    value = STATE(name=["a"], position=[1, 2.5])
    assert to_yaml(value) == (
        "header:\n  stamp:\n    sec: 0\n    nanosec: 0\n  frame_id: ''\n"
        "name:\n- a\nposition:\n- 1.0\n- 2.5\nvelocity: []\neffort: []\n"
    )
    assert to_csv(value) == "0,0,,a,1.0,2.5"


@pytest.mark.parametrize("text", ['"\\x02"', "!!binary Ag==", "2"])
def test_a_byte_is_read_as_ros2_topic_echo_writes_it_too(text: str):
    assert from_yaml(made("diagnostic_msgs/msg/DiagnosticStatus"), f"level: {text}").level == 2


@pytest.mark.parametrize("text", ["ab", "''", "\u2603", "!!binary AAE=", "256", "-1", "1.5"])
def test_what_is_no_byte_is_refused(text: str):
    with pytest.raises(MessageValueError, match="level"):
        from_yaml(made("diagnostic_msgs/msg/DiagnosticStatus"), f"level: {text}")


@pytest.mark.parametrize("text", ["a\x85 b", "\u2028", " \r\n", "\ufeff", "yes", "1e3", "- a", ""])
def test_odd_texts_read_back(text: str):
    string = made("std_msgs/msg/String")
    assert from_yaml(string, to_yaml(string(data=text))).data == text


def test_what_is_left_out_is_told():
    value = STATE(name=["abcdef"], position=[1, 2, 3])
    brief = to_dict(value, Brevity(no_arrays=True))
    assert brief["position"] == "<sequence type: double, length: 3>"
    assert brief["name"] == "<sequence type: string, length: 1>"
    cut = to_dict(value, Brevity(length_max=2))
    assert cut["position"] == [1.0, 2.0, "..."]
    assert cut["name"] == ["ab..."]
    text = made("std_msgs/msg/String")(data="abc")
    assert to_dict(text, Brevity(no_texts=True)) == {"data": "<string length: <3>>"}
    covariance = made("geometry_msgs/msg/PoseWithCovariance")()
    assert to_dict(covariance, Brevity(no_arrays=True))["covariance"] == (
        "<array type: double[36]>"
    )


def test_a_command_line_makes_a_message():
    twist = from_yaml(TWIST, "{linear: {x: -1.5, y: 2}, angular: {z: 1e-3}}")
    assert (twist.linear.x, twist.linear.y, twist.angular.z) == (-1.5, 2.0, 0.001)
    assert from_yaml(TWIST, "") == TWIST()
    assert from_yaml(made("std_msgs/msg/String"), "data: 5").data == "5"


def test_now_and_auto_stand_for_the_time():
    pose = made("geometry_msgs/msg/PoseStamped")
    automatic = from_yaml(pose, "header: auto", now_ns=1_000_000_007)
    assert (automatic.header.stamp.sec, automatic.header.stamp.nanosec) == (1, 7)
    stamped = from_yaml(pose, "header: {stamp: now, frame_id: map}", now_ns=1_000_000_007)
    assert (stamped.header.stamp.nanosec, stamped.header.frame_id) == (7, "map")
    with pytest.raises(MessageValueError):
        from_yaml(pose, "header: auto")


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("{liner: {x: 1}}", "it has no field 'liner', its fields: linear, angular"),
        ("{linear: 5}", "Twist.linear: 5 is no set of fields"),
        ("{linear: {x: a}}", "Twist.linear.x: 'a' is no number"),
        ("{linear: {x: [1]}}", "Twist.linear.x: [1] is no number"),
        ("[1, 2]", "is no set of fields"),
        ("{linear", "is no YAML"),
        ("&a {linear: *a}", "references"),
        ("!!python/object:os.system {}", "is no YAML"),
        ("[" * 5000, "is no YAML"),
        ("2026-99-99", "is no"),
        ("{1: 2}", "it has no field 1"),
        ("{linear: {x: 0x" + "f" * 9000 + "}}", "x: a number too long to show"),
        ("9" * 9000, "is no YAML"),
    ],
)
def test_a_mistake_is_named_with_its_path(text: str, sentence: str):
    with pytest.raises(MessageValueError) as caught:
        from_yaml(TWIST, text)
    assert sentence in str(caught.value)


@pytest.mark.parametrize("text", ["{position: a}", "{position: [a]}", "{name: x}", "{name: [[1]]}"])
def test_lists_are_lists(text: str):
    with pytest.raises(MessageValueError):
        from_yaml(STATE, text)


def test_a_message_may_stand_for_its_fields():
    header = made("std_msgs/msg/Header")(frame_id="map")
    assert from_dict(STATE, {"header": header}).header is header


TYPES = [name for name in LIBRARY.names() if "/msg/" in name]


@settings(max_examples=60)
@given(st.data())
def test_any_message_survives_as_dict_and_as_yaml(data: st.DataObject):
    kind = made(data.draw(st.sampled_from(TYPES)))
    value = data.draw(values_of(kind))
    assert from_dict(kind, to_dict(value)) == value
    assert from_dict(kind, yaml.safe_load(to_yaml(value))) == value


@given(st.text(max_size=60) | st.text(alphabet="{}[]:,linear x-1&*!|>\n\"'", max_size=60))
def test_any_text_is_a_message_or_refused_by_name(text: str):
    try:
        from_yaml(TWIST, text)
    except MessageValueError:
        return
