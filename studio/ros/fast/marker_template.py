"""marker_template: a MarkerArray with all its texts and counts, every number still zero."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.ros.duration import NANOSECONDS
from studio.ros.fast.bytes_writer import BytesWriter
from studio.ros.fast.marker_columns import MarkerTexts, Texture
from studio.ros.fast.marker_layout import (
    COLOR_BYTES,
    COLOR_TO_LOCKED_BYTES,
    NO_MESH,
    NO_TEXTURE,
    POINT_BYTES,
    POSE_AND_SCALE_BYTES,
    TYPE_NAME,
    UV_BYTES,
)

if TYPE_CHECKING:
    from studio.ros.fast.marker_columns import MarkerColumns

_EMPTY = Texture(0, "", "", b"")


def marker_template(columns: MarkerColumns) -> bytes:
    """Write all but the numbers.

    Raises:
        MessageValueError: A text is none, or the time of a texture does not fit.
    """
    writer = BytesWriter(TYPE_NAME)
    writer.word(len(columns.texts))
    starts = (columns.point_starts, columns.point_color_starts, columns.uv_starts)
    counts = zip(*((each[1:] - each[:-1]).tolist() for each in starts), strict=True)
    for texts, (points, colors, uvs) in zip(columns.texts, counts, strict=True):
        _put_head(writer, texts)
        _put_list(writer, points, POINT_BYTES, 8)
        _put_list(writer, colors, COLOR_BYTES, 4)
        if uvs or texts.texture_resource or texts.texture:
            _put_texture(writer, texts)
            _put_list(writer, uvs, UV_BYTES, 4)
        else:
            writer.ready(NO_TEXTURE["<"])
        _put_mesh(writer, texts)
    return bytes(writer.written)


def _put_head(writer: BytesWriter, texts: MarkerTexts) -> None:
    writer.numbers(4, 8)
    writer.text(texts.frame)
    writer.text(texts.namespace)
    writer.numbers(4, 12)
    writer.numbers(8, POSE_AND_SCALE_BYTES)
    writer.numbers(4, COLOR_TO_LOCKED_BYTES)


def _put_texture(writer: BytesWriter, texts: MarkerTexts) -> None:
    texture = texts.texture or _EMPTY
    writer.text(texts.texture_resource)
    writer.time(*divmod(texture.stamp_ns, NANOSECONDS))
    writer.text(texture.frame)
    writer.text(texture.format)
    _put_bytes(writer, texture.data)


def _put_mesh(writer: BytesWriter, texts: MarkerTexts) -> None:
    if texts.text or texts.mesh_resource or texts.mesh_file_name or texts.mesh_file_data:
        writer.text(texts.text)
        writer.text(texts.mesh_resource)
        writer.text(texts.mesh_file_name)
        _put_bytes(writer, texts.mesh_file_data)
    else:
        writer.ready(NO_MESH["<"])
    writer.written.append(texts.mesh_use_embedded_materials)


def _put_bytes(writer: BytesWriter, data: bytes) -> None:
    writer.word(len(data))
    writer.written += data


def _put_list(writer: BytesWriter, count: int, each_bytes: int, number_bytes: int) -> None:
    writer.word(count)
    if count:
        writer.numbers(number_bytes, count * each_bytes)
