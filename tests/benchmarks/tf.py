"""All frames into the fixed one beside a walk up each frame's chain, and what it costs to tell."""

from __future__ import annotations

import bisect
import math
import timeit
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from studio.tf.buffer import TransformBuffer
from studio.tf.rotations import IDENTITY, compose, inverse
from studio.tf.transforms import TransformColumns
from tests.benchmarks.report import Timings, judge, judge_ratio, judge_that, say, say_beside

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.tf.rotations import Pose

FRAMES = 100
DEPTH = 38
RATE_HZ = 100
SECONDS = 10
_STEP_NS = 1_000_000_000 // RATE_HZ
_RUNS = 41


def run() -> None:
    """Fill both from the same messages, compare what they answer, then the time they take."""
    parents, children = tree()
    messages = [message(parents, children, at) for at in range(RATE_HZ * SECONDS + 1)]
    buffer, walk = TransformBuffer(), ChainWalk()
    for one in messages:
        assert buffer.put(one, publisher="bench") == ()
        walk.put(one)
    asked_ns = messages[RATE_HZ * SECONDS // 2].stamps_ns[0] + _STEP_NS // 3
    judge_that("tf: all frames at once are where the walk finds them",
               holds=_difference(buffer, walk, int(asked_ns)) < 1e-9)  # fmt: skip
    ours, newest = Timings("all at once, at a stamp"), Timings("all at once, the newest")
    walked, one_by_one = (
        Timings("up each chain, plain Python"),
        Timings("one by one, of the buffer"),
    )
    for _ in range(_RUNS):
        # Ten in a row, as one tick asks: the walk warms itself up, too.
        ours.values_ms.append(_ten_ms(partial(buffer.all_in, "map", int(asked_ns))))
        newest.values_ms.append(_ten_ms(partial(buffer.all_in, "map")))
        with walked.measure():
            for child in children:
                walk.fixed_from("map", child, int(asked_ns))
        with one_by_one.measure():
            for child in children:
                buffer.fixed_from("map", child, int(asked_ns))
    say_beside(f"{FRAMES} frames, to {DEPTH} deep, into the fixed frame", ours, walked, one_by_one)
    say_beside("the newest of each", newest)
    # Of the best of each: what others take on the machine is no part of it.
    ratio = min(walked.values_ms) / min(ours.values_ms)
    judge_ratio("tf: all frames, beside a chain walk", ratio, at_least=25)
    _measure_telling(messages)


def _ten_ms(run: Callable[[], object]) -> float:
    """Milliseconds of each of ten."""
    return timeit.timeit(run, number=10) / 10 * 1000


def _measure_telling(messages: list[TransformColumns]) -> None:
    """Microseconds of each transform in the best of ten tenths, in messages of many and of one."""
    alone = [
        TransformColumns(
            one.parents[:1],
            one.children[:1],
            one.stamps_ns[:1],
            one.translations[:1],
            one.rotations_wxyz[:1],
        )
        for one in messages
    ]
    many_us, alone_us = _telling_us(messages) / FRAMES, _telling_us(alone)
    say(f"to tell of a transform: {many_us:.2f} us among {FRAMES}, {alone_us:.0f} us alone")
    judge("tf: to tell of a transform among 100", many_us, at_most=1.9, unit="us")


def _telling_us(messages: list[TransformColumns]) -> float:
    buffer, tenth = TransformBuffer(), len(messages) // 10
    begins = range(0, 10 * tenth, tenth)
    parts = [messages[begin : begin + tenth] for begin in begins]
    seconds = [timeit.timeit(partial(_tell, buffer, part), number=1) for part in parts]
    return min(seconds) / tenth * 1e6


def _tell(buffer: TransformBuffer, messages: list[TransformColumns]) -> None:
    for one in messages:
        buffer.put(one)


def tree() -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Parents and children: one chain as deep as it goes, the others anywhere on it."""
    chance = np.random.default_rng(5)
    names = ["map"]
    parents: list[str] = []
    for number in range(FRAMES):
        at = number if number < DEPTH else int(chance.integers(0, DEPTH))
        parents.append(names[at])
        names.append(f"frame_{number}")
    return tuple(parents), tuple(names[1:])


def message(parents: tuple[str, ...], children: tuple[str, ...], at: int) -> TransformColumns:
    """All transforms at one time, each somewhere."""
    chance = np.random.default_rng(at)
    turns = chance.normal(size=(FRAMES, 4))
    turns /= np.linalg.norm(turns, axis=1)[:, None]
    stamps_ns = np.full(FRAMES, 10**9 + at * _STEP_NS)
    return TransformColumns(parents, children, stamps_ns, chance.uniform(-1, 1, (FRAMES, 3)), turns)


class ChainWalk:
    """What one would write first: a list of each edge, and a walk to the root for each frame."""

    def __init__(self) -> None:
        self._edges: dict[str, tuple[str, list[int], list[Pose]]] = {}

    def put(self, columns: TransformColumns) -> None:
        """Append each."""
        poses = np.concatenate([columns.rotations_wxyz, columns.translations], axis=1).tolist()
        rows = zip(
            columns.parents, columns.children, columns.stamps_ns.tolist(), poses, strict=True
        )
        for parent, child, stamp_ns, pose in rows:
            _, stamps, kept = self._edges.setdefault(child, (parent, [], []))
            stamps.append(stamp_ns)
            kept.append(tuple(pose))

    def fixed_from(self, fixed: str, frame: str, stamp_ns: int) -> Pose:
        """Up both chains."""
        return compose(inverse(self._root_from(fixed, stamp_ns)), self._root_from(frame, stamp_ns))

    def _root_from(self, frame: str, stamp_ns: int) -> Pose:
        root_from_frame = IDENTITY
        while frame in self._edges:
            frame, stamps, poses = self._edges[frame]
            after = bisect.bisect_left(stamps, stamp_ns)
            share = (stamp_ns - stamps[after - 1]) / (stamps[after] - stamps[after - 1])
            root_from_frame = compose(
                _between(poses[after - 1], poses[after], share), root_from_frame
            )
        return root_from_frame


def _between(before: Pose, after: Pose, share: float) -> Pose:
    dot = sum(one * other for one, other in zip(before[:4], after[:4], strict=True))
    sign = -1.0 if dot < 0 else 1.0
    angle = math.acos(min(1.0, abs(dot)))
    of_before = math.sin((1 - share) * angle) / math.sin(angle)
    of_after = sign * math.sin(share * angle) / math.sin(angle)
    w, x, y, z = (of_before * one + of_after * other
                  for one, other in zip(before[:4], after[:4], strict=True))  # fmt: skip
    px, py, pz = (one + share * (other - one)
                  for one, other in zip(before[4:], after[4:], strict=True))  # fmt: skip
    return w, x, y, z, px, py, pz


def _difference(buffer: TransformBuffer, walk: ChainWalk, stamp_ns: int) -> float:
    frames = buffer.all_in("map", stamp_ns)
    walked = np.array([walk.fixed_from("map", name, stamp_ns) for name in frames.names])
    signs = np.sign(np.einsum("ij,ij->i", frames.wxyz_xyz[:, :4], walked[:, :4]))
    walked[:, :4] *= signs[:, None]
    return float(np.abs(frames.wxyz_xyz - walked).max())
