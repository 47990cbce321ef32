from __future__ import annotations

import itertools
import math
import threading

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from studio.errors import ExtrapolationError, UnconnectedFramesError, UnknownFrameError
from studio.tf.buffer import TransformBuffer
from tests.support.transforms import (
    HandClock,
    PlainTransforms,
    S,
    Told,
    about_z,
    columns,
    matrix_of,
)

PLACES = st.tuples(*[st.floats(-100, 100)] * 3)
TURNS = (
    st.tuples(*[st.floats(-1, 1)] * 4)
    .filter(lambda turn: math.hypot(*turn) > 0.1)
    .map(lambda turn: tuple(part / math.hypot(*turn) for part in turn))
)


@st.composite
def trees(draw: st.DrawFn) -> tuple[list[Told], list[Told], int]:
    """Static and moving transforms of one tree, and a time at which all are known."""
    static: list[Told] = []
    moving: list[Told] = []
    for number in range(draw(st.integers(1, 12))):
        parent = "root" if not number else draw(st.sampled_from(range(-1, number)))
        parent = "root" if parent in ("root", -1) else f"f{parent}"
        if draw(st.booleans()):
            static.append(Told(parent, f"f{number}", 0, draw(PLACES), draw(TURNS)))
            continue
        inner = draw(st.lists(st.integers(1, 9 * S - 1), max_size=6, unique=True))
        stamps_ns = sorted({S, *(one + S for one in inner), 10 * S})
        turns = draw(st.lists(TURNS, min_size=len(stamps_ns), max_size=len(stamps_ns)))
        # Which way is the shorter one between opposite turns is decided by the last digit.
        assume(all(abs(np.dot(one, other)) > 1e-6 for one, other in itertools.pairwise(turns)))
        moving += [
            Told(parent, f"f{number}", stamp_ns, draw(PLACES), turn)
            for stamp_ns, turn in zip(stamps_ns, turns, strict=True)
        ]
    return static, moving, draw(st.integers(S, 10 * S))


def of_a_tree(static: list[Told], moving: list[Told]) -> tuple[TransformBuffer, PlainTransforms]:
    buffer, plain = TransformBuffer(), PlainTransforms()
    assert buffer.put(columns(*static), static=True) == ()
    for told in sorted(moving, key=lambda one: one.stamp_ns):
        assert buffer.put(columns(told)) == ()
    for told in (*static, *moving):
        plain.add(told)
    return buffer, plain


def are_close(ours: list[list[float]], theirs: list[list[float]]) -> bool:
    return bool(np.abs(np.array(ours) - np.array(theirs)).max() <= 1e-9)


@given(trees(), st.data())
@settings(max_examples=60)
def test_every_pose_equals_one_that_was_composed_by_hand(
    tree: tuple[list[Told], list[Told], int], data: st.DataObject
):
    static, moving, stamp_ns = tree
    buffer, plain = of_a_tree(static, moving)
    names = buffer.frames()
    fixed = data.draw(st.sampled_from(names))
    for asked_ns in (stamp_ns, 0):
        frames = buffer.all_in(fixed, asked_ns)
        assert sorted(frames.names) == names
        assert frames.connected.all()
        for name, pose in zip(frames.names, frames.wxyz_xyz.tolist(), strict=True):
            expected = plain.fixed_from(fixed, name, asked_ns or None)
            assert are_close(matrix_of(pose), expected)
            wxyz, xyz, _ = buffer.fixed_from(fixed, name, asked_ns)
            assert are_close(matrix_of((*wxyz, *xyz)), expected)


@given(st.permutations(range(6)))
def test_the_order_of_arrival_does_not_matter_within_the_history(order: list[int]):
    buffer, plain = TransformBuffer(), PlainTransforms()
    rows = [Told("a", "b", at * S, (float(at * at), 0.0, 0.0), about_z(at / 3)) for at in range(6)]
    for at in order:
        buffer.put(columns(rows[at]), publisher=f"{at}")
    for row in rows:
        plain.add(row)
    wxyz, xyz, _ = buffer.fixed_from("a", "b", 3 * S + 7)
    assert are_close(matrix_of((*wxyz, *xyz)), plain.fixed_from("a", "b", 3 * S + 7))


