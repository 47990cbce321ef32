"""Initial positions as MoveIt and Universal Robots write them, and what is something else."""

from __future__ import annotations

import math

import pytest

from studio.description.poses import initial_positions


def test_a_bare_map_and_one_under_its_key_are_the_same_pose():
    bare = initial_positions("/p/config/initial_positions.yaml", b"a: 0.5\nb: -1\n")
    assert bare is not None
    assert (bare.name, bare.positions) == ("initial_positions", {"a": 0.5, "b": -1.0})
    keyed = initial_positions(
        "/p/config/initial_positions.yaml", b"initial_positions:\n  a: 0.5\n  b: -1\n"
    )
    assert keyed == bare


def test_an_angle_may_be_in_degrees():
    found = initial_positions("/p/initial_positions.yaml", b"a: !degrees 90\n")
    assert found is not None
    assert found.positions["a"] == pytest.approx(math.pi / 2)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"7",
        b"a: [1]",
        b"a: true",
        b"a: .nan",
        b"a: text",
        b"1: 2",
        b"initial_positions: 3",
        b"a: !degrees x",
        b"a: &x 1\nb: *x\nc: [",
        b"\xff",
        b"[" * 10_000,
    ],
)
def test_what_is_no_map_of_numbers_is_no_pose(data: bytes):
    assert initial_positions("/p/initial_positions.yaml", data) is None
