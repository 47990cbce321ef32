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
    ends: dict[str, Pose] = field(default_factory=dict[str, "Pose"])
    """Last pose of the frame, for a drawing of points measured one after another."""


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
            known = self._shown.poses.get(path)
            is_there = known is not None and _is_same_place(self._placed.get(path), placed)
            if is_there and not _moves(placed):
                tried.poses[path] = known
                if path in self._ends:
                    tried.ends[path] = self._ends[path]
                continue
            try:
                at = placed.frame, placed.stamp_ns
                if at not in found:
                    found[at] = lookup(*at)
                tried.poses[path] = _moved(found[at], placed)
                if placed.sweep is not None:
                    tried.ends[path] = lookup(placed.frame, placed.sweep.until_ns)
            except FrameError as error:
                tried.poses[path], tried.troubles[path] = None, error
        return tried

    def _show(self, drawing: Drawing, tried: _Tried) -> Shown:
        self._source, self._placed, self._ends = drawing, dict(drawing), tried.ends
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
    """Whether only the shapes may differ: what was placed once stays, however long ago it was."""
    return before is not None and _place_of(before) == _place_of(now)


def _place_of(placed: Placed) -> tuple[object, ...]:
    return placed.frame, placed.stamp_ns, placed.follows, placed.turns, placed.offset


def _moved(fixed_from_frame: Pose, placed: Placed) -> Pose:
    """Return the pose of the shapes in the fixed frame."""
    wxyz, xyz = fixed_from_frame
    if not placed.turns:
        wxyz = NO_TURN
    if placed.offset is None:
        return wxyz, xyz
    turn, (x, y, z) = placed.offset
    made = compose((*wxyz, *xyz), (*turn, x, y, z))
    return made[:4], made[4:]


def _moves(placed: Placed) -> bool:
    return placed.follows or placed.stamp_ns == 0


def _may_come(error: FrameError) -> bool:
    """Whether a transform still to come could mend it; true for unknown frames, too."""
    return not isinstance(error, ExtrapolationError) or error.may_come
