from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import TransformError, UnconnectedFramesError, UnknownFrameError
from studio.tf.tree import FRAMES_MAX, TransformTree

NUMBERS = st.floats(-100, 100)
PLACES = st.tuples(NUMBERS, NUMBERS, NUMBERS)
TURNS = st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda turn: math.hypot(*turn) > 0.1)
QUARTER_LEFT = (0.0, 0.0, math.sin(math.pi / 4), math.cos(math.pi / 4))
Numbers = tuple[float, ...]


def test_a_point_goes_up_one_branch_and_down_another():
    tree = TransformTree()
    tree.put("map", "base", (1.0, 0.0, 0.0), QUARTER_LEFT)
    tree.put("base", "laser", (0.5, 0.0, 0.2), (0.0, 0.0, 0.0, 1.0))
    tree.put("map", "door", (0.0, 3.0, 0.0), (0.0, 0.0, 0.0, 2.0))
    in_door = tree.target_from_source("door", "laser") @ (1.0, 0.0, 0.0, 1.0)
    assert in_door == pytest.approx([1.0, -1.5, 0.2, 1.0], abs=1e-12)
    assert tree.frames() == ["base", "door", "laser", "map"]


@given(PLACES, TURNS, PLACES, TURNS)
def test_there_and_back_is_nowhere(place: Numbers, turn: Numbers, other: Numbers, turned: Numbers):
    tree = TransformTree()
    tree.put("a", "b", place, turn)
    tree.put("b", "c", other, turned)
    there_and_back = tree.target_from_source("a", "c") @ tree.target_from_source("c", "a")
    assert there_and_back == pytest.approx(np.eye(4), abs=1e-9)
    step_by_step = tree.target_from_source("a", "b") @ tree.target_from_source("b", "c")
    assert tree.target_from_source("a", "c") == pytest.approx(step_by_step, abs=1e-9)


def test_the_newest_transform_holds_also_under_another_parent():
    tree = TransformTree()
    tree.put("a", "b", (1.0, 0.0, 0.0), QUARTER_LEFT)
    tree.put("a", "b", (2.0, 0.0, 0.0), QUARTER_LEFT)
    assert tree.target_from_source("a", "b")[0, 3] == 2.0
    tree.put("/c", "/b", (3.0, 0.0, 0.0), QUARTER_LEFT)
    assert tree.target_from_source("c", "b")[0, 3] == 3.0
    with pytest.raises(UnknownFrameError, match='"a"'):
        tree.target_from_source("a", "b")


def test_two_trees_and_a_circle_connect_nothing():
    tree = TransformTree()
    tree.put("a", "b", (1.0, 0.0, 0.0), QUARTER_LEFT)
    tree.put("c", "d", (1.0, 0.0, 0.0), QUARTER_LEFT)
    with pytest.raises(UnconnectedFramesError, match="publish the one that is missing"):
        tree.target_from_source("a", "d")
    tree.put("b", "a", (1.0, 0.0, 0.0), QUARTER_LEFT)
    with pytest.raises(UnconnectedFramesError):
        tree.target_from_source("a", "d")


@pytest.mark.parametrize(
    ("parent", "place", "turn", "reason"),
    [
        ("a", (math.nan, 0.0, 0.0), QUARTER_LEFT, "finite"),
        ("a", (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0), "zero"),
        ("a", (0.0, 0.0, 0.0), (0.0, math.inf, 0.0, 0.0), "finite"),
        ("b", (0.0, 0.0, 0.0), QUARTER_LEFT, "two frames"),
        ("", (0.0, 0.0, 0.0), QUARTER_LEFT, "two frames"),
    ],
)
def test_what_is_no_transform_is_left_out(parent: str, place: Numbers, turn: Numbers, reason: str):
    tree = TransformTree()
    with pytest.raises(TransformError, match=reason):
        tree.put(parent, "b", place, turn)
    assert tree.frames() == []


def test_there_are_so_many_frames_and_no_more():
    tree = TransformTree()
    for number in range(FRAMES_MAX):
        tree.put("map", f"f{number}", (0.0, 0.0, 0.0), QUARTER_LEFT)
    with pytest.raises(TransformError, match="frames already"):
        tree.put("map", "one more", (0.0, 0.0, 0.0), QUARTER_LEFT)
    tree.put("map", "f7", (5.0, 0.0, 0.0), QUARTER_LEFT)
    assert tree.target_from_source("map", "f7")[0, 3] == 5.0
