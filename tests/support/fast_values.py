"""Columns of transforms and markers, made of whole messages value by value."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from studio.ros.columns.markers import MarkerColumns, MarkerTexts, Texture
from studio.tf.transforms import TransformColumns

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray


def transform_columns(message: Any) -> TransformColumns:  # noqa: ANN401
    """The columns of a TFMessage."""
    all_of = message.transforms
    return TransformColumns(
        tuple(one.header.frame_id for one in all_of),
        tuple(one.child_frame_id for one in all_of),
        ns(one.header.stamp for one in all_of),
        rows((xyz(one.transform.translation) for one in all_of), 3),
        rows((wxyz(one.transform.rotation) for one in all_of), 4),
    )


def marker_columns(message: Any) -> MarkerColumns:  # noqa: ANN401
    """The columns of a MarkerArray."""
    all_of = message.markers
    points = [[xyz(point) for point in one.points] for one in all_of]
    colors = [[rgba(color) for color in one.colors] for one in all_of]
    uvs = [[(uv.u, uv.v) for uv in one.uv_coordinates] for one in all_of]
    return MarkerColumns(
        texts=tuple(map(marker_texts, all_of)),
        stamps_ns=ns(one.header.stamp for one in all_of),
        ids=np.array([one.id for one in all_of], dtype=np.int32),
        types=np.array([one.type for one in all_of], dtype=np.int32),
        actions=np.array([one.action for one in all_of], dtype=np.int32),
        positions=rows((xyz(one.pose.position) for one in all_of), 3),
        rotations_wxyz=rows((wxyz(one.pose.orientation) for one in all_of), 4),
        scales=rows((xyz(one.scale) for one in all_of), 3),
        colors_rgba=rows((rgba(one.color) for one in all_of), 4).astype(np.float32),
        lifetimes_ns=ns(one.lifetime for one in all_of),
        frame_locked=np.array([one.frame_locked for one in all_of], dtype=np.bool_),
        points=rows((row for each in points for row in each), 3),
        point_starts=starts(points),
        point_colors_rgba=rows((row for each in colors for row in each), 4).astype(np.float32),
        point_color_starts=starts(colors),
        uvs=rows((row for each in uvs for row in each), 2).astype(np.float32),
        uv_starts=starts(uvs),
    )


def marker_texts(one: Any) -> MarkerTexts:  # noqa: ANN401
    picture = one.texture
    stamp_ns = picture.header.stamp.sec * 10**9 + picture.header.stamp.nanosec
    texture = Texture(stamp_ns, picture.header.frame_id, picture.format, bytes(picture.data))
    return MarkerTexts(
        one.header.frame_id, one.ns, one.text, one.mesh_resource, one.mesh_file.filename,
        bytes(one.mesh_file.data), bool(one.mesh_use_embedded_materials), one.texture_resource,
        None if texture == Texture(0, "", "", b"") else texture,
    )  # fmt: skip


def xyz(of: Any) -> tuple[float, ...]:  # noqa: ANN401
    return of.x, of.y, of.z


def wxyz(of: Any) -> tuple[float, ...]:  # noqa: ANN401
    return of.w, of.x, of.y, of.z


def rgba(of: Any) -> tuple[float, ...]:  # noqa: ANN401
    return of.r, of.g, of.b, of.a


def ns(times: Iterable[Any]) -> NDArray[np.int64]:
    return np.array([time.sec * 10**9 + time.nanosec for time in times], dtype=np.int64)


def rows(values: Iterable[tuple[float, ...]], width: int) -> NDArray[np.float64]:
    return np.array(list(values), dtype=np.float64).reshape(-1, width)


def starts(lists: list[Any]) -> NDArray[np.intp]:
    return np.cumsum([0, *map(len, lists)], dtype=np.intp)


def assert_same(one: TransformColumns | MarkerColumns, other: object) -> None:
    """Every column is of the same kind and holds the same values, NaN too."""
    assert type(one) is type(other)
    for field in fields(one):
        mine: Any = getattr(one, field.name)
        theirs: Any = getattr(other, field.name)
        if isinstance(mine, tuple):
            assert mine == theirs, field.name
        else:
            assert mine.dtype == theirs.dtype, field.name
            np.testing.assert_array_equal(mine, theirs, err_msg=field.name)
