"""The module sensor_msgs_py.point_cloud2: points of PointCloud2 as arrays of numpy, and back."""

from __future__ import annotations

import array
import sys
from collections import namedtuple
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np
from numpy.lib.recfunctions import structured_to_unstructured, unstructured_to_structured

from studio.ros.messages import message

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from studio.ros.types.classes import MessageValue

PointCloud2: Final = message("sensor_msgs/msg/PointCloud2")
PointField: Final = message("sensor_msgs/msg/PointField")
DUMMY_FIELD_PREFIX: Final = "unnamed_field"
_NUMBERS: Final = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
"""By `datatype`: INT8 1 to FLOAT64 8."""
_COLUMNS_MAX: Final = 10_000
"""Of one point: a message may say that a field has billions of numbers."""


def dtype_from_fields(
    fields: Iterable[MessageValue], point_step: int | None = None
) -> np.dtype[np.void]:
    """Return the structured type of one point, with a name for each number of each field.

    Args:
        fields: PointField messages; one of `count` 3 named `n` gives `n_0`, `n_1` and `n_2`.
        point_step: Bytes from one point to the next; the least that hold the fields without.

    Raises:
        ValueError: A datatype is none, a name is there twice, or the fields do not fit.
    """
    names: list[str] = []
    offsets: list[int] = []
    formats: list[str] = []
    for number, field in enumerate(fields):
        if field.datatype not in _NUMBERS:
            raise ValueError(f"field {field.name!r}: {field.datatype} is no datatype, give 1 to 8")
        name = field.name or f"{DUMMY_FIELD_PREFIX}_{number}"
        if len(names) + field.count > _COLUMNS_MAX:
            raise ValueError(f"field {name!r}: a point has at most {_COLUMNS_MAX} numbers here")
        code = _NUMBERS[field.datatype]
        size = np.dtype(code).itemsize
        for part in range(field.count):
            names.append(name if field.count == 1 else f"{name}_{part}")
            offsets.append(field.offset + part * size)
            formats.append(code)
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"two fields are called {twice!r}: give each a name of its own")
    layout: Any = {"names": names, "formats": formats, "offsets": offsets}
    if point_step is not None:
        layout["itemsize"] = point_step
    return np.dtype(layout)


def read_points(
    cloud: MessageValue,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,  # noqa: FBT001, FBT002 - rclpy's
    uvs: Iterable[int] | None = None,
    reshape_organized_cloud: bool = False,  # noqa: FBT001, FBT002
) -> NDArray[np.void]:
    """Read the points of a message; those of its own byte order are a view of its data.

    Args:
        cloud: A PointCloud2.
        field_names: The fields that are wanted, in this order; all without.
        skip_nans: Leave out points of which a wanted field is not a number.
        uvs: Indices of the points that are wanted; all without.
        reshape_organized_cloud: Return shape (width, height) where there are several rows.

    Returns:
        Shape (N,), one structured value for each point.

    Raises:
        TypeError: The data is shorter than the message says.
        ValueError: Its fields cannot be.
        AssertionError: A wanted field is not there.
    """
    points = _points(cloud)
    if field_names is not None:
        wanted = list(field_names)
        missing = [name for name in wanted if name not in (points.dtype.names or ())]
        if missing:
            raise AssertionError(
                f"the cloud has no field {missing[0]}: it has {points.dtype.names}"
            )
        points = points[wanted]
    if skip_nans and not cloud.is_dense:
        keep = np.ones(len(points), np.bool_)
        for name in points.dtype.names or ():
            keep &= ~np.isnan(points[name])
        points = points[keep]
    if uvs is not None:
        points = points[uvs if isinstance(uvs, np.ndarray) else np.fromiter(uvs, np.int64)]
    if reshape_organized_cloud and cloud.height > 1:
        points = points.reshape(cloud.width, cloud.height)
    return points


