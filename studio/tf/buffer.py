"""TransformBuffer: the pose of every frame in any other, in the last seconds."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.errors import ExtrapolationError, UnconnectedFramesError, UnknownFrameError
from studio.tf.arrivals import Arrivals
from studio.tf.forest import Forest
from studio.tf.frames import AllFrames
from studio.tf.histories import Histories
from studio.tf.intake import Intake
from studio.tf.report import FrameReport, Reporting
from studio.tf.rotations import IDENTITY, Pose, compose, inverse
from studio.tf.transforms import plain_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.tf.frames import FramesNow
    from studio.tf.transforms import Notice, Numbers, TransformColumns

HISTORY_NS: Final = 10_000_000_000


class FramePose(NamedTuple):
    """The pose of a frame in another one at a time."""

    wxyz: tuple[float, float, float, float]
    """A quaternion of length 1."""
    xyz: tuple[float, float, float]
    """m."""
    stamp_ns: int
    """Time of the pose; 0 where all transforms of the chain are static."""


class TransformBuffer:
    """Keeps the transforms of /tf and /tf_static for 10 s of stamps, and looks up as tf2 does.

    All methods are thread-safe.

    Args:
        history_ns: How far back from the newest stamp of each frame.
        clock: Returns the time of arrivals, in ns; stamps are of any clock.
    """

    def __init__(
        self, history_ns: int = HISTORY_NS, clock: Callable[[], int] = time.monotonic_ns
    ) -> None:
        self._clock, self._lock = clock, threading.Lock()
        self._history_ns = history_ns
        self.changes = 0
        """Grows with every change, so that a caller who waits for a transform can poll it."""
        self._begin()

    def put(
        self,
        columns: TransformColumns,
        *,
        static: bool = False,
        publisher: str = "",
        received_ns: int | None = None,
    ) -> tuple[Notice, ...]:
        """Add transforms.

        Args:
            columns: As of one message.
            static: Whether they hold at all times.
            publisher: Any name; empty if it is not known.
            received_ns: By the buffer's clock; None is now.

        Returns:
            What was left out, and what is worth knowing; empty when all is well.
        """
        now_ns = self._clock() if received_ns is None else received_ns
        with self._lock:
            self.changes += 1
            return self._intake.put(columns, publisher, now_ns, static=static)

    def fixed_from(self, fixed: str, frame: str, stamp_ns: int = 0) -> FramePose:
        """Return the pose of a frame in the fixed frame.

        Args:
            fixed: Its name; a frame seen from itself needs no transform.
            frame: Its name.
            stamp_ns: Time of the pose; 0: the newest at which the whole chain is known.

        Raises:
            UnknownFrameError: One of them is in no transform.
            UnconnectedFramesError: No chain leads from one to the other.
            ExtrapolationError: A transform of the chain is not known at that time.
        """
        fixed, frame = plain_name(fixed), plain_name(frame)
        if fixed == frame:
            return FramePose(IDENTITY[:4], IDENTITY[4:], stamp_ns)
        with self._lock:
            down, up = self._chains(fixed, frame)
            poses, stamp_ns = self._poses(down + up, stamp_ns)
        ancestor_from_fixed, ancestor_from_frame = IDENTITY, IDENTITY
        for pose in poses[: len(down)]:
            ancestor_from_fixed = compose(pose, ancestor_from_fixed)
        for pose in poses[len(down) :]:
            ancestor_from_frame = compose(pose, ancestor_from_frame)
        fixed_from_frame = compose(inverse(ancestor_from_fixed), ancestor_from_frame)
        return FramePose(fixed_from_frame[:4], fixed_from_frame[4:], stamp_ns)

    def all_in(self, fixed: str, stamp_ns: int = 0, now_ns: int | None = None) -> FramesNow:
        """Return all frames seen from the fixed one; none is connected with one that is not known.

        Args:
            fixed: Its name.
            stamp_ns: Time of the poses; 0 takes the newest of each transform, whatever its stamp.
            now_ns: Ages are relative to it, by the buffer's clock.
        """
        now_ns = self._clock() if now_ns is None else now_ns
        with self._lock:
            return self._all.seen_from(plain_name(fixed), stamp_ns, now_ns)

    def chain(self, fixed: str, frame: str) -> tuple[str, ...]:
        """Return the frames of the chain from one to another, both included.

        Raises:
            UnknownFrameError: One of them is in no transform.
            UnconnectedFramesError: No chain leads from one to the other.
        """
        fixed, frame = plain_name(fixed), plain_name(frame)
        with self._lock:
            down, up = self._chains(fixed, frame)
            names, parents = self._forest.names, self._forest.parents
            last = (down or up)[-1] if down or up else None
            ancestor = fixed if last is None else names[parents[last]]
            return (
                *(names[number] for number in down),
                ancestor,
                *(names[number] for number in reversed(up)),
            )

    def frames(self) -> list[str]:
        """Return all frames, sorted."""
        with self._lock:
            return sorted(name for name in self._forest.names if name)

    def count(self) -> int:
        """Return the number of frames."""
        with self._lock:
            return len(self._forest)

    def roots(self) -> list[str]:
        """Return the frame that each tree hangs on, from that of the largest tree."""
        with self._lock:
            return list(self._all.shape().tree_sizes)

    def report(
        self, fixed: str = "", now_ns: int | None = None, most: int | None = None
    ) -> list[FrameReport]:
        """Return a report of each frame, in the order of the alphabet.

        Args:
            fixed: What is not connected with it is broken; without one, the root of the largest
                tree.
            now_ns: By the buffer's clock.
            most: Report so many, the first ones; None: all.
        """
        now_ns = self._clock() if now_ns is None else now_ns
        with self._lock:
            shape = self._all.shape()
            fixed = plain_name(fixed) or next(iter(shape.tree_sizes), "")
            found = Reporting(shape, self._histories, self._arrivals, fixed, now_ns, most)
        return found.reports()

    def jump_back(self, stamp_ns: int, from_ns: int | None = None) -> None:
        """Forget what is newer than a time to which /clock went back.

        What is static stays; of the others a frame of which nothing is left loses its edge.

        Args:
            stamp_ns: The time now.
            from_ns: The time before: a frame whose stamps are far beyond it goes by another clock.
        """
        with self._lock:
            self.changes += 1
            frames = np.array(self._hanging(), np.int64)
            if from_ns is not None:
                newest_ns = self._histories.newest_ns(frames)
                frames = frames[newest_ns <= from_ns + self._history_ns]
            self._intake.jump_back(frames.tolist(), stamp_ns)

    def drop(self, children: Iterable[str]) -> None:
        """Forget the edges of frames, as of links that were removed."""
        with self._lock:
            self.changes += 1
            for child in children:
                number = self._forest.number(plain_name(child))
                if number is not None and self._forest.parents[number] >= 0:
                    self._intake.drop(number)

    def clear(self) -> None:
        """Forget everything."""
        with self._lock:
            self.changes += 1
            self._begin()

    def _begin(self) -> None:
        self._forest, self._arrivals = Forest(), Arrivals()
        self._histories = Histories(self._history_ns)
        parts = self._forest, self._histories, self._arrivals
        self._intake, self._all = Intake(*parts), AllFrames(*parts)

    def _hanging(self) -> list[int]:
        parents = self._forest.parents
        return [number for number in self._forest.numbers() if parents[number] >= 0]

    def _chains(self, fixed: str, frame: str) -> tuple[list[int], list[int]]:
        """Return the frames from the fixed frame, and from the other, up to their ancestor.

        Raises:
            UnknownFrameError: One of them is in no transform.
            UnconnectedFramesError: No chain leads from one to the other.
        """
        chains: list[list[int]] = []
        for name in (fixed, frame):
            number = self._forest.number(name)
            if number is None:
                raise UnknownFrameError(name)
            chains.append(self._forest.chain(number))
        down, up = chains
        if down[-1] != up[-1]:
            raise UnconnectedFramesError(fixed, frame, self._forest.names[up[-1]])
        while down and up and down[-1] == up[-1]:
            down.pop()
            up.pop()
        return down, up

    def _poses(self, frames: list[int], stamp_ns: int) -> tuple[list[Pose], int]:
        """Return poses of frames in their parents, at a time or the newest common one; and when.

        Raises:
            ExtrapolationError: One is not known at that time.
        """
        if stamp_ns == 0:
            stamp_ns = self._newest_common_ns(np.array(frames, np.int64))
        poses: list[Pose] = []
        for frame in frames:
            pose = self._histories.pose_at(frame, stamp_ns)
            if pose is None:
                raise self._not_known(frame, stamp_ns)
            poses.append(pose)
        return poses, stamp_ns

    def _newest_common_ns(self, frames: Numbers) -> int:
        moving = frames[~self._histories.is_static(frames)]
        return int(self._histories.newest_ns(moving).min()) if moving.size else 0

    def _not_known(self, frame: int, stamp_ns: int) -> ExtrapolationError:
        at = np.array([frame])
        oldest_ns, newest_ns = self._histories.oldest_ns(at), self._histories.newest_ns(at)
        name = self._forest.names[frame]
        return ExtrapolationError(name, stamp_ns, int(oldest_ns[0]), int(newest_ns[0]))
