"""Messages of many poses or points as columns: PoseArray, Path, PolygonStamped and GridCells."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from studio.ros.columns.layout import BytesReader

if TYPE_CHECKING:
    from numpy.typing import NDArray

POSE_ARRAY = "geometry_msgs/msg/PoseArray"
PATH = "nav_msgs/msg/Path"
POLYGON = "geometry_msgs/msg/PolygonStamped"
GRID_CELLS = "nav_msgs/msg/GridCells"
_STAMP_BYTES, _LENGTH_BYTES = 8, 4
_POSE_NUMBERS, _POSE_BYTES = 7, 56
_POSE_STAMPED_BYTES_LEAST = 69


class StampedRows(NamedTuple):
    """The header of a message and the numbers of all its parts.

    Attributes:
        frame: `header.frame_id`.
        stamp_ns: Since the epoch.
        rows: Shape (N, 7): x, y, z of a position and x, y, z, w of a quaternion; or (N, 3) of
            points. float64.
    """

    frame: str
    stamp_ns: int
    rows: NDArray[np.float64]


class CellRows(NamedTuple):
    """The cells of a grid: middles as `StampedRows`, and what each measures along x and y, m."""

    cells: StampedRows
    width_m: float
    height_m: float


def read_pose_array(data: bytes | bytearray | memoryview) -> StampedRows:
    """Read a geometry_msgs/PoseArray.

    Raises:
        CdrError: The bytes are none.
    """
    reader = BytesReader(bytes(data), POSE_ARRAY)
    stamp_ns, frame = reader.time_ns(), reader.text()
    return StampedRows(frame, stamp_ns, _rows(reader, _POSE_NUMBERS, 8))


def read_polygon(data: bytes | bytearray | memoryview) -> StampedRows:
    """Read a geometry_msgs/PolygonStamped.

    Raises:
        CdrError: The bytes are none.
    """
    reader = BytesReader(bytes(data), POLYGON)
    stamp_ns, frame = reader.time_ns(), reader.text()
    return StampedRows(frame, stamp_ns, _rows(reader, 3, 4))


def read_grid_cells(data: bytes | bytearray | memoryview) -> CellRows:
    """Read a nav_msgs/GridCells.

    Raises:
        CdrError: The bytes are none.
    """
    reader = BytesReader(bytes(data), GRID_CELLS)
    stamp_ns, frame = reader.time_ns(), reader.text()
    at = reader.numbers(4, 8)
    width_m, height_m = np.frombuffer(reader.raw, f"{reader.order}f4", 2, at).tolist()
    return CellRows(StampedRows(frame, stamp_ns, _rows(reader, 3, 8)), width_m, height_m)


def read_path(data: bytes | bytearray | memoryview) -> StampedRows:
    """Read a nav_msgs/Path; the headers of its poses are passed over, as RViz does.

    Raises:
        CdrError: The bytes are none.
    """
    reader = BytesReader(bytes(data), PATH)
    stamp_ns, frame = reader.time_ns(), reader.text()
    count = reader.count(_POSE_STAMPED_BYTES_LEAST)
    places = [_pose_place(reader) for _ in range(min(count, 1))]
    alike = _poses_alike(reader, count - 1) if count > 1 else None
    if count > 1 and alike is None:
        places += [_pose_place(reader) for _ in range(count - 1)]
    first = [np.frombuffer(reader.raw, f"{reader.order}f8", _POSE_NUMBERS, at) for at in places]
    rows = np.array(first, dtype=np.float64).reshape(-1, _POSE_NUMBERS)
    return StampedRows(frame, stamp_ns, rows if alike is None else np.concatenate((rows, alike)))


def _poses_alike(reader: BytesReader, count: int) -> NDArray[np.float64] | None:
    """Read poses whose headers name the same frame, all at once; None when they do not.

    Behind the first pose all begin at the same alignment, so that equal names make equal lengths.
    """
    begin = reader.at
    _pose_place(reader)
    step = reader.at - begin
    reader.at = begin
    if begin + step * count > reader.size:
        return None
    poses = np.frombuffer(reader.raw, np.uint8, step * count, begin).reshape(count, step)
    name_end = _name_end(reader, begin)
    names = poses[:, _STAMP_BYTES:name_end]
    if not (names == names[0]).all():
        return None
    numbers = np.ascontiguousarray(poses[:, step - _POSE_BYTES :]).view(f"{reader.order}f8")
    return numbers.astype(np.float64, copy=False)


def _name_end(reader: BytesReader, begin: int) -> int:
    """Return the end of the frame's name in a PoseStamped, from the begin of its pose."""
    at = begin + _STAMP_BYTES
    length = np.frombuffer(reader.raw, f"{reader.order}u4", 1, at)
    return _STAMP_BYTES + _LENGTH_BYTES + int(length[0])


def _pose_place(reader: BytesReader) -> int:
    """Pass over a PoseStamped; return where its numbers begin."""
    reader.numbers(4, _STAMP_BYTES)
    reader.text()
    return reader.numbers(8, _POSE_BYTES)


def _rows(reader: BytesReader, width: int, each_bytes: int) -> NDArray[np.float64]:
    """Read a list of rows of numbers, each of 4 or 8 bytes."""
    count = reader.count(width * each_bytes)
    if not count:
        return np.empty((0, width))
    at = reader.numbers(each_bytes, count * width * each_bytes)
    kind = f"{reader.order}f{each_bytes}"
    numbers = np.frombuffer(reader.raw, kind, count * width, at).reshape(count, width)
    return numbers.astype(np.float64, copy=False)