def read_points_numpy(
    cloud: MessageValue,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,  # noqa: FBT001, FBT002
    uvs: Iterable[int] | None = None,
    reshape_organized_cloud: bool = False,  # noqa: FBT001, FBT002
) -> NDArray[Any]:
    """Read points whose wanted fields are of one datatype, as `read_points` does.

    Returns:
        Shape (N, number of fields), of that datatype; an organized cloud (width, height, fields).

    Raises:
        AssertionError: The fields are of several datatypes, or one is not there.
    """
    points = read_points(cloud, field_names, skip_nans, uvs, reshape_organized_cloud)
    kinds = {points.dtype[name] for name in points.dtype.names or ()}
    if len(kinds) > 1:
        raise AssertionError(
            "the fields are of several datatypes: name those of one, or use read_points"
        )
    return structured_to_unstructured(points)


def read_points_list(
    cloud: MessageValue,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,  # noqa: FBT001, FBT002
    uvs: Iterable[int] | None = None,
) -> list[Any]:
    """Read points as a list of named tuples, as `read_points` does."""
    points = read_points(cloud, field_names, skip_nans, uvs)
    names = points.dtype.names or ()
    kind: Any = namedtuple("Point", names, rename=True)  # pyright: ignore[reportUntypedNamedTuple]
    return [kind(*point) for point in points.tolist()]


def create_cloud(
    header: MessageValue,
    fields: Sequence[MessageValue],
    points: Any,  # noqa: ANN401 - an array, or tuples
    step: int | None = None,
) -> MessageValue:
    """Make a PointCloud2.

    Args:
        header: A std_msgs/Header.
        fields: What each point has.
        points: A structured array, an array of shape (N, fields), or sequences of numbers;
            shape (width, height, fields) is an organized cloud.
        step: Bytes from one point to the next; the least without.

    Raises:
        ValueError: The points do not have these fields.
    """
    kind = dtype_from_fields(fields, step)
    made: NDArray[Any]
    if isinstance(points, np.ndarray):
        made = cast("NDArray[Any]", points)
        if made.dtype.names is None:
            made = unstructured_to_structured(made, kind)
        elif made.dtype != kind:
            raise ValueError(f"the points are {made.dtype}, and the fields say {kind}")
    else:
        made = np.array([tuple(point) for point in points], kind)
    if made.ndim > 2:
        raise ValueError("an organized cloud has two dimensions: give shape (width, height)")
    data = array.array("B")
    data.frombytes(np.ascontiguousarray(made).tobytes())
    width = made.shape[0]
    return PointCloud2(
        header=header,
        height=made.shape[1] if made.ndim == 2 else 1,
        width=width,
        is_dense=False,
        is_bigendian=sys.byteorder != "little",
        fields=list(fields),
        point_step=kind.itemsize,
        row_step=kind.itemsize * width,
        data=data,
    )


def create_cloud_xyz32(
    header: MessageValue,
    points: Any,  # noqa: ANN401
    step: int | None = None,
) -> MessageValue:
    """Make a PointCloud2 of x, y and z in m, float32, as `create_cloud` does."""
    fields = [
        PointField(name=name, offset=4 * number, datatype=7, count=1)
        for number, name in enumerate("xyz")
    ]
    return create_cloud(header, fields, points, step)


def _points(cloud: MessageValue) -> NDArray[np.void]:
    """Return all points in this machine's byte order, shape (width * height,)."""
    kind = dtype_from_fields(cloud.fields, cloud.point_step)
    row = cloud.width * cloud.point_step
    between = max(row, cloud.row_step) if cloud.height > 1 else row
    needed = between * (cloud.height - 1) + row if cloud.width and cloud.height else 0
    data = np.frombuffer(cloud.data, np.uint8)
    if len(data) < needed:
        raise TypeError(
            f"the data has {len(data):,} bytes, and {cloud.width} x {cloud.height} points of "
            f"{cloud.point_step} bytes need {needed:,}"
        )
    if not needed:
        return np.empty(0, kind)
    is_other = bool(cloud.is_bigendian) != (sys.byteorder != "little")
    stored = kind.newbyteorder() if is_other else kind
    points = np.ndarray(
        (cloud.height, cloud.width), stored, data, strides=(between, cloud.point_step)
    ).reshape(-1)
    return points.astype(kind) if is_other else points
