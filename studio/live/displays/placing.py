"""Placing: poses of the parts of a drawing in the fixed frame, and when it can be shown."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, NamedTuple, TypeAlias

from studio.displays.drawing import NO_TURN, NOTHING
from studio.errors import ExtrapolationError, FrameError
from studio.live.displays.deskewing import Deskewing
from studio.tf.rotations import compose

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from studio.displays.drawing import Drawing, Placed, Pose

PATIENCE_NS: Final = 500_000_000
"""So long a drawing waits for transforms that arrive after its message."""
_WAITING_MAX: Final = 30

Lookup: TypeAlias = "Callable[[str, int], Pose]"
"""Looks up a frame at a time, ns since the epoch (0: the newest); raises a FrameError."""


class Shown(NamedTuple):
    """A drawing and the pose of each of its paths; None where it has none."""

    drawing: Drawing
    poses: Mapping[str, Pose | None]


@dataclass(slots=True)
class _Waiting:
    drawing: Drawing
    since_ns: int


@dataclass(slots=True)
class _Tried:
    poses: dict[str, Pose | None] = field(default_factory=dict[str, "Pose | None"])
    troubles: dict[str, FrameError] = field(default_factory=dict[str, FrameError])
    frames: dict[str, Pose] = field(default_factory=dict[str, "Pose"])
    ends: dict[str, Pose] = field(default_factory=dict[str, "Pose"])
    """Last pose of the frame, for a drawing of points measured one after another."""

    def put(self, path: str, frame: Pose, placed: Placed) -> None:
        """Place what is drawn at a path, whose frame has this pose."""
        self.frames[path] = frame
        self.poses[path] = _offset(frame, placed.offset)


class Placing:
    """Holds back a drawing until its transforms are known, and keeps the one before on screen.

    As tf2's message filter does: a message waits for the transform of its stamp; after
    `PATIENCE_NS`, parts without a pose are left out, and `troubles` says why.
    """

    def __init__(self) -> None:
        self._waiting: deque[_Waiting] = deque(maxlen=_WAITING_MAX)
        self._newest: Drawing = NOTHING
        self._shown = Shown(NOTHING, {})
        self._source: Drawing = NOTHING
        """What is shown, as the display drew it."""
        self._placed: dict[str, Placed] = {}
        self._frames: Mapping[str, Pose] = {}
        """By path, the pose of its frame."""
        self._ends: Mapping[str, Pose] = {}
        self._deskewing = Deskewing()
        self.troubles: Mapping[str, FrameError] = {}
        """By path, why a part of the drawing has no pose."""

    @property
    def shown(self) -> Shown:
        """Return what is shown, or waits to be, with its poses."""
        return self._shown

    def offer(self, drawing: Drawing, now_ns: int) -> None:
        """Take what the display draws now; the same object again is no news."""
        if drawing is not self._newest:
            self._newest = drawing
            self._waiting.append(_Waiting(drawing, now_ns))

    def step(self, lookup: Lookup, now_ns: int) -> Shown | None:
        """Place what can be placed now; None when all is as it was.

        Args:
            lookup: Poses in the fixed frame.
            now_ns: Since the epoch, by the clock of `offer`.
        """
        for at in range(len(self._waiting) - 1, -1, -1):
            candidate = self._waiting[at]
            tried = self._try(candidate.drawing, lookup)
            is_late = now_ns - candidate.since_ns >= PATIENCE_NS
            if is_late or not any(map(_may_come, tried.troubles.values())):
                self._forget_older(at)
                return self._show(candidate.drawing, tried)
        return self._follow(lookup)

    def renew(self) -> None:
        """Look up all poses again: the fixed frame changed, or time jumped."""
        self._placed = {}
        self._shown = Shown(self._shown.drawing, {})

    def forget(self) -> None:
        """Drop what waits: it is of another time."""
        self._waiting.clear()
        self._newest = {}  # even nothing is news now
        self.renew()

    @property
    def waits(self) -> bool:
        """Whether a drawing waits for its transforms."""
        return bool(self._waiting)

    def _try(self, drawing: Drawing, lookup: Lookup) -> _Tried:
        tried, found = _Tried(), dict[tuple[str, int], "Pose"]()
        for path, placed in drawing.items():
            known = self._frames.get(path)
            is_there = known is not None and _is_same_place(self._placed.get(path), placed)
            if known is not None and is_there and not _moves(placed):
                tried.put(path, known, placed)
                if path in self._ends:
                    tried.ends[path] = self._ends[path]
                continue
            try:
                at = placed.frame, placed.stamp_ns
                if at not in found:
                    found[at] = lookup(*at)
                wxyz, xyz = found[at]
                tried.put(path, (wxyz if placed.turns else NO_TURN, xyz), placed)
                if placed.sweep is not None:
                    tried.ends[path] = lookup(placed.frame, placed.sweep.until_ns)
            except FrameError as error:
                tried.poses[path], tried.troubles[path] = None, error
        return tried

    def _show(self, drawing: Drawing, tried: _Tried) -> Shown:
        self._source, self._placed, self._ends = drawing, dict(drawing), tried.ends
        self._frames = tried.frames
        self.troubles = tried.troubles
        deskewed = self._deskewing.deskewed(drawing, tried.poses, tried.ends)
        self._shown = Shown(deskewed, tried.poses)
        return self._shown

    def _follow(self, lookup: Lookup) -> Shown | None:
        """Move what goes with its frame, and place what had no place yet."""
        drawing, poses = self._source, self._shown.poses
        if all(poses.get(path) and not _moves(placed) for path, placed in drawing.items()):
            return None
        tried = self._try(drawing, lookup)
        if tried.poses == dict(poses):
            self.troubles = tried.troubles
            return None
        return self._show(drawing, tried)

    def _forget_older(self, at: int) -> None:
        for _ in range(at + 1):
            self._waiting.popleft()


def _is_same_place(before: Placed | None, now: Placed) -> bool:
    """Whether the frame is in the same place: what was placed once stays, however long ago."""
    return before is not None and (before.frame, before.stamp_ns, before.follows, before.turns) == (
        now.frame,
        now.stamp_ns,
        now.follows,
        now.turns,
    )


def _offset(fixed_from_frame: Pose, frame_from_shapes: Pose | None) -> Pose:
    if frame_from_shapes is None:
        return fixed_from_frame
    (w, x, y, z), (px, py, pz) = fixed_from_frame
    (ow, ox, oy, oz), (qx, qy, qz) = frame_from_shapes
    made = compose((w, x, y, z, px, py, pz), (ow, ox, oy, oz, qx, qy, qz))
    return made[:4], made[4:]


def _moves(placed: Placed) -> bool:
    return placed.follows or placed.stamp_ns == 0


def _may_come(error: FrameError) -> bool:
    """Whether a transform still to come could mend it; true for unknown frames, too."""
    return not isinstance(error, ExtrapolationError) or error.may_come