def test_the_newest_time_is_the_one_that_the_whole_way_knows():
    buffer = TransformBuffer()
    for at in range(1, 6):
        buffer.put(columns(Told("odom", "base", at * S, (float(at), 0.0, 0.0))))
    for at in range(1, 4):
        buffer.put(columns(Told("map", "odom", at * S, (0.0, float(at), 0.0))))
    buffer.put(columns(Told("base", "laser", 77 * S)), static=True)
    assert buffer.fixed_from("map", "laser") == ((1, 0, 0, 0), (3.0, 3.0, 0.0), 3 * S)
    assert buffer.fixed_from("odom", "laser").stamp_ns == 5 * S
    assert buffer.fixed_from("base", "laser").stamp_ns == 0
    # All at once, each transform is as new as it can be.
    frames = buffer.all_in("map")
    assert frames.wxyz_xyz[frames.names.index("laser"), 4:].tolist() == [5.0, 3.0, 0.0]


def test_edges_above_both_frames_need_not_be_known():
    buffer = TransformBuffer()
    buffer.put(columns(Told("map", "odom", 1 * S)))
    for at in (5, 6):
        buffer.put(columns(Told("odom", "base", at * S), Told("base", "arm", at * S)))
    buffer.put(columns(Told("odom", "door", 0, (4.0, 0.0, 0.0))), static=True)
    assert buffer.fixed_from("door", "arm", 5 * S + 1).xyz == (-4.0, 0.0, 0.0)
    frames = buffer.all_in("door", 5 * S + 1)
    connected = dict(zip(frames.names, frames.connected.tolist(), strict=True))
    assert connected == {"map": False, "odom": True, "base": True, "arm": True, "door": True}


@pytest.mark.parametrize(
    ("asked_ns", "says", "may_come"),
    [(9 * S, "2.000 s newer than the newest", True), (1 * S, "4.000 s older", False)],
)
def test_a_time_that_is_not_known_is_said(asked_ns: int, says: str, may_come: bool):
    buffer = TransformBuffer()
    for at in (5, 6, 7):
        buffer.put(columns(Told("odom", "base", at * S)))
    with pytest.raises(ExtrapolationError, match=says) as caught:
        buffer.fixed_from("odom", "base", asked_ns)
    error = caught.value
    assert (error.frame, error.asked_ns, error.oldest_ns, error.newest_ns) == (
        "base",
        asked_ns,
        5 * S,
        7 * S,
    )
    assert error.may_come is may_come


def test_one_transform_is_known_at_its_own_time_only_and_a_static_one_always():
    buffer = TransformBuffer()
    buffer.put(columns(Told("a", "b", 5 * S)))
    assert buffer.fixed_from("a", "b", 5 * S).stamp_ns == 5 * S
    with pytest.raises(ExtrapolationError):
        buffer.fixed_from("a", "b", 5 * S + 1)
    buffer.put(columns(Told("a", "c", 5 * S)), static=True)
    assert buffer.fixed_from("a", "c", 10**18).xyz == (0.0, 0.0, 0.0)


def test_ten_seconds_are_kept():
    buffer = TransformBuffer()
    for at in range(31):
        buffer.put(columns(Told("a", "b", at * S, (float(at), 0.0, 0.0))))
    assert buffer.fixed_from("a", "b", 20 * S).xyz[0] == 20.0
    with pytest.raises(ExtrapolationError, match="older"):
        buffer.fixed_from("a", "b", 20 * S - 1)


