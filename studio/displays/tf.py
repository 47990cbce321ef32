"""TF: all frames, their names, and arrows to their parents."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Final, NamedTuple

import numpy as np

from studio.displays.display import Display, Status
from studio.displays.drawing import NOTHING, Placed
from studio.displays.frame_choice import BLACKLIST, FRAMES, PROPERTIES, WHITELIST, FrameChoice
from studio.displays.frame_look import (
    Shades,
    arrows_to_parents,
    faded_axes,
    fresh_axes,
    name_of,
    shades_of,
)
from studio.displays.properties import UPDATE_INTERVAL, Property

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.displays.drawing import Drawing, Shape
    from studio.displays.properties import Value
    from studio.displays.turning import Flags, Floats
    from studio.ros.types.library import TypeLibrary
    from studio.tf.frames_now import FramesNow

NAMES_MAX: Final = 1000
"""Names are nodes of their own, and nobody could read more."""
_PARTS: Final = ("Show Names", "Show Axes", "Show Arrows")
_STILL: Final = 1e-6
"""Of a place in m or of a part of a quaternion: who moved less stands still."""


class _Seen(NamedTuple):
    """What of the frames is drawn: rows of those that are shown."""

    frames: FramesNow
    shown: Flags
    shades: Shades

    def shows_what(self, other: _Seen) -> bool:
        """Whether the same frames are shown, and have faded as far, wherever they are."""
        return (
            self.frames.names is other.frames.names
            and np.array_equal(self.shown, other.shown)
            and np.array_equal(self.shades.grey, other.shades.grey)
            and np.array_equal(self.shades.opacity, other.shades.opacity)
        )

    def stands_as(self, other: _Seen) -> bool:
        """Whether no eye would tell where frames are from where they were."""
        ours, theirs = self.frames, other.frames
        moved = np.abs(ours.wxyz_xyz - theirs.wxyz_xyz)
        return ours.fixed == theirs.fixed and bool(moved.max(initial=0.0) <= _STILL)


class TfDisplay(Display):
    """Draws frames that it is shown; it takes no messages, since one buffer serves all displays.

    Crosses and arrows are few nodes in the fixed frame. Each name is a group of its own that
    follows its frame, so that it is sent once.
    """

    KIND = "TF"
    DOC = "Shows all frames with their names, and arrows to their parents."
    OF_TYPES: ClassVar[tuple[str, ...]] = ("tf2_msgs/msg/TFMessage",)
    """Messages by which one finds this display."""
    PROPERTIES: ClassVar[tuple[Property, ...]] = (
        Property("Show Names", "switch", default=True, doc="Writes the name of each frame."),
        Property("Show Axes", "switch", default=True, doc="Shows the axes of each frame."),
        Property(
            "Show Arrows", "switch", default=True, doc="Shows an arrow from each to its parent."
        ),
        Property(
            "Marker Scale", "number", 1.0, "Size of axes, arrows and names.", low=0.001, high=1000.0
        ),
        Property(
            "Marker Alpha", "number", 1.0, "How opaque they are: 0 is not seen.", low=0.0, high=1.0
        ),
        Property(
            "Name Height",
            "number",
            0.0,
            "Height of the names in the scene, times the scale; 0 can be read from anywhere.",
            low=0.0,
            high=1000.0,
            unit="m",
            when=("Show Names", (True,)),
        ),
        Property(
            "Frame Timeout",
            "number",
            15.0,
            "After this time without news a frame has faded away.",
            low=1.0,
            high=1e6,
            unit="s",
        ),
        UPDATE_INTERVAL,
        *PROPERTIES,
    )
    SETTINGS_MAX = 25_000

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self._choice = FrameChoice(self.values)
        self._frames: FramesNow | None = None
        self._seen: _Seen | None = None
        self._drawing: Drawing = NOTHING
        self._drawn_ns = 0
        self._names: dict[str, Placed] = {}
        self._checks: tuple[tuple[str, ...], Value, tuple[Property, ...]] = ((), True, ())

    def show(self, frames: FramesNow) -> None:
        """Draw these from now on."""
        self._frames = frames

    def properties(self) -> tuple[Property, ...]:
        """Those of all frames, and a check for each frame that is there."""
        names = () if self._frames is None else self._frames.names
        if self._checks[0] is not names or self._checks[1] != self.values[FRAMES]:
            checks = tuple(self._property(f"{FRAMES}/{name}") for name in sorted(names))
            self._checks = names, self.values[FRAMES], checks
        return (*self.PROPERTIES, *self._checks[2])

    def changed(self, name: str) -> None:
        """Draw anew; switching all is switching each, as in RViz."""
        if name == FRAMES:
            for each in [one for one in self.values if one.startswith(f"{FRAMES}/")]:
                del self.values[each]
        self._choice.changed()
        self._names = {}
        self._seen = None

    def reset(self) -> None:
        """Forget what was shown."""
        self._frames = None
        super().reset()

    def draw(self, now_ns: int) -> Drawing:
        """What is to be seen of the frames shown last."""
        if self._frames is None or not self.values["Marker Alpha"]:
            self._seen = None
            return NOTHING
        if self._rests(self._frames.fixed, now_ns):
            return self._drawing
        self._drawn_ns = now_ns
        seen = self._look(self._frames)
        before, self._seen = self._seen, seen
        is_same = before is not None and seen.shows_what(before)
        if not is_same:
            self._names = self._written(seen) if self.values["Show Names"] else {}
        if before is None or not is_same or not seen.stands_as(before):
            self._drawing = self._drawn(seen)
        else:
            # Who creeps is drawn anew when he has come far enough from where he was drawn.
            self._seen = before
        return self._drawing

    def statuses(self) -> tuple[Status, ...]:
        """Why nothing is seen of the frames, and what is left out."""
        if not self.values["Marker Alpha"]:
            words = "Marker Alpha is 0, so nothing of the frames is seen."
            return (Status("warn", "transparent", words, ("Marker Alpha", 1.0)),)
        if not any(self.values[part] for part in _PARTS):
            words = "Neither names, axes nor arrows of the frames are switched on."
            return (Status("warn", "empty", words, ("Show Axes", True)),)
        if self._frames is None or not self._frames.names:
            return (Status("warn", "empty", "No transform has come yet."),)
        found = (self._nothing_chosen(), self._not_connected(), self._too_many())
        return tuple(one for one in found if one is not None)

    def _nothing_chosen(self) -> Status | None:
        if self._frames is None or self._choice.of(self._frames.names).any():
            return None
        for name in (WHITELIST, BLACKLIST):
            if self.values[name]:
                words = f"{name} lets no frame through."
                return Status("warn", "empty", words, (name, ""))
        return Status("warn", "empty", "All frames are switched off.", (FRAMES, True))

    def _not_connected(self) -> Status | None:
        if self._frames is None:
            return None
        lost = _rows(self._choice.of(self._frames.names) & ~self._frames.connected)
        if not lost:
            return None
        names = [self._frames.names[row] for row in lost[:3]]
        more = f" and {len(lost) - len(names)} more" if len(lost) > len(names) else ""
        words = f"Nothing connects {', '.join(names)}{more} with {self._frames.fixed}."
        return Status("error", "not_connected_frame", words)

    def _too_many(self) -> Status | None:
        count = 0 if self._seen is None else int(self._seen.shown.sum())
        if not self.values["Show Names"] or count <= NAMES_MAX:
            return None
        words = f"Of {count} frames the names of {NAMES_MAX} are written: filter the others."
        return Status("warn", "unsupported", words)

    def _look(self, frames: FramesNow) -> _Seen:
        shades = shades_of(frames.ages_s, float(self.values["Frame Timeout"]))
        drawable = np.abs(frames.wxyz_xyz).max(axis=1, initial=0.0) < 1e30
        shown = self._choice.of(frames.names) & frames.connected & drawable
        return _Seen(frames, shown & (shades.opacity > 0.0), shades)

    def _rests(self, fixed: str, now_ns: int) -> bool:
        """Whether what is drawn stays as it is until its interval is over."""
        is_drawn = self._seen is not None and self._seen.frames.fixed == fixed
        return is_drawn and 0 <= now_ns - self._drawn_ns < self.interval_ns

    def _drawn(self, seen: _Seen) -> Drawing:
        shapes: dict[str, Shape] = {}
        if self.values["Show Axes"]:
            shapes |= self._axes(seen)
        if self.values["Show Arrows"]:
            shapes |= self._arrows(seen)
        if not shapes:
            return self._names
        return {"frames": Placed(seen.frames.fixed, 0, shapes, follows=True), **self._names}

    def _axes(self, seen: _Seen) -> dict[str, Shape]:
        poses, fresh = seen.frames.wxyz_xyz, seen.shown & seen.shades.fresh
        faded = seen.shown & ~seen.shades.fresh
        axes: dict[str, Shape] = {}
        if fresh.any():
            axes["axes"] = fresh_axes(poses[fresh], *self._size)
        if faded.any():
            axes["old_axes"] = faded_axes(poses[faded], seen.shades.of(faded), *self._size)
        return axes

    def _arrows(self, seen: _Seen) -> dict[str, Shape]:
        parents = seen.frames.parents
        hung = seen.shown & (parents >= 0)
        hung[hung] = seen.frames.connected[parents[hung]]
        places: Floats = seen.frames.wxyz_xyz[:, 4:]
        shades = seen.shades.of(hung)
        return {**arrows_to_parents(places[hung], places[parents[hung]], shades, *self._size)}

    def _written(self, seen: _Seen) -> dict[str, Placed]:
        """The names by their paths; one that looks as before is the same object."""
        scale, alpha = self._size
        height_m = float(self.values["Name Height"]) * scale
        written: dict[str, Placed] = {}
        for row in _rows(seen.shown)[:NAMES_MAX]:
            name = seen.frames.names[row]
            opacity = alpha * float(seen.shades.opacity[row])
            text = name_of(name, float(seen.shades.grey[row]), opacity, height_m)
            path = f"names/{name}"
            before = self._names.get(path)
            is_same = before is not None and before.shapes["name"] == text
            written[path] = (
                before if before and is_same else Placed(name, 0, {"name": text}, follows=True)
            )
        return written

    @property
    def _size(self) -> tuple[float, float]:
        """Scale and opacity."""
        return float(self.values["Marker Scale"]), float(self.values["Marker Alpha"])

    def _property(self, name: str) -> Property:
        if not name.startswith(f"{FRAMES}/"):
            return super()._property(name)
        # While an instance is made, the switch of all may not have come yet.
        default = self.values.get(FRAMES, True)
        return Property(name, "switch", default=default, doc="Shows this frame.")


def _rows(flags: Flags) -> list[int]:
    return [int(row) for row in np.flatnonzero(flags)]
