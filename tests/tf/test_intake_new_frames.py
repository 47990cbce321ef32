from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.tf.buffer import TransformBuffer
from studio.tf.forest import DEPTH_MAX, FRAMES_MAX
from studio.tf.intake import MANY
from tests.support.transforms import S, Told, columns

COUNT = 2 * MANY


@st.composite
def told(draw: st.DrawFn) -> list[Told]:
    """A tree in any order, some of it hung on frames of before, some of it named twice."""
    parents = [draw(st.integers(-3, row - 1)) for row in range(COUNT)]
    rows = [
        Told(f"f{parent}", f"f{row}", S, (float(row), 0.0, 0.0))
        for row, parent in enumerate(parents)
    ]
    twice = draw(st.lists(st.sampled_from(rows), max_size=5))
    return draw(st.permutations([*rows, *twice]))


def known(buffer: TransformBuffer) -> dict[str, tuple[object, ...]]:
    report = {
        one.frame: (one.parent, one.root, one.static, one.newest_ns) for one in buffer.report()
    }
    poses = buffer.all_in("f-1")
    return {name: (*report[name], poses.pose_of(name)) for name in report}


@settings(max_examples=40)
@given(told(), st.booleans())
def test_many_frames_at_once_stand_as_if_they_had_come_one_by_one(rows: list[Told], static: bool):
    together, alone = TransformBuffer(), TransformBuffer()
    before = columns(Told("f-1", "f-2", S), Told("f-2", "f-3", S))
    for buffer in (together, alone):
        assert buffer.put(before, static=static, publisher="one") == ()
    assert together.put(columns(*rows), static=static, publisher="one") == ()
    for row in rows:
        assert alone.put(columns(row), static=static, publisher="one") == ()
    assert known(together) == known(alone)


@pytest.mark.parametrize("static", [False, True])
def test_one_bad_edge_among_many_does_not_keep_the_others_out(static: bool):
    chain = [Told(f"c{n}", f"c{n + 1}", S) for n in range(COUNT)]
    circle = [Told("x", "y", S), Told("y", "z", S), Told("z", "x", S)]
    buffer = TransformBuffer()
    (refused,) = buffer.put(columns(*chain, *circle), static=static)
    assert refused.kind == "circle"
    assert len(buffer.chain("c0", f"c{COUNT}")) == COUNT + 1
    assert buffer.chain("x", "z") == ("x", "y", "z")


def test_a_chain_that_comes_at_once_is_as_deep_as_it_may_be():
    chain = [Told(f"c{n}", f"c{n + 1}", S) for n in range(DEPTH_MAX + 1)]
    (refused,) = TransformBuffer().put(columns(*chain))
    assert refused.kind == "too_deep"
    buffer = TransformBuffer()
    assert buffer.put(columns(*chain[:-1])) == ()
    assert len(buffer.chain("c0", f"c{DEPTH_MAX}")) == DEPTH_MAX + 1


def test_more_frames_than_there_is_room_for_are_refused_one_by_one():
    buffer = TransformBuffer()
    rows = [Told("root", f"f{n}", S) for n in range(FRAMES_MAX + 4)]
    refused = buffer.put(columns(*rows))
    assert [one.kind for one in refused] == ["too_many"] * 5
    assert buffer.count() == FRAMES_MAX


def test_numbers_of_frames_that_are_gone_begin_anew():
    buffer = TransformBuffer()
    rows = [Told("root", f"f{n}", n * S, (float(n), 0.0, 0.0)) for n in range(COUNT)]
    buffer.put(columns(*rows), publisher="one")
    buffer.drop([row.child for row in rows])
    assert buffer.count() == 0
    again = [Told("root", f"g{n}", S, (2.0 * n, 0.0, 0.0)) for n in range(COUNT)]
    buffer.put(columns(*again), static=True, publisher="other")
    frames = buffer.all_in("root")
    places = [frames.wxyz_xyz[frames.rows[row.child], 4] for row in again]
    np.testing.assert_array_equal(places, [row.xyz[0] for row in again])
    assert {one.publishers for one in buffer.report() if one.parent} == {("other",)}
