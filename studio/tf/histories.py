"""Histories: the poses of each frame in the last seconds, by stamp."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from studio.tf.rotations import between, between_two

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.tf.rotations import Pose
    from studio.tf.transforms import Flags, Floats, Numbers

_T = TypeVar("_T", bound=np.generic)
_BLOCK: Final = 8
_ROWS_MAX: Final = 2**21
"""128 MB; beside it every frame has a first block."""
_STEPS_TOGETHER: Final = 3


def grown(array: NDArray[_T], rows: int) -> NDArray[_T]:
    """Return the array, or a longer copy with zeros at its end, so that it has this many rows."""
    if rows <= len(array):
        return array
    longer: NDArray[Any] = np.zeros((max(rows, 2 * len(array)), *array.shape[1:]), array.dtype)
    longer[: len(array)] = array
    return longer


class Histories:
    """Poses with stamps, of frames by number; the rows of a frame lie together.

    A frame has a block of one pool. Rows are appended at its end and dropped at its beginning;
    a block that is full is moved together, or into one of twice its size while the pool lasts:
    then the history of that frame is shorter.
    """

    def __init__(self, history_ns: int) -> None:
        self.history_ns = history_ns
        self._stamps_ns = np.zeros(64, np.int64)
        self._poses = np.zeros((64, 7))
        self._used = 0
        self._spare: dict[int, list[int]] = {}
        # Of each frame: its block, its rows in it, and whether the one row holds at all times.
        self._block = np.zeros(0, np.int64)
        self._size = np.zeros(0, np.int64)
        self._first = np.zeros(0, np.int64)
        self._end = np.zeros(0, np.int64)
        self._static = np.zeros(0, np.bool_)

    def fit(self, count: int) -> None:
        """Make room for frames of numbers below this."""
        if count > len(self._block):
            for name in ("_block", "_size", "_first", "_end", "_static"):
                setattr(self, name, grown(getattr(self, name), count))

    def is_static(self, frames: Numbers) -> Flags:
        """Return whether the pose of each holds at all times."""
        return self._static[frames]

    def has_rows(self, frame: int) -> bool:
        """Whether anything is known of a frame."""
        return bool(self._end[frame] > self._first[frame])

    def newest_ns(self, frames: Numbers) -> Numbers:
        """Return the newest stamp of each; each has rows."""
        return self._stamps_ns[self._end[frames] - 1]

    def oldest_ns(self, frames: Numbers) -> Numbers:
        """Return the oldest stamp of each; each has rows."""
        return self._stamps_ns[self._first[frames]]

    def newest(self, frames: Numbers) -> Floats:
        """Return the newest pose of each, shape (N, 7); each has rows."""
        return self._poses[self._end[frames] - 1]

    def put_static(self, frame: int, stamp_ns: int, pose: Floats) -> None:
        """Make one pose hold at all times; forget everything else of the frame."""
        self.clear(frame)
        self._insert(frame, 0, stamp_ns, pose)
        self._static[frame] = True

    def begin(self, frames: Numbers, stamps_ns: Numbers, poses: Floats, *, static: bool) -> None:
        """Add the first row of frames that have none, each named once."""
        blocks = np.array([self._take(_BLOCK) for _ in range(len(frames))], np.int64)
        self._block[frames] = self._first[frames] = blocks
        self._size[frames], self._end[frames] = _BLOCK, blocks + 1
        self._static[frames] = static
        self._stamps_ns[blocks], self._poses[blocks] = stamps_ns, poses

    def replace_static(self, frames: Numbers, stamps_ns: Numbers, poses: Floats) -> None:
        """Replace the poses of static frames, each named once."""
        rows = self._first[frames]
        self._stamps_ns[rows], self._poses[rows] = stamps_ns, poses

    def append(self, frames: Numbers, stamps_ns: Numbers, poses: Floats) -> None:
        """Add the newest row of frames that have rows and are not static, each named once.

        A row of the same stamp as the newest takes its place.
        """
        ends = self._end[frames]
        full = ends == self._block[frames] + self._size[frames]
        if full.any():
            for frame in frames[full].tolist():
                self._make_room(frame)
            ends = self._end[frames]
        ends = ends + (self._stamps_ns[ends - 1] != stamps_ns)
        self._stamps_ns[ends - 1] = stamps_ns
        self._poses[ends - 1] = poses
        self._end[frames] = ends
        self._drop_older(frames, stamps_ns - self.history_ns)

    def insert(self, frame: int, stamp_ns: int, pose: Floats) -> None:
        """Add a row wherever its stamp belongs; one of the same stamp is replaced."""
        if self._static[frame]:
            self.clear(frame)
        stamps_ns = self._rows(frame)
        at = int(stamps_ns.searchsorted(stamp_ns))
        if at < len(stamps_ns) and stamps_ns[at] == stamp_ns:
            self._poses[self._first[frame] + at] = pose
            return
        self._insert(frame, at, stamp_ns, pose)
        frames = np.array([frame])
        self._drop_older(frames, self.newest_ns(frames) - self.history_ns)

    def drop_newer(self, frame: int, stamp_ns: int) -> None:
        """Forget all rows with newer stamps."""
        if not self._static[frame]:
            kept = int(self._rows(frame).searchsorted(stamp_ns, side="right"))
            self._end[frame] = self._first[frame] + kept

    def clear(self, frame: int) -> None:
        """Forget a frame, and give its block back."""
        if self._size[frame]:
            self._spare.setdefault(int(self._size[frame]), []).append(int(self._block[frame]))
        for one in (self._block, self._size, self._first, self._end):
            one[frame] = 0
        self._static[frame] = False

    def at(self, frames: Numbers, stamp_ns: int) -> tuple[Floats, Flags]:
        """Return the poses of frames that have rows at one time, and which of them are known then.

        Returns:
            Shape (N, 7), any pose for those that are not known; and (N,).
        """
        first, end, static = self._first[frames], self._end[frames], self._static[frames]
        after = self._places(first, end, stamp_ns)
        is_newer = after == end
        after -= is_newer | static  # Of a static frame, the one row it has.
        np.maximum(after, first, out=after)
        stamps_ns = self._stamps_ns[after]
        poses = self._poses[after]
        known = static | ~is_newer & ((after > first) | (stamps_ns == stamp_ns))
        within = np.flatnonzero(known & ~static & (stamps_ns != stamp_ns))
        if within.size:
            upper = after[within]
            from_ns = self._stamps_ns[upper - 1]
            shares = (stamp_ns - from_ns) / (stamps_ns[within] - from_ns)
            poses[within] = between(self._poses[upper - 1], poses[within], shares)
        return poses, known

    def pose_at(self, frame: int, stamp_ns: int) -> Pose | None:
        """Return the pose of a frame with rows at one time; None when it is not known then."""
        first, end = int(self._first[frame]), int(self._end[frame])
        if self._static[frame]:
            return self._pose(end - 1)
        after = first + int(self._stamps_ns[first:end].searchsorted(stamp_ns))
        if after == end:
            return None
        if (after_ns := int(self._stamps_ns[after])) == stamp_ns:
            return self._pose(after)
        if after == first:
            return None
        before_ns = int(self._stamps_ns[after - 1])
        share = (stamp_ns - before_ns) / (after_ns - before_ns)
        return between_two(self._pose(after - 1), self._pose(after), share)

    def _pose(self, row: int) -> Pose:
        w, x, y, z, px, py, pz = self._poses[row].tolist()
        return w, x, y, z, px, py, pz

    def _places(self, first: Numbers, end: Numbers, stamp_ns: int) -> Numbers:
        """Return the first row of each whose stamp is not older, or its end."""
        low, high = self._guess(first, end, stamp_ns)
        most = int((high - low).max(initial=0))
        for _ in range(most.bit_length()):
            middle = (low + high) >> 1
            # One that was found has middle == high, which may be another frame's row.
            older = self._stamps_ns.take(middle, mode="clip") < stamp_ns
            older &= low < high
            low = np.where(older, middle + 1, low)
            high = np.where(older, high, middle)
        return low

    def _guess(self, first: Numbers, end: Numbers, stamp_ns: int) -> tuple[Numbers, Numbers]:
        """Return bounds of the rows that `_places` searches: narrow ones, where stamps are even."""
        last = end - 1
        from_ns, to_ns = self._stamps_ns[first], self._stamps_ns[last]
        share = (stamp_ns - from_ns) / np.maximum(to_ns - from_ns, 1)
        guess = first + (share.clip(0.0, 1.0) * (last - first)).astype(np.int64)
        low, high = np.maximum(guess - 1, first), np.minimum(guess + 2, last)
        hits = (self._stamps_ns[low] < stamp_ns) & (self._stamps_ns[high] >= stamp_ns)
        return np.where(hits, low + 1, first), np.where(hits, high, end)

    def _rows(self, frame: int) -> Numbers:
        return self._stamps_ns[int(self._first[frame]) : int(self._end[frame])]

    def _drop_older(self, frames: Numbers, than_ns: Numbers) -> None:
        for _ in range(_STEPS_TOGETHER):
            late = self._stamps_ns[self._first[frames]] < than_ns
            if not late.any():
                return
            frames, than_ns = frames[late], than_ns[late]
            self._first[frames] += 1
        for at, frame in enumerate(frames):
            self._first[frame] += self._rows(int(frame)).searchsorted(than_ns[at])

    def _insert(self, frame: int, at: int, stamp_ns: int, pose: Floats) -> None:
        if self._end[frame] == self._block[frame] + self._size[frame]:
            before = int(self._end[frame] - self._first[frame])
            self._make_room(frame)
            at = max(0, at - before + int(self._end[frame] - self._first[frame]))
        place, end = int(self._first[frame]) + at, int(self._end[frame])
        for column in (self._stamps_ns, self._poses):
            column[place + 1 : end + 1] = column[place:end].copy()
        self._stamps_ns[place], self._poses[place] = stamp_ns, pose
        self._end[frame] = end + 1

    def _make_room(self, frame: int) -> None:
        """Make room for one more row at the end of a frame's block."""
        first, end = int(self._first[frame]), int(self._end[frame])
        block, size = int(self._block[frame]), int(self._size[frame])
        wanted = max(_BLOCK, 2 * size)
        if 2 * (end - first) > size or not size:
            taken = self._take(wanted)
            if taken is None:
                first += (end - first) // 2
            else:
                self._size[frame], self._block[frame] = wanted, taken
        to = int(self._block[frame])
        for column in (self._stamps_ns, self._poses):
            column[to : to + end - first] = column[first:end].copy()
        self._first[frame], self._end[frame] = to, to + end - first
        if size and to != block:
            self._spare.setdefault(size, []).append(block)

    def _take(self, size: int) -> int | None:
        """Return a block of the pool, or None when the pool must not grow further."""
        if self._spare.get(size):
            return self._spare[size].pop()
        if size > _BLOCK and self._used + size > _ROWS_MAX:
            return None
        begin, self._used = self._used, self._used + size
        self._stamps_ns = grown(self._stamps_ns, self._used)
        self._poses = grown(self._poses, self._used)
        return begin
