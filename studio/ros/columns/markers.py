"""visualization_msgs/MarkerArray as columns: one array for each field of all markers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from studio.errors import MessageValueError
from studio.ros.columns.layout import (
    LITTLE,
    KnownLayouts,
    nanoseconds_at,
    numbers_of,
    put_nanoseconds,
    view,
)
from studio.ros.columns.marker_layout import (
    SINGLE_TYPE_NAME,
    TYPE_NAME,
    MarkerLayout,
    MarkerTexts,
    MarkerWalk,
    Texture,
    marker_template,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["MarkerCodec", "MarkerColumns", "MarkerTexts", "Texture"]

_TEMPLATES_MAX = 8
_BYTE = np.dtype(np.uint8)


@dataclass(frozen=True, slots=True, eq=False)
class MarkerColumns:
    """The M markers of one message.

    Items of all markers lie one after another: those of marker i are
    `points[point_starts[i] : point_starts[i + 1]]`, and so the colours and texture coordinates.

    Attributes:
        texts: Of each marker; the very same object as before when only numbers changed.
        stamps_ns: Shape (M,), int64, since the epoch.
        ids: Shape (M,), int32.
        types: Shape (M,), int32: `Marker.ARROW` and so on.
        actions: Shape (M,), int32: `Marker.ADD` and so on.
        positions: Shape (M, 3), float64, metres in the marker's frame.
        rotations_wxyz: Shape (M, 4), float64, as they were sent, of whatever length.
        scales: Shape (M, 3), float64, metres.
        colors_rgba: Shape (M, 4), float32, as they were sent, from 0 to 1.
        lifetimes_ns: Shape (M,), int64; 0 is for ever.
        frame_locked: Shape (M,), bool.
        points: Shape (P, 3), float64, metres in the marker.
        point_starts: Shape (M + 1,).
        point_colors_rgba: Shape (C, 4), float32.
        point_color_starts: Shape (M + 1,).
        uvs: Shape (U, 2), float32.
        uv_starts: Shape (M + 1,).
    """

    texts: tuple[MarkerTexts, ...]
    stamps_ns: NDArray[np.int64]
    ids: NDArray[np.int32]
    types: NDArray[np.int32]
    actions: NDArray[np.int32]
    positions: NDArray[np.float64]
    rotations_wxyz: NDArray[np.float64]
    scales: NDArray[np.float64]
    colors_rgba: NDArray[np.float32]
    lifetimes_ns: NDArray[np.int64]
    frame_locked: NDArray[np.bool_]
    points: NDArray[np.float64]
    point_starts: NDArray[np.intp]
    point_colors_rgba: NDArray[np.float32]
    point_color_starts: NDArray[np.intp]
    uvs: NDArray[np.float32]
    uv_starts: NDArray[np.intp]


class MarkerCodec:
    """Reads and writes markers; one for each stream of them, used by one thread at a time."""

    def __init__(self) -> None:
        self._known: KnownLayouts[MarkerLayout] = KnownLayouts()
        self._known_single: KnownLayouts[MarkerLayout] = KnownLayouts()
        self._templates: list[tuple[bytes, MarkerLayout]] = []

    @property
    def layouts_kept(self) -> int:
        """The number of layouts cached."""
        return len(self._known) + len(self._known_single)

    def decode(self, data: bytes | bytearray | memoryview) -> MarkerColumns:
        """Read a message.

        Raises:
            CdrError: The bytes are no such message.
        """
        raw = bytes(data)
        layout = self._known.find(raw)
        if layout is None:
            layout = MarkerWalk(raw).run()
            self._known.keep(raw, layout)
        return _columns(raw, layout)

    def decode_single(self, data: bytes | bytearray | memoryview) -> MarkerColumns:
        """Read a visualization_msgs/Marker: columns of one marker.

        Raises:
            CdrError: The bytes are no such message.
        """
        raw = bytes(data)
        layout = self._known_single.find(raw)
        if layout is None:
            layout = MarkerWalk(raw, SINGLE_TYPE_NAME).run_single()
            self._known_single.keep(raw, layout)
        return _columns(raw, layout)

    def encode(self, columns: MarkerColumns) -> bytearray:
        """Write a message with its header of four bytes.

        Raises:
            MessageValueError: Columns differ in length, or a time or text does not fit.
        """
        _check_shapes(columns)
        template, layout = self._template(columns)
        written = bytearray(template)
        _put(written, layout, columns)
        return written

    def _template(self, columns: MarkerColumns) -> tuple[bytes, MarkerLayout]:
        for found in self._templates:
            if _is_built_alike(found[1], columns):
                return found
        starts = (columns.point_starts, columns.point_color_starts, columns.uv_starts)
        template = marker_template(columns.texts, starts)
        made = template, MarkerWalk(template).run()
        self._templates = [made, *self._templates[: _TEMPLATES_MAX - 1]]
        return made


def _columns(raw: bytes, layout: MarkerLayout) -> MarkerColumns:
    kinds = numbers_of(raw)
    doubles, floats = view(raw, kinds.f8), view(raw, kinds.f4)
    ids = view(raw, kinds.i4).take(layout.ids).astype(np.int32, copy=False)
    return MarkerColumns(
        texts=layout.texts,
        stamps_ns=nanoseconds_at(raw, layout.stamps, kinds),
        ids=ids[:, 0],
        types=ids[:, 1],
        actions=ids[:, 2],
        positions=doubles.take(layout.positions).astype(np.float64, copy=False),
        rotations_wxyz=doubles.take(layout.rotations).astype(np.float64, copy=False),
        scales=doubles.take(layout.scales).astype(np.float64, copy=False),
        colors_rgba=floats.take(layout.colors).astype(np.float32, copy=False),
        lifetimes_ns=nanoseconds_at(raw, layout.lifetimes, kinds),
        frame_locked=view(raw, _BYTE).take(layout.locked) != 0,
        points=doubles.take(layout.points).astype(np.float64, copy=False),
        point_starts=layout.point_starts,
        point_colors_rgba=floats.take(layout.point_colors).astype(np.float32, copy=False),
        point_color_starts=layout.point_color_starts,
        uvs=floats.take(layout.uvs).astype(np.float32, copy=False),
        uv_starts=layout.uv_starts,
    )


def _put(written: bytearray, layout: MarkerLayout, columns: MarkerColumns) -> None:
    doubles, floats = view(written, LITTLE.f8), view(written, LITTLE.f4)
    whole = view(written, LITTLE.i4)
    for place, column in enumerate((columns.ids, columns.types, columns.actions)):
        whole[layout.ids[:, place]] = column
    doubles[layout.positions] = columns.positions
    doubles[layout.rotations] = columns.rotations_wxyz
    doubles[layout.scales] = columns.scales
    doubles[layout.points] = columns.points
    floats[layout.colors] = columns.colors_rgba
    floats[layout.point_colors] = columns.point_colors_rgba
    floats[layout.uvs] = columns.uvs
    view(written, _BYTE)[layout.locked] = columns.frame_locked
    put_nanoseconds(written, layout.stamps, columns.stamps_ns, TYPE_NAME)
    put_nanoseconds(written, layout.lifetimes, columns.lifetimes_ns, TYPE_NAME)


def _is_built_alike(layout: MarkerLayout, columns: MarkerColumns) -> bool:
    # Texts that were read are the same object: comparing them costs nothing.
    return layout.texts == columns.texts and all(
        np.array_equal(one, other)
        for one, other in (
            (layout.point_starts, columns.point_starts),
            (layout.point_color_starts, columns.point_color_starts),
            (layout.uv_starts, columns.uv_starts),
        )
    )


def _check_shapes(columns: MarkerColumns) -> None:
    count = len(columns.texts)
    one_each = (
        columns.stamps_ns, columns.ids, columns.types, columns.actions, columns.lifetimes_ns,
        columns.frame_locked,
    )  # fmt: skip
    fits = (
        all(column.shape == (count,) for column in one_each)
        and columns.positions.shape == columns.scales.shape == (count, 3)
        and columns.rotations_wxyz.shape == columns.colors_rgba.shape == (count, 4)
        and _is_parted(columns.points, columns.point_starts, count, 3)
        and _is_parted(columns.point_colors_rgba, columns.point_color_starts, count, 4)
        and _is_parted(columns.uvs, columns.uv_starts, count, 2)
    )
    if not fits:
        raise MessageValueError(TYPE_NAME, f"a column does not belong to {count} markers")


def _is_parted(
    items: NDArray[np.generic], starts: NDArray[np.intp], count: int, width: int
) -> bool:
    return (
        starts.shape == (count + 1,)
        and items.shape == (int(starts[-1]), width)
        and int(starts[0]) == 0
        and bool((starts[1:] >= starts[:-1]).all())
    )
