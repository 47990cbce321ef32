"""Frames a moment after the one at which a recording stands, for messages that are just newer.

A message has the stamp of its measuring, and the transform of that time comes a little later. What
runs waits for it; where time stands still it would never come, though it is in the recording.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from studio.errors import CdrError, ExtrapolationError
from studio.ros.columns.transforms import TransformCodec
from studio.tf.buffer import TransformBuffer
from studio.tf.rotations import IDENTITY, Pose, compose
from studio.tf.transforms import TransformColumns, plain_name

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from studio.ros.node.samples import RawSample


class LaterFrames:
    """Looks up with the help of transforms that come next; used on the event loop only."""

    def __init__(self, buffer: TransformBuffer) -> None:
        self._buffer = buffer
        self._codec = TransformCodec()
        self._samples: Sequence[RawSample] = ()
        self._columns: list[TransformColumns] = []

    def pose(self, samples: Sequence[RawSample], fixed: str, frame: str, stamp_ns: int) -> Pose:
        """Return the pose of a frame in the fixed frame.

        Args:
            samples: Those of /tf that come next.
            fixed: Its name.
            frame: Its name.
            stamp_ns: Time of the pose.

        Raises:
            FrameError: It is not known, not even with what comes next.
        """
        if samples is not self._samples:
            self._samples, self._columns = samples, list(self._decoded(samples))
        fixed_from_frame = IDENTITY
        for above, below in pairwise(self._buffer.chain(fixed, frame)):
            fixed_from_frame = compose(fixed_from_frame, self._step(above, below, stamp_ns))
        return fixed_from_frame

    def _step(self, above: str, below: str, stamp_ns: int) -> Pose:
        """Return the pose of a frame in one that is next to it."""
        try:
            pose = self._buffer.fixed_from(above, below, stamp_ns)
        except ExtrapolationError as error:
            if not error.may_come:
                raise
            pose = self._with_later(above, below).fixed_from(above, below, stamp_ns)
        return *pose.wxyz, *pose.xyz

    def _with_later(self, above: str, below: str) -> TransformBuffer:
        """Return a buffer with the last transform between two frames, and those that come next."""
        both = TransformBuffer()
        rows = [
            one
            for columns in self._columns
            for one in _rows(columns)
            if {plain_name(one.parents[0]), plain_name(one.children[0])} == {above, below}
        ]
        if rows:
            parent, child = plain_name(rows[0].parents[0]), plain_name(rows[0].children[0])
            last = self._buffer.fixed_from(parent, child)
            rows.insert(0, _row(parent, child, last.stamp_ns, (*last.wxyz, *last.xyz)))
        for one in rows:
            both.put(one)
        if not rows:
            last = self._buffer.fixed_from(above, below)
            both.put(_row(above, below, last.stamp_ns, (*last.wxyz, *last.xyz)))
        return both

    def _decoded(self, samples: Sequence[RawSample]) -> Iterator[TransformColumns]:
        for sample in samples:
            try:
                yield self._codec.decode(sample.payload)
            except CdrError:
                continue


def _rows(columns: TransformColumns) -> Iterator[TransformColumns]:
    for at, (parent, child) in enumerate(zip(columns.parents, columns.children, strict=True)):
        only = slice(at, at + 1)
        yield TransformColumns(
            (parent,),
            (child,),
            columns.stamps_ns[only],
            columns.translations[only],
            columns.rotations_wxyz[only],
        )


def _row(parent: str, child: str, stamp_ns: int, pose: Pose) -> TransformColumns:
    return TransformColumns(
        (parent,),
        (child,),
        np.array([stamp_ns], np.int64),
        np.array([pose[4:]], np.float64),
        np.array([pose[:4]], np.float64),
    )
