"""Intake: adds transforms to forest, histories and arrivals, and returns what it leaves out."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.errors import TransformError
from studio.tf.forest import DEPTH_MAX, FRAMES_MAX, NONE
from studio.tf.transforms import Notice, name_fault, number_fault, plain_name, poses_of, valid_rows

if TYPE_CHECKING:
    from studio.tf.arrivals import Arrivals
    from studio.tf.forest import Forest
    from studio.tf.histories import Histories
    from studio.tf.transforms import Flags, Floats, Kind, Numbers, TransformColumns

MANY: Final = 32
"""Fewer are added one by one; those of a large robot all at once."""
_NOTICES_MAX: Final = 20
_LAYOUTS_MAX: Final = 64
_LAYOUT_LETTERS_MAX: Final = 200_000
_SILENT_NS: Final = 1_000_000_000
"""After this long without a message, another publisher may take over a frame."""
_REST_NS: Final = 1_000_000_000
"""So long a publisher that moved its own frame cannot move it again."""
_BEHIND_MAX: Final = 10
"""So many transforms in a row older than their publisher's last are a jump of time."""


class NewFrames(NamedTuple):
    """Rows of a message whose children are new and named once, and their names, parent first."""

    rows: Numbers
    edges: list[tuple[str, str]]


def new_frames(columns: TransformColumns, chosen: Flags, forest: Forest) -> NewFrames | None:
    """Return those among the given rows, shape (N,); None when they are few."""
    if np.count_nonzero(chosen) < MANY:
        return None
    rows: list[int] = np.flatnonzero(chosen).tolist()
    edges = [(plain_name(columns.parents[at]), plain_name(columns.children[at])) for at in rows]
    counts = Counter(child for _, child in edges)
    new = [
        (at, edge)
        for at, edge in zip(rows, edges, strict=True)
        if counts[edge[1]] == 1 and forest.number(edge[1]) is None and not name_fault(*edge)
    ]
    if len(new) < MANY:
        return None
    return NewFrames(np.array([at for at, _ in new], np.int64), [edge for _, edge in new])


class _Row(NamedTuple):
    parent: str
    child: str
    stamp_ns: int
    pose: Floats
    publisher: str
    static: bool
    now_ns: int

    def refused(self, kind: Kind, reason: str) -> Notice:
        sentence = str(TransformError(self.parent, self.child, reason))
        return Notice(kind, self.parent, self.child, self.publisher, sentence)


