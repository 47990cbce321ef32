"""The layout of a visualization_msgs/MarkerArray: its texts, and where its numbers lie."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from itertools import accumulate
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from studio.ros.columns.layout import BytesReader, BytesWriter, Places, Skeleton, places_of
from studio.ros.duration import NANOSECONDS

if TYPE_CHECKING:
    from numpy.typing import NDArray


TYPE_NAME = "visualization_msgs/msg/MarkerArray"
SINGLE_TYPE_NAME = "visualization_msgs/msg/Marker"
POSE_AND_SCALE_BYTES = 80
# Colour, lifetime, and whether the frame is locked: a byte, and three that fill up.
COLOR_TO_LOCKED_BYTES = 28
POINT_BYTES, COLOR_BYTES, UV_BYTES = 24, 16, 8
_MARKER_BYTES_LEAST = 187
_STAMP_BYTES = 8
# On the wire a quaternion is x, y, z, w.
_WXYZ = [6, 3, 4, 5]
# An empty resource, an image of no time, frame, format and bytes, and no coordinates.
NO_TEXTURE = {order: struct.pack(f"{order}I4xiII4xI4xII", 1, 0, 0, 1, 1, 0, 0) for order in "<>"}
# No text, no resource of a mesh, and a file of no name and bytes.
NO_MESH = {order: struct.pack(f"{order}I4xI4xI4xI", 1, 1, 1, 0) for order in "<>"}


class Texture(NamedTuple):
    """The picture of a marker: `sensor_msgs/CompressedImage`."""

    stamp_ns: int
    frame: str
    format: str
    data: bytes


class MarkerTexts(NamedTuple):
    """Strings and bytes of a marker; `texture` is None where all of it is empty."""

    frame: str
    namespace: str
    text: str = ""
    mesh_resource: str = ""
    mesh_file_name: str = ""
    mesh_file_data: bytes = b""
    mesh_use_embedded_materials: bool = False
    texture_resource: str = ""
    texture: Texture | None = None


class Runs:
    """Items that markers hold in lists: where each list begins, in bytes, and how long it is."""

    __slots__ = ("begins", "counts")

    def __init__(self) -> None:
        self.begins: list[int] = []
        self.counts: list[int] = []

    def read(self, reader: BytesReader, each_bytes: int, number_bytes: int) -> None:
        """Pass over the next list."""
        count = reader.count(each_bytes)
        begin = reader.numbers(number_bytes, count * each_bytes) if count else reader.at
        self.begins.append(begin)
        self.counts.append(count)

    def add_none(self, at: int) -> None:
        """Note an empty list."""
        self.begins.append(at)
        self.counts.append(0)

    def starts(self) -> NDArray[np.intp]:
        """Return the index of each list's first item among all items, and at last their number."""
        return np.fromiter(accumulate(self.counts, initial=0), dtype=np.intp)

    def item_bytes(self, starts: NDArray[np.intp], each_bytes: int) -> Places:
        """Return the index of every item's first byte."""
        shifts = np.array(self.begins, dtype=np.intp) - each_bytes * starts[:-1]
        return np.repeat(shifts, self.counts) + each_bytes * np.arange(
            int(starts[-1]), dtype=np.intp
        )


class _Alike(NamedTuple):
    """What a marker without items and text is made of but numbers; places from its first byte on.

    The next ones most often are built alike, if they begin at the same alignment.
    """

    head: bytes
    """Its frame and namespace."""
    ids: int
    pose: int
    tail_at: int
    tail: bytes
    """Its empty lists, and all behind them."""
    texts: MarkerTexts


@dataclass(frozen=True, slots=True, eq=False)
class MarkerLayout:
    """Places of numbers, in units of their own size behind the header, and all that is no number.

    `points`, `point_colors` and `uvs` are the places of the items of all markers.
    """

    texts: tuple[MarkerTexts, ...]
    stamps: Places
    ids: Places
    positions: Places
    rotations: Places
    scales: Places
    colors: Places
    lifetimes: Places
    locked: Places
    points: Places
    point_starts: NDArray[np.intp]
    point_colors: Places
    point_color_starts: NDArray[np.intp]
    uvs: Places
    uv_starts: NDArray[np.intp]
    skeleton: Skeleton


