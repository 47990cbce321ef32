from __future__ import annotations

import pytest

from studio.cli.message_text import field_at, field_text
from studio.errors import MessageValueError
from studio.ros.types.convert import Brevity, from_dict
from studio.ros.types.library import TypeLibrary

TYPES = TypeLibrary("jazzy")
STATE = from_dict(
    TYPES.message("sensor_msgs/msg/JointState"),
    {"header": {"frame_id": "base"}, "name": ["a", "b"], "position": [1.0, -2.5]},
)


@pytest.mark.parametrize(
    ("path", "said"),
    [
        ("header.frame_id", "base"),
        ("header.stamp", "sec: 0\nnanosec: 0"),
        ("name", "['a', 'b']"),
        ("name[1]", "b"),
        ("position[-1]", "-2.5"),
        ("position", "[1.0, -2.5]"),
        ("velocity", "[]"),
    ],
)
def test_a_path_leads_to_a_field(path: str, said: str):
    assert field_text(field_at(STATE, path)) == said


@pytest.mark.parametrize(
    "path",
    ["no", "header.no", "name.no", "name[2]", "position[-3]", "header[0]", "", ".", "name[x]",
     "name[" + "9" * 5_000 + "]", "__class__"],
)  # fmt: skip
def test_a_path_that_leads_nowhere_is_said(path: str):
    with pytest.raises(MessageValueError):
        field_at(STATE, path)


def test_long_lists_are_cut():
    assert field_text([1, 2, 3], Brevity(length_max=2)) == "[1, 2, ...]"
    assert field_text([1, 2, 3], Brevity(no_arrays=True)) == "<sequence, length: 3>"


def test_messages_in_a_list_are_written_in_one_line():
    path = from_dict(TYPES.message("geometry_msgs/msg/Polygon"), {"points": [{"x": 1.5}]})
    assert field_text(field_at(path, "points")) == "[{x: 1.5, y: 0.0, z: 0.0}]"
    assert field_text(field_at(path, "points[0].x")) == "1.5"