def test_frames_of_other_trees_and_unknown_ones_are_told_apart():
    buffer = TransformBuffer()
    buffer.put(columns(Told("/map", "/odom", S), Told("base", "arm", S), Told("arm", "hand", S)))
    with pytest.raises(UnconnectedFramesError, match='look from "base"') as caught:
        buffer.fixed_from("map", "hand")
    assert caught.value.nearest == "base"
    with pytest.raises(UnconnectedFramesError, match='publish the pose of "base"'):
        buffer.fixed_from("map", "base")
    with pytest.raises(UnknownFrameError, match='"wheel"'):
        buffer.fixed_from("map", "wheel")
    assert buffer.fixed_from("/nowhere", "nowhere").xyz == (0.0, 0.0, 0.0)
    assert buffer.roots() == ["base", "map"]
    assert buffer.frames() == ["arm", "base", "hand", "map", "odom"]
    assert not buffer.all_in("wheel").connected.any()
    frames = buffer.all_in("odom")
    assert [name for name, is_connected in zip(frames.names, frames.connected, strict=True)
            if is_connected] == ["map", "odom"]  # fmt: skip


def test_the_way_between_two_frames_is_named():
    buffer = TransformBuffer()
    rows = ("map", "base"), ("base", "arm"), ("arm", "hand"), ("base", "wheel")
    buffer.put(columns(*(Told(parent, child, S) for parent, child in rows)))
    assert buffer.chain("wheel", "hand") == ("wheel", "base", "arm", "hand")
    assert buffer.chain("hand", "map") == ("hand", "arm", "base", "map")
    assert buffer.chain("map", "arm") == ("map", "base", "arm")
    assert buffer.chain("arm", "arm") == ("arm",)


def test_frames_that_are_dropped_are_gone_and_their_numbers_are_used_again():
    buffer = TransformBuffer()
    for turn in range(50):
        names = [f"{turn}_{number}" for number in range(5)]
        buffer.put(columns(*(Told("base", name, S, (1.0, 2.0, 3.0)) for name in names)))
        assert buffer.frames() == sorted([*names, "base"])
        poses = buffer.all_in("base").wxyz_xyz
        assert poses[:, 4:].sum() == 30.0
        buffer.drop(names)
        assert buffer.frames() == []
    buffer.drop(["never there"])


def test_an_age_is_that_of_the_most_silent_transform_on_the_way():
    clock = HandClock()
    buffer = TransformBuffer(clock=clock)
    buffer.put(columns(Told("map", "odom", S)))
    buffer.put(columns(Told("base", "laser", S)), static=True)
    clock.now_ns += 3 * S
    buffer.put(columns(Told("odom", "base", S), Told("base", "arm", S)))
    clock.now_ns += 1 * S

    def ages(fixed: str) -> dict[str, float]:
        frames = buffer.all_in(fixed)
        return dict(zip(frames.names, frames.ages_s.tolist(), strict=True))

    assert ages("map") == {"map": 0, "odom": 4, "base": 4, "laser": 4, "arm": 4}
    assert ages("base") == {"map": 4, "odom": 1, "base": 0, "laser": 0, "arm": 1}


def test_who_asks_sees_whole_messages_while_another_thread_feeds():
    buffer = TransformBuffer()
    rows = 1200

    def feed() -> None:
        for at in range(rows):
            there = (float(at), 0.0, 0.0)
            buffer.put(columns(Told("a", "b", at * S // 100, there), Told("a", "c", 0, there)))

    feeder = threading.Thread(target=feed)
    feeder.start()
    seen: set[float] = set()
    while feeder.is_alive():
        frames = buffer.all_in("a")
        x_m = dict(zip(frames.names, frames.wxyz_xyz[:, 4].tolist(), strict=True))
        assert x_m.get("b") == x_m.get("c")
        seen.add(x_m.get("b", -1.0))
    feeder.join()
    assert buffer.fixed_from("a", "b").xyz[0] == rows - 1


def test_everything_is_forgotten_at_once():
    buffer = TransformBuffer()
    buffer.put(columns(Told("a", "b", S)))
    before = buffer.changes
    buffer.clear()
    assert buffer.frames() == []
    assert buffer.changes > before
    assert buffer.put(columns(Told("b", "a", S))) == ()
