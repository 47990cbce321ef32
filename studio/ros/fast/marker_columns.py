"""Columns of markers: what the markers of one message say, in the order of the message."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Texture(NamedTuple):
    """The picture of a marker: `sensor_msgs/CompressedImage`."""

    stamp_ns: int
    frame: str
    format: str
    data: bytes


class MarkerTexts(NamedTuple):
    """What a marker says in texts and bytes; `texture` is None where all of it is empty."""

    frame: str
    namespace: str
    text: str = ""
    mesh_resource: str = ""
    mesh_file_name: str = ""
    mesh_file_data: bytes = b""
    mesh_use_embedded_materials: bool = False
    texture_resource: str = ""
    texture: Texture | None = None


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