class MarkerWalk:
    """One pass over a message, marker by marker."""

    def __init__(self, raw: bytes, type_name: str = TYPE_NAME) -> None:
        self._reader = BytesReader(raw, type_name)
        self._no_texture = NO_TEXTURE[self._reader.order]
        self._no_mesh = NO_MESH[self._reader.order]
        self._texts: list[MarkerTexts] = []
        self._stamps: list[int] = []
        self._ids: list[int] = []
        self._poses: list[int] = []
        self._points, self._colors, self._uvs = Runs(), Runs(), Runs()
        self._alike: dict[int, _Alike] = {}
        """By alignment, the last marker without items and text."""

    def run(self) -> MarkerLayout:
        """Walk from the first byte to the last.

        Raises:
            CdrError: The bytes are no such message.
        """
        for _ in range(self._reader.count(_MARKER_BYTES_LEAST)):
            self._marker()
        return self._layout()

    def run_single(self) -> MarkerLayout:
        """Walk through a message that is a single marker.

        Raises:
            CdrError: The bytes are no such message.
        """
        self._marker()
        return self._layout()

    def _marker(self) -> None:
        if not self._passed_alike():
            self._read_marker()

    def _passed_alike(self) -> bool:
        """Pass over a marker that is built as one before, which takes half the time."""
        reader = self._reader
        begin = reader.at + -reader.at % 4
        one = self._alike.get(begin % 8)
        if (
            one is None
            or not reader.raw.startswith(one.head, begin + _STAMP_BYTES)
            or not reader.raw.startswith(one.tail, begin + one.tail_at)
        ):
            return False
        self._stamps.append(begin)
        self._ids.append(begin + one.ids)
        self._poses.append(begin + one.pose)
        self._texts.append(one.texts)
        reader.at = begin + one.tail_at + len(one.tail)
        for runs in (self._points, self._colors, self._uvs):
            runs.add_none(reader.at)
        return True

    def _read_marker(self) -> None:
        reader = self._reader
        begin = reader.numbers(4, _STAMP_BYTES)
        self._stamps.append(begin)
        frame, namespace = reader.text(), reader.text()
        head_end = reader.at
        self._ids.append(reader.numbers(4, 12))
        self._poses.append(reader.numbers(8, POSE_AND_SCALE_BYTES))
        reader.numbers(4, COLOR_TO_LOCKED_BYTES)
        tail_at = reader.at
        self._points.read(reader, POINT_BYTES, 8)
        self._colors.read(reader, COLOR_BYTES, 4)
        texture = self._texture()
        self._texts.append(MarkerTexts(frame, namespace, *self._mesh(), *texture))
        lists = (self._points, self._colors, self._uvs)
        # Texts differ from marker to marker.
        if not (self._texts[-1].text or any(runs.counts[-1] for runs in lists)):
            self._alike[begin % 8] = _Alike(
                reader.raw[begin + _STAMP_BYTES : head_end],
                self._ids[-1] - begin,
                self._poses[-1] - begin,
                tail_at - begin,
                reader.raw[tail_at : reader.at],
                self._texts[-1],
            )

    def _texture(self) -> tuple[str, Texture | None]:
        """Read the picture of a marker, which hardly one has, and what places it."""
        reader = self._reader
        if reader.raw.startswith(self._no_texture, reader.at):
            reader.at += len(self._no_texture)
            self._uvs.add_none(reader.at)
            return "", None
        resource = reader.text()
        texture = Texture(reader.time_ns(), reader.text(), reader.text(), self._bytes())
        self._uvs.read(reader, UV_BYTES, 4)
        return resource, None if texture == (0, "", "", b"") else texture

    def _mesh(self) -> tuple[str, str, str, bytes, bool]:
        reader = self._reader
        if reader.raw.startswith(self._no_mesh, reader.at + -reader.at % 4):
            reader.numbers(4, len(self._no_mesh))
            return "", "", "", b"", self._truth()
        return reader.text(), reader.text(), reader.text(), self._bytes(), self._truth()

    def _bytes(self) -> bytes:
        count = self._reader.count(1)
        begin = self._reader.numbers(1, count)
        return self._reader.raw[begin : begin + count]

    def _truth(self) -> bool:
        return self._reader.raw[self._reader.numbers(1, 1)] != 0

    def _layout(self) -> MarkerLayout:
        places = np.array(self._poses, dtype=np.intp)
        after = places + POSE_AND_SCALE_BYTES
        stamps, ids = places_of(self._stamps, 2, 4), places_of(self._ids, 3, 4)
        point_starts, color_starts, uv_starts = (
            runs.starts() for runs in (self._points, self._colors, self._uvs)
        )
        points = self._points.item_bytes(point_starts, POINT_BYTES)
        colors = places_of(self._colors.item_bytes(color_starts, COLOR_BYTES), 4, 4)
        uvs = places_of(self._uvs.item_bytes(uv_starts, UV_BYTES), 2, 4)
        numbers = (
            stamps, ids, places_of(places, 20, 4), places_of(after, 7, 4),
            places_of(points, 6, 4), colors, uvs,
        )  # fmt: skip
        return MarkerLayout(
            texts=tuple(self._texts),
            stamps=stamps,
            ids=ids,
            positions=places_of(places, 3, 8),
            rotations=places_of(places, _WXYZ, 8),
            scales=places_of(places, [7, 8, 9], 8),
            colors=places_of(after, 4, 4),
            lifetimes=places_of(after, [4, 5], 4),
            # A single byte, of which there are as many as bytes behind the header.
            locked=places_of(after, [24], 1)[:, 0],
            points=places_of(points, 3, 8),
            point_starts=point_starts,
            point_colors=colors,
            point_color_starts=color_starts,
            uvs=uvs,
            uv_starts=uv_starts,
            skeleton=Skeleton(self._reader.raw, numbers),
        )


def marker_template(
    all_texts: tuple[MarkerTexts, ...], starts: tuple[NDArray[np.intp], ...]
) -> bytes:
    """Write a message with all its texts and counts, every number still zero.

    Args:
        all_texts: Of each marker.
        starts: Where the points, colours and texture coordinates of each marker begin, and end.

    Raises:
        MessageValueError: A text is none, or the time of a texture does not fit.
    """
    writer = BytesWriter(TYPE_NAME)
    writer.word(len(all_texts))
    counts = zip(*((each[1:] - each[:-1]).tolist() for each in starts), strict=True)
    for texts, (points, colors, uvs) in zip(all_texts, counts, strict=True):
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
    texture = texts.texture or Texture(0, "", "", b"")
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
