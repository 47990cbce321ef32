from __future__ import annotations

import math

import pytest

from studio.errors import RosArgumentError
from studio.nodes.static_transform_publisher import read_wanted
from tests.support.command_line import started, studio

HALF = math.sqrt(0.5)


@pytest.mark.parametrize(
    ("words", "xyz", "xyzw"),
    [
        ("--frame-id a --child-frame-id b", (0, 0, 0), (0, 0, 0, 1)),
        (f"--x 1 --z -2.5 --yaw {math.pi / 2} --frame-id a --child-frame-id b",
         (1, 0, -2.5), (0, 0, HALF, HALF)),
        ("--qz 2 --qw 2 --frame-id a --child-frame-id b", (0, 0, 0), (0, 0, HALF, HALF)),
        ("--frame-id a --child-frame-id b --roll 3.141592653589793", (0, 0, 0), (1, 0, 0, 0)),
        (f"1 2 3 {math.pi / 2} 0 0 a b", (1, 2, 3), (0, 0, HALF, HALF)),
        ("1 2 3 0 0 -1 1 a b", (1, 2, 3), (0, 0, -HALF, HALF)),
    ],
)  # fmt: skip
def test_all_forms_of_the_arguments_are_read(
    words: str, xyz: tuple[float, ...], xyzw: tuple[float, ...]
):
    found = read_wanted(words.split())
    assert (found.parent, found.child) == ("a", "b")
    assert found.xyz == xyz
    assert found.xyzw == pytest.approx(xyzw, abs=1e-12)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("", "--frame-id"),
        ("--frame-id a", "--child-frame-id"),
        ("--yaw 1 --qx 1 --frame-id a --child-frame-id b", "not both"),
        ("1 2 3 0 0 0 0 a b", "has no direction"),
        ("1 2 3 0 0 nan a b", "not finite"),
        ("1 2 3 x 0 0 a b", "are not all numbers"),
        ("--frame-id a --child-frame-id a", "both frames are a"),
        ("--x one --frame-id a --child-frame-id b", "invalid float value"),
        ("1 2 3", "arguments are required"),
    ],
)
def test_what_makes_no_transform_is_refused(words: str, said: str):
    with pytest.raises(RosArgumentError, match=said):
        read_wanted(words.split())


def test_it_is_started_by_its_name_in_ros_and_keeps_its_transform(endpoint: str):
    at = ("--connect", endpoint)
    words = ("--z", "0.5", "--frame-id", "base", "--child-frame-id", "laser")
    with started(endpoint, "run", "tf2_ros", "static_transform_publisher", *words, *at) as node:
        node.wait_for("from 'base' to 'laser'")
        ran = studio("topic", "echo", "/tf_static", "--once", *at)
        assert "child_frame_id: laser" in ran.out
        assert "z: 0.5" in ran.out