class Intake:
    """Adds transforms to the parts of a buffer, whose lock the caller holds."""

    def __init__(self, forest: Forest, histories: Histories, arrivals: Arrivals) -> None:
        self._forest, self._histories, self._arrivals = forest, histories, arrivals
        self._layouts: dict[tuple[tuple[str, ...], tuple[str, ...]], tuple[int, Numbers]] = {}
        self._behind: dict[int, int] = {}
        self._moved_ns: dict[int, int] = {}

    def put(
        self, columns: TransformColumns, publisher: str, now_ns: int, *, static: bool
    ) -> tuple[Notice, ...]:
        """Add columns; return what was left out, and what is worth knowing."""
        good, poses = valid_rows(columns), poses_of(columns)
        frames = self._frames(columns)
        fast = good & (frames != NONE)
        fast[fast] = self._is_usual(frames[fast], columns.stamps_ns[fast], static=static)
        if fast.any():
            known, stamps_ns = frames[fast], columns.stamps_ns[fast]
            store = self._histories.replace_static if static else self._histories.append
            store(known, stamps_ns, poses[fast])
            self._note(known, publisher, now_ns)
        new = new_frames(columns, good & ~fast, self._forest)
        hung = self._hang_new(new, columns, poses, static=static) if new else None
        if new and hung is not None:
            self._note(hung, publisher, now_ns)
            fast[new.rows] = True
        rest: list[int] = np.flatnonzero(~fast).tolist()
        notices: list[Notice] = []
        for at in rest:
            row = _Row(
                plain_name(columns.parents[at]),
                plain_name(columns.children[at]),
                int(columns.stamps_ns[at]),
                poses[at],
                publisher,
                static,
                now_ns,
            )
            notice = self._put_row(row) if good[at] else _unsound(row, columns, at)
            if notice is not None:
                notices.append(notice)
        return _shortened(notices)

    def drop(self, frame: int) -> None:
        """Forget the edge of a frame."""
        self._histories.clear(frame)
        self._arrivals.clear(frame)
        self._behind.pop(frame, None)
        self._moved_ns.pop(frame, None)
        self._forest.cut(frame)

    def jump_back(self, frames: list[int], stamp_ns: int) -> None:
        """Forget what is newer; a frame of which nothing is left loses its edge."""
        for frame in frames:
            self._behind.pop(frame, None)
            self._histories.drop_newer(frame, stamp_ns)
            if not self._histories.has_rows(frame):
                self.drop(frame)

    def _hang_new(
        self, new: NewFrames, columns: TransformColumns, poses: Floats, *, static: bool
    ) -> Numbers | None:
        """Add new frames all at once; return None when one of them cannot be added."""
        hung = self._forest.hang_new(new.edges)
        if hung is None:
            return None
        frames = np.array(hung, np.int64)
        for one in (self._histories, self._arrivals):
            one.fit(len(self._forest.names))
        self._arrivals.clear(frames)
        self._histories.begin(frames, columns.stamps_ns[new.rows], poses[new.rows], static=static)
        return frames

    def _frames(self, columns: TransformColumns) -> Numbers:
        """Return the children's numbers; NONE where there is no such edge, or it is named twice."""
        key = columns.parents, columns.children
        found = self._layouts.get(key)
        if found is not None and found[0] == self._forest.version:
            return found[1]
        edges = [self._edge(*names) for names in zip(*key, strict=True)]
        counts = Counter(edges)
        frames = np.array([one if counts[one] == 1 else NONE for one in edges], np.int64)
        self._layouts.pop(key, None)
        if sum(map(len, (*key[0], *key[1]))) <= _LAYOUT_LETTERS_MAX:
            if len(self._layouts) >= _LAYOUTS_MAX:
                del self._layouts[next(iter(self._layouts))]
            self._layouts[key] = self._forest.version, frames
        return frames

    def _edge(self, parent: str, child: str) -> int:
        """Return the child's number, if that is its parent; else NONE."""
        number, upper = (
            self._forest.number(plain_name(child)),
            self._forest.number(plain_name(parent)),
        )
        if number is None or upper is None or self._forest.parents[number] != upper:
            return NONE
        return number

    def _is_usual(self, frames: Numbers, stamps_ns: Numbers, *, static: bool) -> Flags:
        """Return which frames stay static, or move on with stamps that are not older."""
        are_static = self._histories.is_static(frames)
        if static:
            return are_static
        return ~are_static & (stamps_ns >= self._histories.newest_ns(frames))

    def _note(self, frames: Numbers, publisher: str, now_ns: int) -> None:
        self._arrivals.note(frames, self._arrivals.publisher(publisher), now_ns)
        if self._behind:
            for frame in frames.tolist():
                self._behind.pop(frame, None)

    def _put_row(self, row: _Row) -> Notice | None:
        fault = name_fault(row.parent, row.child)
        if fault is not None:
            return row.refused(*fault)
        frame = self._forest.number(row.child)
        moved = None
        if frame is None or self._forest.parents[frame] == NONE:
            refused = self._refused_edge(row)
        elif self._forest.names[self._forest.parents[frame]] == row.parent:
            return self._put_pose(row, frame)
        else:
            refused = self._refused_move(row, frame) or self._refused_edge(row)
            moved = self._moved(row, frame)
        if refused is not None:
            return refused
        self._hang(row)
        if moved is not None and frame is not None:
            self._moved_ns[frame] = row.now_ns
        return moved

    def _hang(self, row: _Row) -> None:
        """Give a frame a parent, or another one; forget its poses in the former."""
        frame = self._forest.hang(row.parent, row.child)
        for one in (self._histories, self._arrivals):
            one.fit(len(self._forest.names))
            one.clear(frame)
        self._store(row, frame)

    def _store(self, row: _Row, frame: int) -> None:
        if row.static:
            self._histories.put_static(frame, row.stamp_ns, row.pose)
        else:
            self._histories.insert(frame, row.stamp_ns, row.pose)
        publisher = self._arrivals.publisher(row.publisher)
        self._arrivals.note(np.array([frame]), publisher, row.now_ns)
        self._behind.pop(frame, None)

    def _put_pose(self, row: _Row, frame: int) -> Notice | None:
        """Add a pose of an existing edge."""
        at = np.array([frame])
        newest_ns = int(self._histories.newest_ns(at)[0])
        if row.static or self._histories.is_static(at)[0] or row.stamp_ns >= newest_ns:
            self._store(row, frame)
            return None
        if self._time_jumped(row, frame, newest_ns):
            return self._jump(row, frame, newest_ns)
        if row.stamp_ns < newest_ns - self._histories.history_ns:
            late_s = (newest_ns - row.stamp_ns) / 1e9
            reason = f"its stamp is {late_s:.1f} s older than the newest: compare the clocks"
            return row.refused("too_old", reason)
        self._histories.insert(frame, row.stamp_ns, row.pose)
        publisher = self._arrivals.publisher(row.publisher)
        self._arrivals.note_older(frame, publisher, row.now_ns)
        return None

    def _time_jumped(self, row: _Row, frame: int, newest_ns: int) -> bool:
        """Whether a stamp behind the newest means that time began again.

        It does when it comes from the publisher of the newest, or from another one after a pause; a
        stamp of 0 is one that was never set.
        """
        is_own = self._is_own(row, frame)
        if row.stamp_ns >= newest_ns - self._histories.history_ns:
            self._behind[frame] = self._behind.get(frame, 0) + 1 if is_own else 0
            return self._behind[frame] >= _BEHIND_MAX
        is_silent = row.now_ns - self._arrivals.last_ns(frame) >= _SILENT_NS
        return row.stamp_ns > 0 and (is_own or is_silent)

    def _jump(self, row: _Row, frame: int, newest_ns: int) -> Notice:
        """Forget what a publisher sent recentlyr times: its clock went back."""
        self.jump_back(
            self._arrivals.frames_of(self._arrivals.publisher_number(frame)), row.stamp_ns
        )
        if self._edge(row.parent, row.child) == NONE:
            self._hang(row)
        else:
            self._store(row, frame)
        sentence = (
            f'Time went back by {(newest_ns - row.stamp_ns) / 1e9:.3f} s for "{row.child}": its '
            "publisher's transforms of later times were dropped."
        )
        return Notice("time_jumped", *row[:2], row.publisher, sentence, left_out=False)

    def _refused_edge(self, row: _Row) -> Notice | None:
        is_above = self._forest.is_above(row.child, row.parent)
        if is_above is None:
            return row.refused("too_deep", f"{DEPTH_MAX} frames are above it already")
        if is_above:
            reason = "the parent hangs on the child already, and frames in a circle are nowhere"
            return row.refused("circle", reason)
        if not self._forest.room_for(row.parent, row.child):
            return row.refused("too_many", f"there are {FRAMES_MAX} frames already")
        return None

    def _refused_move(self, row: _Row, frame: int) -> Notice | None:
        """Refuse another parent, unless the frame's own publisher sends it or the edge is old."""
        newest_ns = int(self._histories.newest_ns(np.array([frame]))[0])
        is_old = row.stamp_ns - newest_ns > self._histories.history_ns
        moves_own = bool(row.publisher) and self._is_own(row, frame)
        has_rested = row.now_ns - self._moved_ns.get(frame, row.now_ns - _REST_NS) >= _REST_NS
        if is_old or (moves_own and has_rested):
            return None
        parent = self._forest.names[self._forest.parents[frame]]
        who = "its publisher sends both" if moves_own else "another publisher sends that"
        return row.refused("other_parent", f'"{row.child}" hangs on "{parent}", and {who}')

    def _is_own(self, row: _Row, frame: int) -> bool:
        return self._arrivals.publisher(row.publisher) == self._arrivals.publisher_number(frame)

    def _moved(self, row: _Row, frame: int) -> Notice:
        parent = self._forest.names[self._forest.parents[frame]]
        sentence = f'"{row.child}" was moved from "{parent}" to "{row.parent}".'
        return Notice("moved", row.parent, row.child, row.publisher, sentence, left_out=False)


def _unsound(row: _Row, columns: TransformColumns, at: int) -> Notice:
    fault = name_fault(row.parent, row.child) or number_fault(
        columns.translations[at], columns.rotations_wxyz[at], row.stamp_ns
    )
    return row.refused(*fault)


def _shortened(notices: list[Notice]) -> tuple[Notice, ...]:
    if len(notices) <= _NOTICES_MAX:
        return tuple(notices)
    more = f"{len(notices) - _NOTICES_MAX} more transforms of this message have faults."
    return (*notices[:_NOTICES_MAX], Notice("and_more", "", "", notices[0].publisher, more))
