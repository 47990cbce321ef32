"""The way of joints to a pose: it begins where they are, ends in the pose, and can be cut short."""

from __future__ import annotations

import asyncio
from itertools import pairwise
from typing import TYPE_CHECKING

from studio.documents.motion import Glide
from tests.support.open_documents import until

if TYPE_CHECKING:
    from collections.abc import Mapping


class Joints:
    def __init__(self) -> None:
        self.moves: list[dict[str, float]] = []

    def move(self, positions: Mapping[str, float]) -> None:
        self.moves.append(dict(positions))


def test_it_goes_one_way_and_ends_exactly_in_the_pose():
    async def run() -> None:
        joints = Joints()
        glide = Glide(joints.move)
        glide.start({"a": 1.0, "b": 5.0}, {"a": -0.3}, 1.0)
        assert glide.running
        await until(lambda: not glide.running)
        way = [move["a"] for move in joints.moves]
        assert way[-1] == -0.3
        assert all(later <= earlier for earlier, later in pairwise(way))
        assert len(way) > 2
        assert "b" not in joints.moves[0]

    asyncio.run(run())


def test_without_a_time_it_is_there_at_once():
    async def run() -> None:
        joints = Joints()
        glide = Glide(joints.move)
        glide.start({"a": 1.0}, {"a": 2.0, "unknown": 3.0}, 0.0)
        assert (joints.moves, glide.running) == ([{"a": 2.0}], False)

    asyncio.run(run())


def test_stopped_it_leaves_the_joints_where_they_are():
    async def run() -> None:
        joints = Joints()
        glide = Glide(joints.move)
        glide.start({"a": 0.0}, {"a": 1.0}, 60.0)
        await until(lambda: len(joints.moves) > 1)
        glide.stop()
        count = len(joints.moves)
        glide.start({"a": 0.0}, {"a": 7.0}, 0.0)
        assert joints.moves[count:] == [{"a": 7.0}]
        assert all(move["a"] < 1 for move in joints.moves[:count])

    asyncio.run(run())
