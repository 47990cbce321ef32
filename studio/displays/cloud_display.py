"""The base of displays of points: RViz's properties, colours, and messages that decay."""

from __future__ import annotations

from abc import abstractmethod
from collections import deque
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar, Final, cast

import numpy as np

from studio.displays.cloud import listed
from studio.displays.colour_maps import COLOUR_MAPS, RAINBOW, mapped
from studio.displays.display import Display, Limits, Status, reading_fields
from studio.displays.drawing import BODIES_MAX, NOTHING, Drawing, Placed, Points
from studio.displays.properties import Property, rgb_of
from studio.displays.selection import (
    FACTS_MAX,
    NEWEST,
    Fact,
    Item,
    box_at,
    index_of,
    number_fact,
    position_fact,
    row_of,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from studio.displays.cloud import Cloud
    from studio.displays.display import Received
    from studio.displays.drawing import PointStyle
    from studio.displays.properties import Value
    from studio.displays.selection import ItemKind, Picked
    from studio.ros.types.library import TypeLibrary

AUTOMATIC: Final = "Automatic"
FLAT, AXIS, INTENSITY, RGB8, RGBF32 = "FlatColor", "AxisColor", "Intensity", "RGB8", "RGBF32"
_POINTS: Final = "Points"
_STYLES: Final = (_POINTS, "Squares", "Flat Squares", "Spheres", "Boxes", "Tiles")
_BODIES: Final = ("Boxes", "Tiles")
_WITH_MAP: Final = (AUTOMATIC, AXIS, INTENSITY)
_WITH_CHANNEL: Final = (AUTOMATIC, INTENSITY)
_CHANNEL: Final = "intensity"
_OTHER_NAME: Final = "intensities"

POINTS_AT_MOST: Final = "Points at most"
POINTS_LIMIT: Final = 5_000_000

CLOUD_PROPERTIES: Final = (
    Property("Style", "choice", "Flat Squares", "How each point is drawn.", choices=_STYLES),
    Property(
        "Size (m)", "number", 0.01, "Size of each point.", low=0.0001, high=100.0, unit="m",
        when=("Style", _STYLES[1:]),
    ),
    Property(
        "Size (Pixels)", "number", 3.0, "Size of each point on the screen, near or far.",
        low=1.0, high=100.0, unit="px", when=("Style", (_POINTS,)),
    ),
    Property("Alpha", "number", 1.0, "How opaque the points are.", low=0.0, high=1.0),
    Property(
        "Decay Time", "number", 0.0, "How long points stay; with 0 only the newest message does.",
        low=0.0, high=3600.0, unit="s",
    ),
    Property(
        "Position Transformer", "choice", "XYZ", "Where the place of a point comes from.",
        choices=("XYZ",),
    ),
    Property(
        "Color Transformer", "choice", AUTOMATIC,
        "Where colours come from; by itself it takes the colours that are sent, else intensities, "
        "else the height.",
        choices=(AUTOMATIC, INTENSITY, AXIS, FLAT, RGB8, RGBF32),
    ),
    Property(
        "Color", "colour", "#ffffff", "Of all points.", when=("Color Transformer", (FLAT,))
    ),
    Property(
        "Axis", "choice", "Z", "The axis along which colours change, in the frame of the message.",
        choices=("X", "Y", "Z"), when=("Color Transformer", (AUTOMATIC, AXIS)),
    ),
    Property(
        "Autocompute Value Bounds", "switch", True,  # noqa: FBT003 - its first value
        "Whether colours reach from the least to the greatest value along the axis.",
        when=("Color Transformer", (AUTOMATIC, AXIS)),
    ),
    Property(
        "Autocompute Value Bounds/Min Value", "number", -10.0, "Where colours begin.", unit="m",
        when=("Autocompute Value Bounds", (False,)),
    ),
    Property(
        "Autocompute Value Bounds/Max Value", "number", 10.0, "Where colours end.", unit="m",
        when=("Autocompute Value Bounds", (False,)),
    ),
    Property(
        "Channel Name", "text", _CHANNEL, "The field whose numbers give the colours.",
        when=("Color Transformer", _WITH_CHANNEL),
    ),
    Property(
        "Use rainbow", "switch", True,  # noqa: FBT003
        "Whether colours come of a map, or lie between two.",
        when=("Color Transformer", _WITH_CHANNEL),
    ),
    Property(
        "Color Map", "choice", RAINBOW, "Which colours there are from the least to the greatest.",
        choices=COLOUR_MAPS, when=("Color Transformer", _WITH_MAP),
    ),
    Property(
        "Invert Rainbow", "switch", False,  # noqa: FBT003
        "Whether the map begins with its last colour.", when=("Use rainbow", (True,)),
    ),
    Property("Min Color", "colour", "#000000", "Of the least.", when=("Use rainbow", (False,))),
    Property("Max Color", "colour", "#ffffff", "Of the greatest.", when=("Use rainbow", (False,))),
    Property(
        "Autocompute Intensity Bounds", "switch", True,  # noqa: FBT003
        "Whether colours reach from the least to the greatest number of the message.",
        when=("Color Transformer", _WITH_CHANNEL),
    ),
    Property(
        "Min Intensity", "number", 0.0, "Where colours begin.",
        when=("Autocompute Intensity Bounds", (False,)),
    ),
    Property(
        "Max Intensity", "number", 4096.0, "Where colours end.",
        when=("Autocompute Intensity Bounds", (False,)),
    ),
    Property(
        POINTS_AT_MOST, "whole", Limits().points,
        "Of more points as many are drawn, spread evenly, and older messages are left out.",
        low=1000, high=POINTS_LIMIT,
    ),
)  # fmt: skip

_SHAPE: Final = "points"
_WHITE: Final = np.full(3, 255, dtype=np.uint8)
_SIZE: Final = "Size (m)"
_WITHOUT_COLOUR: Final = {"Style", _SIZE, "Size (Pixels)", "Alpha", "Decay Time", POINTS_AT_MOST}


def points_of(
    cloud: Cloud, colours: NDArray[np.uint8], values: Mapping[str, Value], *, precise: bool
) -> Points:
    """Return the shape of a cloud in its colours, in the size that is set."""
    style = str(values["Style"])
    return Points(
        cloud.positions,
        colours,
        size_m=float(values["Size (m)"]),
        style=cast("PointStyle", style.lower()),
        opacity=float(values["Alpha"]),
        precise=precise,
        size_px=float(values["Size (Pixels)"]) if style == _POINTS else 0.0,
    )


def too_many_bodies(count: int, values: Mapping[str, Value]) -> Status | None:
    """Return a status if so many points cannot be drawn in the style that was chosen."""
    style = str(values["Style"])
    if style not in _BODIES or count <= BODIES_MAX:
        return None
    sentence = (
        f"{count:,} points are drawn as squares: as {style.lower()} there may be {BODIES_MAX:,}."
    )
    return Status("ok", "thinned", sentence, ("Style", "Flat Squares"))


def needs_precision(positions: NDArray[np.float32], size_m: float) -> bool:
    """Whether half precision would move a point by a part of its size that is seen.

    Between 8 and 16 m its steps are 8 mm, and twice that from one power of two to the next: as wide
    as half a point they are seen as stripes.
    """
    if not len(positions):
        return False
    farthest_m = float(max(positions.max(), -positions.min()))
    if farthest_m <= 0.0:
        return False
    step_m = 2.0 ** (np.floor(np.log2(farthest_m)) - 10)
    return bool(step_m > size_m / 2)


def colours_of(
    cloud: Cloud, values: Mapping[str, Value]
) -> tuple[NDArray[np.uint8], Status | None]:
    """Colours of the points, shape (N, 3), or (3,) when all have one.

    Returns:
        The colours, white where there are none, and a status if something is wrong with them.
    """
    wanted = str(values["Color Transformer"])
    if wanted == AUTOMATIC:
        return _automatic(cloud, values), None
    if wanted == FLAT:
        return np.array(rgb_of(values["Color"]), dtype=np.uint8), None
    if wanted == AXIS:
        return _by_axis(cloud, values), None
    if wanted == INTENSITY:
        found = _by_channel(cloud, values)
        return (found, None) if found is not None else (_WHITE, _no_channel(cloud, values))
    sent = cloud.channels.colours if wanted == RGB8 else cloud.channels.float_colours
    found = sent(cloud.raw)
    return (found, None) if found is not None else (_WHITE, _no_colours(cloud, wanted))


def _automatic(cloud: Cloud, values: Mapping[str, Value]) -> NDArray[np.uint8]:
    """Colour as RViz does; where RViz draws white for want of a channel, by height."""
    found = cloud.channels.colours(cloud.raw)
    if found is None:
        found = cloud.channels.float_colours(cloud.raw)
    if found is None:
        found = _by_channel(cloud, values)
    return _by_axis(cloud, values) if found is None else found


def _by_axis(cloud: Cloud, values: Mapping[str, Value]) -> NDArray[np.uint8]:
    along = cloud.positions[:, "XYZ".index(str(values["Axis"]))]
    given = None
    if not values["Autocompute Value Bounds"]:
        name = "Autocompute Value Bounds"
        given = float(values[f"{name}/Min Value"]), float(values[f"{name}/Max Value"])
    return mapped(_shares(along, given), str(values["Color Map"]))


def _by_channel(cloud: Cloud, values: Mapping[str, Value]) -> NDArray[np.uint8] | None:
    name = str(values["Channel Name"])
    numbers = cloud.numbers(name)
    if numbers is None and name == _CHANNEL:
        numbers = cloud.numbers(_OTHER_NAME)
    if numbers is None:
        return None
    given = None
    if not values["Autocompute Intensity Bounds"]:
        given = float(values["Min Intensity"]), float(values["Max Intensity"])
    shares = _shares(numbers, given)
    if values["Use rainbow"]:
        inverted = bool(values["Invert Rainbow"])
        return mapped(shares, str(values["Color Map"]), inverted=inverted)
    low, high = (
        np.array(rgb_of(values[one]), dtype=np.float32) for one in ("Min Color", "Max Color")
    )
    between = np.nan_to_num(np.clip(shares, 0, 1))[:, None]
    return np.rint(low + between * (high - low)).astype(np.uint8)


def _shares(
    numbers: NDArray[np.float32], given: tuple[float, float] | None
) -> NDArray[np.floating]:
    """Return each number's place between the bounds, 0 to 1; numbers all alike are at 0."""
    low, high = _bounds(numbers) if given is None else given
    if low == high:
        return np.zeros(len(numbers), dtype=np.float32)
    with np.errstate(all="ignore"):
        return (numbers - np.float32(low)) * np.float32(1.0 / (high - low))


def _bounds(numbers: NDArray[np.float32]) -> tuple[float, float]:
    """Return the least and the greatest number that is one."""
    if not len(numbers):
        return 0.0, 0.0
    with np.errstate(invalid="ignore"):
        low, high = float(numbers.min()), float(numbers.max())
    if np.isfinite(low) and np.isfinite(high):
        return low, high
    finite = numbers[np.isfinite(numbers)]
    return (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 0.0)


def _no_channel(cloud: Cloud, values: Mapping[str, Value]) -> Status:
    names = cloud.channels.names
    other = next((one for one in names if one not in "xyz"), None)
    mend = ("Channel Name", other) if other else ("Color Transformer", AXIS)
    name = str(values["Channel Name"])[:60]
    sentence = f'The messages have no field "{name}": they have {listed(names)}.'
    return Status("warn", "unknown_field", sentence, mend)


def _no_colours(cloud: Cloud, wanted: str) -> Status:
    fields = '"rgb" or "rgba"' if wanted == RGB8 else '"r", "g" and "b" of floats'
    sentence = f"The messages have no fields {fields}: they have {listed(cloud.channels.names)}."
    return Status("warn", "unknown_field", sentence, ("Color Transformer", AUTOMATIC))


@dataclass(slots=True, eq=False)
class _Kept:
    """A message that is seen, where it is drawn, and how it was drawn last."""

    path: str
    number: int
    received: Received
    cloud: Cloud
    colours: NDArray[np.uint8] | None = None
    placed: Placed | None = None
    remark: Status | None = None


class CloudDisplay(Display):
    """Keeps the newest cloud, and those before it until they decayed; derived classes read one."""

    PROPERTIES: ClassVar[tuple[Property, ...]] = CLOUD_PROPERTIES
    ITEM: ClassVar[ItemKind] = "point"
    """What one of its points is."""

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self._kept: deque[_Kept] = deque()
        self._number = 0
        self._left_out = 0
        self._precise = False
        self._drawing: Drawing | None = NOTHING

    @abstractmethod
    def read(self, received: Received, limits: Limits) -> Cloud:
        """Return the cloud of a message.

        Raises:
            StudioError: It cannot be read, or makes no sense.
        """

    def take(self, received: Received, role: str = "") -> None:
        """Take a message; it is seen until its decay time is over."""
        del role
        with reading_fields(received.type_name):
            cloud = self.read(received, self.limits)
        if not self._decay_ns():
            self._kept.clear()
        self._decay(received.received_ns)
        self._number += 1
        self._kept.append(_Kept(self._free_path(), self._number, received, cloud))
        self._hold_limits()
        self._drawing = None

    def changed(self, name: str) -> None:
        """Take new settings."""
        if name == "Decay Time" and not self._decay_ns():
            self._keep_newest()
        if name == POINTS_AT_MOST:
            self._read_anew(int(self.values[name]))
        if name in ("", _SIZE):
            self._precise = False
        for one in self._kept:
            one.placed = None
            if name not in _WITHOUT_COLOUR:
                one.colours = None
        self._drawing = None

    def reset(self) -> None:
        """Forget all clouds."""
        self._kept.clear()
        self._left_out = 0
        self._precise = False
        self._drawing = NOTHING

    def draw(self, now_ns: int) -> Drawing:
        """Return the clouds that have not decayed now."""
        if self._decay_ns():
            self._decay(now_ns)
        if self._drawing is None:
            self._drawing = {
                one.path: placed for one in self._kept if (placed := self._placed(one)) is not None
            }
        return self._drawing

    def picked(self, picked: Picked) -> Sequence[str]:
        """Return the keys of points: which message, and their index in it."""
        kept = next((one for one in self._kept if one.path == picked.path), None)
        if kept is None:
            return ()
        rows = np.unique(picked.rows[(picked.rows >= 0) & (picked.rows < kept.cloud.count)])
        raw = rows if kept.cloud.raw is None else kept.cloud.raw[rows]
        message = str(kept.number) if self._decay_ns() else NEWEST
        return [f"{message}/{index}" for index in raw.tolist()]

    def item(self, key: str) -> Item | None:
        """Return a point that is drawn; of a message without decay, that of the newest one."""
        kept, row, index = self._of_key(key)
        if kept is None:
            return None
        cloud = kept.cloud
        box = box_at(cloud.positions[row].tolist(), (float(self.values[_SIZE]),) * 3)
        return Item(
            self.ITEM,
            str(index),
            kept.path,
            cloud.frame,
            cloud.stamp_ns,
            box,
            shape=_SHAPE,
            row=row,
        )

    def facts(self, key: str) -> tuple[Fact, ...]:
        """Return the index of a point, where it is, and its fields."""
        kept, row, index = self._of_key(key)
        if kept is None:
            return ()
        place = position_fact(kept.cloud.positions[row].tolist())
        return (Fact("index", index), place, *self.channel_facts(kept.cloud, index)[:FACTS_MAX])

    def channel_facts(self, cloud: Cloud, index: int) -> tuple[Fact, ...]:
        """Return the fields of a point by its index in the message, but for its place."""
        raw = np.array([index])
        columns = ((name, cloud.channels.numbers(name, raw)) for name in cloud.channels.names)
        return tuple(
            number_fact(name, float(numbers[0]), kind="field")
            for name, numbers in columns
            if numbers is not None
        )

    def _of_key(self, key: str) -> tuple[_Kept | None, int, int]:
        """Return the message, the row and the index of a point; None: it is not drawn."""
        number, _, index = key.partition("/")
        for kept in reversed(self._kept):
            if number in (NEWEST, str(kept.number)):
                raw = kept.cloud.raw
                rows = range(kept.cloud.count)
                row = row_of(raw, index) if raw is not None else index_of(index)
                if row is None or row not in rows:
                    break
                return kept, row, int(index)
        return None, 0, 0

    def statuses(self) -> tuple[Status, ...]:
        """Return what is odd about the newest cloud, and what is left out."""
        if not self._kept:
            return ()
        newest = self._kept[-1]
        bodies = too_many_bodies(newest.cloud.count, self.values)
        found = [newest.cloud.nothing, newest.remark, self._transparent(), *self._thinned(), bodies]
        return tuple(one for one in found if one is not None)

    @property
    def newest_cloud(self) -> Cloud | None:
        """The points of the newest message."""
        return self._kept[-1].cloud if self._kept else None

    def read_again(self) -> None:
        """Read the kept messages again: what they are read with is another."""
        self._read_anew(self.limits.points)
        self.colour_again()

    def colour_again(self) -> None:
        """Draw the kept messages in other colours."""
        for one in self._kept:
            one.placed = one.colours = None
        self._drawing = None

    def shape_of(self, cloud: Cloud, colours: NDArray[np.uint8], *, precise: bool) -> Points:
        """Return the shape of a cloud in its colours."""
        return points_of(cloud, colours, self.values, precise=precise)

    def _placed(self, one: _Kept) -> Placed | None:
        if not one.cloud.count:
            return None
        if one.placed is None:
            if one.colours is None:
                one.colours, one.remark = colours_of(one.cloud, self.values)
            # Once needed it stays: a cloud near the limit would otherwise be sent again and again.
            self._precise |= needs_precision(one.cloud.positions, float(self.values[_SIZE]))
            shape = self.shape_of(one.cloud, one.colours, precise=self._precise)
            cloud = one.cloud
            one.placed = Placed(cloud.frame, cloud.stamp_ns, {_SHAPE: shape}, sweep=cloud.sweep)
        return one.placed

    def _decay_ns(self) -> int:
        return int(float(self.values["Decay Time"]) * 1e9)

    def _decay(self, now_ns: int) -> None:
        """Drop what came longer ago than the decay time."""
        decay_ns = self._decay_ns()
        while self._kept and now_ns - self._kept[0].received.received_ns > decay_ns:
            self._kept.popleft()
            self._drawing = None

    def _keep_newest(self) -> None:
        while len(self._kept) > 1:
            self._kept.popleft()
        self._left_out = 0

    def _hold_limits(self) -> None:
        """Drop the oldest of what is more than may be shown; the newest stays."""
        count = sum(one.cloud.count for one in self._kept)
        size_bytes = sum(one.cloud.channels.size_bytes for one in self._kept)
        self._left_out = 0
        while len(self._kept) > 1 and (
            count > self.limits.points
            or size_bytes > self.limits.kept_bytes
            or len(self._kept) > self.limits.messages
        ):
            dropped = self._kept.popleft().cloud
            count, size_bytes = count - dropped.count, size_bytes - dropped.channels.size_bytes
            self._left_out += 1

    def _read_anew(self, points: int) -> None:
        """Show another number of points, of kept messages too: a map may come only once."""
        self.limit(replace(self.limits, points=points))
        for one in self._kept:
            one.cloud, one.colours = self.read(one.received, self.limits), None
        self._hold_limits()

    def _free_path(self) -> str:
        """A path is used again, so that what is there is changed and not made again."""
        taken = {one.path for one in self._kept}
        return next(str(n) for n in range(len(taken) + 1) if str(n) not in taken)

    def _transparent(self) -> Status | None:
        if float(self.values["Alpha"]) > 0.0:
            return None
        return Status("warn", "transparent", "Alpha is 0: nothing is seen.", ("Alpha", 1.0))

    def _thinned(self) -> list[Status]:
        found: list[Status] = []
        cloud = self._kept[-1].cloud
        if cloud.count < cloud.available:
            sentence = f"Showing {cloud.count:,} of {cloud.available:,} points."
            mend = (POINTS_AT_MOST, min(cloud.available, POINTS_LIMIT))
            found.append(Status("ok", "thinned", sentence, mend))
        if self._left_out:
            sentence = (
                f"Showing the newest {len(self._kept):,} messages: with those before them there "
                f"would be more than {self.limits.points:,} points."
            )
            found.append(Status("ok", "thinned", sentence))
        return found
