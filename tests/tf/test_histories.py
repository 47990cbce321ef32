from __future__ import annotations

import bisect

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.tf import histories
from studio.tf.histories import Histories

HISTORY_NS = 100


def pose(x_m: float) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    return np.array([1.0, 0.0, 0.0, 0.0, x_m, 0.0, 0.0])


@given(st.lists(st.tuples(st.integers(0, 3), st.integers(0, 400)), max_size=120))
def test_rows_are_kept_as_sorted_lists_would(told: list[tuple[int, int]]):
    kept = Histories(HISTORY_NS)
    kept.fit(4)
    lists: dict[int, dict[int, float]] = {frame: {} for frame in range(4)}
    for number, (frame, stamp_ns) in enumerate(told):
        rows = lists[frame]
        newest_ns = max(rows, default=-1)
        if rows and stamp_ns >= newest_ns:
            kept.append(np.array([frame]), np.array([stamp_ns]), pose(number)[None])
        elif stamp_ns >= newest_ns - HISTORY_NS:
            kept.insert(frame, stamp_ns, pose(number))
        else:
            continue
        rows[stamp_ns] = float(number)
        lists[frame] = {at: x for at, x in rows.items() if at >= max(rows) - HISTORY_NS}
    for frame, rows in lists.items():
        assert kept.has_rows(frame) == bool(rows)
        if rows:
            assert_same(kept, frame, rows)


def assert_same(kept: Histories, frame: int, rows: dict[int, float]) -> None:
    frames, stamps_ns = np.array([frame]), sorted(rows)
    assert kept.oldest_ns(frames)[0] == stamps_ns[0]
    assert kept.newest_ns(frames)[0] == stamps_ns[-1]
    assert kept.newest(frames)[0, 4] == rows[stamps_ns[-1]]
    for asked_ns in (*stamps_ns, *(at + 1 for at in stamps_ns), stamps_ns[0] - 1):
        poses, known = kept.at(frames, asked_ns)
        one = kept.pose_at(frame, asked_ns)
        assert one == (pytest.approx(poses[0], abs=1e-12) if known[0] else None)
        assert known[0] == (stamps_ns[0] <= asked_ns <= stamps_ns[-1])
        if known[0]:
            after = bisect.bisect_left(stamps_ns, asked_ns)
            after_ns, before_ns = stamps_ns[after], stamps_ns[max(after - 1, 0)]
            share = 1.0 if asked_ns == after_ns else (asked_ns - before_ns) / (after_ns - before_ns)
            expected = rows[before_ns] + share * (rows[after_ns] - rows[before_ns])
            assert poses[0, 4] == pytest.approx(expected, abs=1e-9)


def test_a_fast_frame_has_the_room_it_needs_and_a_cleared_one_gives_it_back(
    monkeypatch: pytest.MonkeyPatch,
):
    # Blocks of 8, 16 and so on: one such frame needs almost all of it.
    monkeypatch.setattr(histories, "_ROWS_MAX", 2**16)
    kept = Histories(10_000)
    kept.fit(2)
    kept.insert(0, 0, pose(0.0))
    for at in range(1, 20_001):
        kept.append(np.array([0]), np.array([at]), pose(at)[None])
    assert kept.oldest_ns(np.array([0]))[0] == 10_000
    kept.clear(0)
    kept.insert(1, 0, pose(0.0))
    for at in range(1, 20_001):
        kept.append(np.array([1]), np.array([at]), pose(at)[None])
    assert kept.oldest_ns(np.array([1]))[0] == 10_000


def test_when_the_pool_is_full_histories_are_shorter(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(histories, "_ROWS_MAX", 200)
    kept = Histories(10**9)
    kept.fit(6)
    frames = np.arange(6)
    for frame in range(6):
        kept.insert(frame, 0, pose(0.0))
    for at in range(1, 1000):
        kept.append(frames, np.full(6, at), np.stack([pose(at)] * 6))
    assert (kept.newest_ns(frames) - kept.oldest_ns(frames) + 1).sum() <= 200
    assert (kept.newest_ns(frames) == 999).all()
    assert (kept.oldest_ns(frames) <= 999 - 7).all()
    poses, known = kept.at(frames, 997)
    assert known.all()
    assert (poses[:, 4] == 997.0).all()
    kept.insert(3, 996, pose(7.0))
    assert kept.at(np.array([3]), 996)[0][0, 4] == 7.0


def test_a_gap_longer_than_the_history_leaves_the_newest():
    kept = Histories(HISTORY_NS)
    kept.fit(1)
    kept.insert(0, 0, pose(0.0))
    for at in range(1, 90):
        kept.append(np.array([0]), np.array([at]), pose(at)[None])
    kept.append(np.array([0]), np.array([10_000]), pose(1.0)[None])
    assert kept.oldest_ns(np.array([0]))[0] == 10_000
    kept.drop_newer(0, 9_999)
    assert not kept.has_rows(0)
