"""TF: the axes and names of all frames, and arrows to their parents; frames without news fade."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar, Final, NamedTuple

import numpy as np

from studio.displays.display import Display, Status
from studio.displays.drawing import NOTHING, Axes, Placed, Rgb, Solids, Text
from studio.displays.frame_choice import (
    BLACKLIST,
    FILTER_PROPERTIES,
    FRAMES,
    WHITELIST,
    FrameChoice,
)
from studio.displays.properties import UPDATE_INTERVAL, Property
from studio.displays.selection import (
    Fact,
    Item,
    box_at,
    number_fact,
    orientation_fact,
    position_fact,
    wxyz_of,
    xyz_of,
)
from studio.displays.trails import TRAILS_MAX, Trails
from studio.displays.turning import product, products, turned, turns_from_z

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from studio.displays.drawing import Drawing, Lines, Shape
    from studio.displays.properties import Value
    from studio.displays.selection import Picked
    from studio.displays.turning import Flags, Floats
    from studio.ros.types.library import TypeLibrary
    from studio.tf.frames import FramesNow

TRAILS: Final = "Trails"
SHOW_AGES: Final = "Show Ages"

# At a scale of 1, m.
_AXIS_LENGTH_M: Final = 0.2
_AXIS_RADIUS_M: Final = 0.01
_SHAFT_M: Final = 0.01
_HEAD_M: Final = 0.04
_HEAD_LENGTH_M: Final = 0.1
_NEAR_M: Final = 0.001
"""Parents that are nearer have no arrow."""
_RED_GREEN_BLUE: Final = np.array([[255, 0, 0], [0, 255, 0], [0, 0, 255]], np.float64)
_SHAFT: Final = np.array([204, 204, 76], np.float64)
_HEAD: Final = np.array([255, 26, 153], np.float64)
_WHITE: Final = np.array([255, 255, 255], np.float64)
_GREY: Final = np.array([179, 179, 179], np.float64)
_HALF: Final = 0.5**0.5
_ALONG_AXES: Final = np.array(
    [[_HALF, 0.0, _HALF, 0.0], [_HALF, -_HALF, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]
)
"""Turns of z onto x, y and z."""
NAMES_MAX: Final = 1000
"""Limit: each name is a node of the scene, and nobody could read more."""
_PARTS: Final = ("Show Names", "Show Axes", "Show Arrows")
_TRAIL_RGB: Final = (240, 180, 60)
_FRESH: Final = np.array([90, 220, 130], np.float64)
_OLD: Final = np.array([255, 70, 50], np.float64)
_FRAMES_PATH: Final = "frames"
_NAME_PATH: Final = "names/"
_STILL: Final = 1e-6
"""A frame whose position in m or parts of a quaternion changed less did not move."""


class Shades(NamedTuple):
    """How far N frames have faded.

    Attributes:
        grey: Shape (N,): 0 is its own colours, 1 is grey.
        opacity: Shape (N,).
    """

    grey: Floats
    opacity: Floats

    @property
    def fresh(self) -> NDArray[np.bool_]:
        """Which have not faded at all."""
        return self.grey == 0.0

    def of(self, chosen: NDArray[np.bool_]) -> Shades:
        """Return those of some."""
        return Shades(self.grey[chosen], self.opacity[chosen])


def shades_of(ages_s: Floats, timeout_s: float, steps: int = 32) -> Shades:
    """RViz's fading: a third of the time as they are, a third to grey, and a third to nothing.

    It goes in steps, so that what fades slowly is not drawn again all the time.
    """
    thirds = ages_s * 3.0 / timeout_s
    grey = np.round((thirds - 1.0).clip(0.0, 1.0) * steps) / steps
    opacity = np.round((3.0 - thirds).clip(0.0, 1.0) * steps) / steps
    return Shades(grey, opacity)


def fresh_axes(poses: Floats, scale: float, alpha: float) -> Axes:
    """Crosses at poses (N, 7) of frames that have not faded."""
    return Axes(
        poses[:, 4:].astype(np.float32),
        poses[:, :4].astype(np.float32),
        _AXIS_LENGTH_M * scale,
        _AXIS_RADIUS_M * scale,
        alpha,
    )


def faded_axes(poses: Floats, shades: Shades, scale: float, alpha: float) -> Solids:
    """Crosses at poses (N, 7), each axis a cylinder with a colour of its own."""
    count = len(poses)
    turns = np.repeat(poses[:, :4], 3, axis=0)
    wxyz = products(turns, np.tile(_ALONG_AXES, (count, 1)))
    middles = turned(wxyz, np.array([0.0, 0.0, _AXIS_LENGTH_M * scale / 2]))
    thick, long = 2 * _AXIS_RADIUS_M * scale, _AXIS_LENGTH_M * scale
    grey = np.repeat(shades.grey, 3)
    return Solids(
        "cylinder",
        (np.repeat(poses[:, 4:], 3, axis=0) + middles).astype(np.float32),
        wxyz.astype(np.float32),
        np.tile(np.array([thick, thick, long], np.float32), (3 * count, 1)),
        _greyed(np.tile(_RED_GREEN_BLUE, (count, 1)), grey),
        _opacities(np.repeat(shades.opacity, 3), alpha),
    )


def arrows_to_parents(
    children: Floats, parents: Floats, shades: Shades, scale: float, alpha: float
) -> dict[str, Solids]:
    """Shafts and heads of arrows from places (N, 3) of children to those of their parents."""
    offsets = parents - children
    lengths = np.sqrt(np.einsum("ij,ij->i", offsets, offsets))
    far = lengths > _NEAR_M
    if not far.any():
        return {}
    shades, children, lengths = shades.of(far), children[far], lengths[far]
    along = offsets[far] / lengths[:, None]
    heads, shafts = _parts_of_arrows(lengths, _HEAD_LENGTH_M * scale)
    opacities = _opacities(shades.opacity, alpha)
    shaft = Solids(
        "cylinder",
        (children + along * (shafts / 2)[:, None]).astype(np.float32),
        turns_from_z(along).astype(np.float32),
        _sizes(_SHAFT_M * scale, shafts),
        _greyed(np.tile(_SHAFT, (len(along), 1)), shades.grey),
        opacities,
    )
    # A cone stands on its tip, so it opens from the parent back to the child.
    head = Solids(
        "cone",
        (children + along * lengths[:, None]).astype(np.float32),
        turns_from_z(-along).astype(np.float32),
        _sizes(_HEAD_M * scale, heads),
        _greyed(np.tile(_HEAD, (len(along), 1)), shades.grey),
        opacities,
    )
    return {"shafts": shaft, "heads": head}


def _parts_of_arrows(lengths_m: Floats, head_m: float) -> tuple[Floats, Floats]:
    """Lengths of heads and shafts: short arrows have shorter heads, as RViz draws them."""
    heads_m: Floats = np.where(lengths_m < head_m, head_m * lengths_m, head_m)
    heads_m = np.minimum(heads_m, lengths_m)
    return heads_m, lengths_m - heads_m


def name_text(name: str, grey: float, opacity: float, height_m: float) -> Text:
    """Return the name of a frame, at its origin; of height 0 it has one size on the screen."""
    red, green, blue = (_WHITE + grey * (_GREY - _WHITE)).astype(int).tolist()
    rgb: Rgb = (red, green, blue)
    return Text(name, height_m=height_m, rgb=rgb, opacity=opacity)


def _greyed(colors: Floats, grey: Floats) -> NDArray[np.uint8]:
    return (colors + grey[:, None] * (_GREY - colors)).astype(np.uint8)


def _opacities(opacities: Floats, alpha: float) -> NDArray[np.float32] | float:
    return alpha if (opacities == 1.0).all() else (opacities * alpha).astype(np.float32)


def _sizes(thick_m: float, lengths_m: Floats) -> NDArray[np.float32]:
    sizes = np.full((len(lengths_m), 3), thick_m, np.float32)
    sizes[:, 2] = lengths_m
    return sizes


class _Seen(NamedTuple):
    """Rows of the frames that are drawn."""

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

    def equals(self, other: _Seen) -> bool:
        """Whether the frames are where they were, as far as anybody could see."""
        ours, theirs = self.frames, other.frames
        moved = np.abs(ours.wxyz_xyz - theirs.wxyz_xyz)
        return ours.fixed == theirs.fixed and bool(moved.max(initial=0.0) <= _STILL)


class TfDisplay(Display):
    """Draws the frames given to `see`; it takes no messages, since one buffer serves all displays.

    Crosses and arrows are few nodes in the fixed frame. Each name is a group of its own that
    follows its frame, so that it is sent once.
    """

    KIND = "TF"
    DOC = "Shows all frames with their names, and arrows to their parents."
    ICON = "frames"
    OF_TYPES: ClassVar[tuple[str, ...]] = ("tf2_msgs/msg/TFMessage",)
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
        Property(
            SHOW_AGES,
            "switch",
            default=False,
            doc="Writes how old the transforms of a frame are, from green to red.",
            when=("Show Names", (True,)),
        ),
        Property(TRAILS, "switch", default=False, doc="Shows the ways of all frames, or of none."),
        Property(
            "Trail Time",
            "number",
            5.0,
            "How long a way is shown.",
            low=0.1,
            high=600.0,
            unit="s",
        ),
        *FILTER_PROPERTIES,
    )
    SETTINGS_MAX = 25_000

    # Its properties ask for these while an instance is made.
    _frames: FramesNow | None = None
    _ages: tuple[int, ...] = ()
    """Of each frame in whole seconds, while they are shown."""

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self._choice = FrameChoice(self.values)
        self._seen: _Seen | None = None
        self._drawing: Drawing = NOTHING
        self._drawn_ns = 0
        self._drawn_trails: Lines | None = None
        self._names: dict[str, Placed] = {}
        self._checks: tuple[object, tuple[Property, ...]] = ((), ())
        self._trails = Trails(width_m=0.005)
        self._trailed: tuple[tuple[str, ...], list[int]] | None = None

    @property
    def wants_frames(self) -> bool:
        """All of them: they are what it draws."""
        return True

    def see(self, frames: FramesNow) -> None:
        """Draw these from now on."""
        self._frames = frames

    def properties(self) -> tuple[Property, ...]:
        """Properties of all frames, and two switches for each frame."""
        names = () if self._frames is None else self._frames.names
        key = names, self.values[FRAMES], self.values[TRAILS], self._ages
        if self._checks[0] != key:
            every = sorted(names)
            made = [self._property(f"{kind}/{name}") for kind in (FRAMES, TRAILS) for name in every]
            self._checks = key, tuple(made)
        return (*self.PROPERTIES, *self._checks[1])

    def changed(self, name: str) -> None:
        """Draw again; switching all is switching each, as in RViz."""
        if name in (FRAMES, TRAILS):
            for each in [one for one in self.values if one.startswith(f"{name}/")]:
                del self.values[each]
        self._choice.changed()
        self._trailed = None
        self._names = {}
        self._seen = None

    def reset(self) -> None:
        """Forget what was shown."""
        self._frames = None
        self._trails = Trails(width_m=0.005)
        super().reset()

    def draw(self, now_ns: int) -> Drawing:
        """Draw the frames shown last."""
        if self._frames is None or not self.values["Marker Alpha"]:
            self._seen = None
            return NOTHING
        self._go_on(self._frames, now_ns)
        if self._rests(self._frames.fixed, now_ns):
            return self._drawing
        self._drawn_ns = now_ns
        seen = self._seen_of(self._frames)
        before, self._seen = self._seen, seen
        is_same = before is not None and seen.shows_what(before)
        if not is_same:
            self._names = self._written(seen) if self.values["Show Names"] else {}
        trails = self._trails.lines(_TRAIL_RGB)
        if (
            before is None
            or not is_same
            or not seen.equals(before)
            or trails is not self._drawn_trails
        ):
            self._drawn_trails = trails
            self._drawing = self._drawn(seen)
        else:
            # A slow frame is drawn again once it is far enough from where it was drawn.
            self._seen = before
        return self._drawing

    def picked(self, picked: Picked) -> Sequence[str]:
        """Return the names of frames by their axes, their arrows or their names."""
        if picked.path.startswith(_NAME_PATH):
            return (picked.path.removeprefix(_NAME_PATH),)
        seen = self._seen
        if seen is None:
            return ()
        found = _rows(_of_shape(seen, picked.shape))
        each = 3 if picked.shape == "old_axes" else 1
        rows: list[int] = np.unique(picked.rows // each).tolist()
        return [seen.frames.names[found[row]] for row in rows if 0 <= row < len(found)]

    def item(self, key: str) -> Item | None:
        """Return a frame that is drawn."""
        seen = self._seen
        row = seen.frames.rows.get(key) if seen is not None else None
        if seen is None or row is None or not seen.shown[row]:
            return None
        pose = seen.frames.wxyz_xyz[row]
        scale = _AXIS_LENGTH_M * self._size[0]
        middle = pose[4:] + turned(pose[None, :4], np.full(3, scale / 2))[0]
        box = box_at(middle, (scale,) * 3, pose[:4])
        at = xyz_of(pose[4:]), wxyz_of(pose[:4])
        return Item("frame", key, _FRAMES_PATH, seen.frames.fixed, 0, box, *at)

    def facts(self, key: str) -> tuple[Fact, ...]:
        """Return the parent of a frame, its pose in the parent, and its age."""
        seen = self._seen
        row = seen.frames.rows.get(key) if seen is not None else None
        if seen is None or row is None:
            return ()
        found = [Fact("name", key)]
        parent = int(seen.frames.parents[row])
        if parent >= 0 and seen.frames.connected[parent]:
            wxyz, xyz = _between(seen.frames.wxyz_xyz[parent], seen.frames.wxyz_xyz[row])
            parent_name = Fact("parent", seen.frames.names[parent])
            found += [parent_name, position_fact(xyz), orientation_fact(wxyz)]
        found.append(number_fact("age", float(seen.frames.ages_s[row]), "s"))
        return tuple(found)

    def statuses(self) -> tuple[Status, ...]:
        """Why nothing is seen of the frames, and what is left out."""
        if not self.values["Marker Alpha"]:
            sentence = "Marker Alpha is 0, so nothing of the frames is seen."
            return (Status("warn", "transparent", sentence, ("Marker Alpha", 1.0)),)
        if not any(self.values[part] for part in _PARTS):
            sentence = "Neither names, axes nor arrows of the frames are switched on."
            return (Status("warn", "empty", sentence, ("Show Axes", True)),)
        if self._frames is None or not self._frames.names:
            return (Status("warn", "empty", "No transform has come yet."),)
        found = (self._nothing_chosen(), self._not_connected(), self._too_many())
        return tuple(one for one in found if one is not None)

    def _nothing_chosen(self) -> Status | None:
        if self._frames is None or self._choice.of(self._frames.names).any():
            return None
        for name in (WHITELIST, BLACKLIST):
            if self.values[name]:
                sentence = f"{name} lets no frame through."
                return Status("warn", "empty", sentence, (name, ""))
        return Status("warn", "empty", "All frames are switched off.", (FRAMES, True))

    def _not_connected(self) -> Status | None:
        if self._frames is None:
            return None
        lost = _rows(self._choice.of(self._frames.names) & ~self._frames.connected)
        if not lost:
            return None
        names = [self._frames.names[row] for row in lost[:3]]
        more = f" and {len(lost) - len(names)} more" if len(lost) > len(names) else ""
        sentence = f"Nothing connects {', '.join(names)}{more} with {self._frames.fixed}."
        return Status("error", "not_connected_frame", sentence)

    def _too_many(self) -> Status | None:
        count = 0 if self._seen is None else int(self._seen.shown.sum())
        if not self.values["Show Names"] or count <= NAMES_MAX:
            return None
        sentence = f"Of {count} frames the names of {NAMES_MAX} are written: filter the others."
        return Status("warn", "unsupported", sentence)

    def _seen_of(self, frames: FramesNow) -> _Seen:
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
        if self._drawn_trails is not None:
            shapes["trails"] = self._drawn_trails
        if not shapes:
            return self._names
        return {_FRAMES_PATH: Placed(seen.frames.fixed, 0, shapes, follows=True), **self._names}

    def _go_on(self, frames: FramesNow, now_ns: int) -> None:
        """Take where the frames are for their trails, and how old they are."""
        shown = self._choice.of(frames.names) & frames.connected
        rows = [row for row in self._trailed_rows(frames.names) if shown[row]][:TRAILS_MAX]
        self._trails.keep([frames.names[row] for row in rows], frames.fixed)
        for row in rows:
            place: list[float] = frames.wxyz_xyz[row, 4:].tolist()
            self._trails.add(frames.names[row], place, now_ns)
        self._trails.forget_before(now_ns - round(float(self.values["Trail Time"]) * 1e9))
        ages: tuple[int, ...] = ()
        if self.values[SHOW_AGES]:
            ages = tuple(np.nan_to_num(frames.ages_s, posinf=0.0).astype(int).tolist())
        if ages != self._ages:
            self._ages, self._seen = ages, None

    def _trailed_rows(self, names: tuple[str, ...]) -> list[int]:
        """Return the rows of frames whose trails are wanted; names are gone through once."""
        if self._trailed is None or self._trailed[0] is not names:
            every, values = self.values[TRAILS], self.values
            rows = [row for row, name in enumerate(names) if values.get(f"{TRAILS}/{name}", every)]
            self._trailed = names, rows
        return self._trailed[1]

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
        hung = _hung(seen)
        places: Floats = seen.frames.wxyz_xyz[:, 4:]
        shades = seen.shades.of(hung)
        return {**arrows_to_parents(places[hung], places[parents[hung]], shades, *self._size)}

    def _written(self, seen: _Seen) -> dict[str, Placed]:
        """Return the names by path; one that did not change is the same object."""
        scale, alpha = self._size
        height_m = float(self.values["Name Height"]) * scale
        written: dict[str, Placed] = {}
        for row in _rows(seen.shown)[:NAMES_MAX]:
            name = seen.frames.names[row]
            opacity = alpha * float(seen.shades.opacity[row])
            text = name_text(name, float(seen.shades.grey[row]), opacity, height_m)
            if self._ages:
                text = self._with_age(text, self._ages[row])
            path = f"{_NAME_PATH}{name}"
            before = self._names.get(path)
            is_same = before is not None and before.shapes["name"] == text
            written[path] = (
                before if before and is_same else Placed(name, 0, {"name": text}, follows=True)
            )
        return written

    def _with_age(self, text: Text, age_s: int) -> Text:
        """Write how old a frame is behind its name, the redder the nearer it is to its timeout."""
        share = min(1.0, age_s / float(self.values["Frame Timeout"]))
        red, green, blue = (_FRESH + share * (_OLD - _FRESH)).astype(int).tolist()
        words = f"{text.text} ({age_s} s)" if age_s else text.text
        return replace(text, text=words, rgb=(red, green, blue))

    @property
    def _size(self) -> tuple[float, float]:
        """Scale and opacity."""
        return float(self.values["Marker Scale"]), float(self.values["Marker Alpha"])

    def _property(self, name: str) -> Property:
        if name.startswith(f"{TRAILS}/"):
            default = self.values.get(TRAILS, False)
            return Property(name, "switch", default=default, doc="Shows the way of this frame.")
        if not name.startswith(f"{FRAMES}/"):
            return super()._property(name)
        # While an instance is made, the switch of all may not have come yet.
        default = self.values.get(FRAMES, True)
        return Property(name, "switch", default=default, doc=self._doc_of(name))

    def _doc_of(self, name: str) -> str:
        frames = self._frames
        row = frames.rows.get(name.removeprefix(f"{FRAMES}/")) if frames is not None else None
        if row is None or row >= len(self._ages):
            return "Shows this frame."
        return f"Shows this frame; its oldest transform came {self._ages[row]} s ago."


def _hung(seen: _Seen) -> Flags:
    """Return which frames hang from a parent that is connected, too."""
    parents = seen.frames.parents
    hung = seen.shown & (parents >= 0)
    hung[hung] = seen.frames.connected[parents[hung]]
    return hung


def _of_shape(seen: _Seen, shape: str) -> Flags:
    """Return which frames a shape draws, in its order."""
    if shape == "axes":
        return seen.shown & seen.shades.fresh
    if shape == "old_axes":
        return seen.shown & ~seen.shades.fresh
    hung, places = _hung(seen), seen.frames.wxyz_xyz[:, 4:]
    offsets = places[seen.frames.parents[hung]] - places[hung]
    hung[hung] = np.sqrt(np.einsum("ij,ij->i", offsets, offsets)) > _NEAR_M
    return hung


def _between(parent: Floats, child: Floats) -> tuple[Floats, Floats]:
    """Return how a child is turned and where it is in its parent, of poses (7,) in one frame."""
    back = parent[:4] * (1.0, -1.0, -1.0, -1.0)
    return product(back, child[:4]), turned(back[None], child[4:] - parent[4:])[0]


def _rows(flags: Flags) -> list[int]:
    return [int(row) for row in np.flatnonzero(flags)]
