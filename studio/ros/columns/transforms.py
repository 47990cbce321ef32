"""tf2_msgs/TFMessage as columns: names, times, positions and rotations of all its transforms."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from studio.errors import MessageValueError
from studio.ros.columns.layout import (
    LITTLE,
    BytesReader,
    BytesWriter,
    KnownLayouts,
    Places,
    Skeleton,
    nanoseconds_at,
    numbers_of,
    places_of,
    put_nanoseconds,
    view,
)
from studio.tf.transforms import TransformColumns

TYPE_NAME = "tf2_msgs/msg/TFMessage"
_TRANSFORM_BYTES_LEAST = 74
_TEMPLATES_MAX = 16
# Of the seven numbers of a transform; on the wire a quaternion is x, y, z, w.
_WXYZ = [6, 3, 4, 5]


@dataclass(frozen=True, slots=True, eq=False)
class _Layout:
    parents: tuple[str, ...]
    children: tuple[str, ...]
    stamps: Places
    translations: Places
    rotations: Places
    skeleton: Skeleton


class TransformCodec:
    """Reads and writes transforms; one for each stream of them, used by one thread at a time."""

    def __init__(self) -> None:
        self._known: KnownLayouts[_Layout] = KnownLayouts()
        self._templates: dict[tuple[tuple[str, ...], tuple[str, ...]], tuple[bytes, _Layout]] = {}

    @property
    def layouts_kept(self) -> int:
        """The number of layouts cached."""
        return len(self._known)

    def decode(self, data: bytes | bytearray | memoryview) -> TransformColumns:
        """Read a message.

        Raises:
            CdrError: The bytes are no such message.
        """
        raw = bytes(data)
        layout = self._known.find(raw)
        if layout is None:
            layout = _layout(raw)
            self._known.keep(raw, layout)
        kinds = numbers_of(raw)
        numbers = view(raw, kinds.f8)
        return TransformColumns(
            layout.parents,
            layout.children,
            nanoseconds_at(raw, layout.stamps, kinds),
            numbers.take(layout.translations).astype(np.float64, copy=False),
            numbers.take(layout.rotations).astype(np.float64, copy=False),
        )

    def encode(self, columns: TransformColumns) -> bytearray:
        """Write a message with its header of four bytes.

        Raises:
            MessageValueError: Columns differ in length, or a time does not fit.
        """
        names = (columns.parents, columns.children)
        _check_shapes(columns)
        found = self._templates.get(names)
        if found is None:
            template = _template(*names)
            found = template, _layout(template)
            if len(self._templates) >= _TEMPLATES_MAX:
                self._templates.pop(next(iter(self._templates)))
            self._templates[names] = found
        written, layout = bytearray(found[0]), found[1]
        numbers = view(written, LITTLE.f8)
        numbers[layout.translations] = columns.translations
        numbers[layout.rotations] = columns.rotations_wxyz
        put_nanoseconds(written, layout.stamps, columns.stamps_ns, TYPE_NAME)
        return written


def _layout(raw: bytes) -> _Layout:
    """Walk through a message.

    Raises:
        CdrError: It is none.
    """
    reader = BytesReader(raw, TYPE_NAME)
    parents: list[str] = []
    children: list[str] = []
    stamps: list[int] = []
    numbers: list[int] = []
    for _ in range(reader.count(_TRANSFORM_BYTES_LEAST)):
        stamps.append(reader.numbers(4, 8))
        parents.append(reader.text())
        children.append(reader.text())
        numbers.append(reader.numbers(8, 56))
    stamp_places = places_of(stamps, 2, 4)
    return _Layout(
        tuple(parents),
        tuple(children),
        stamp_places,
        places_of(numbers, 3, 8),
        places_of(numbers, _WXYZ, 8),
        Skeleton(raw, (stamp_places, places_of(numbers, 14, 4))),
    )


def _template(parents: tuple[str, ...], children: tuple[str, ...]) -> bytes:
    writer = BytesWriter(TYPE_NAME)
    writer.word(len(parents))
    for parent, child in zip(parents, children, strict=True):
        writer.numbers(4, 8)
        writer.text(parent)
        writer.text(child)
        writer.numbers(8, 56)
    return bytes(writer.written)


def _check_shapes(columns: TransformColumns) -> None:
    count = len(columns.parents)
    shapes = (
        (len(columns.children),),
        columns.stamps_ns.shape,
        columns.translations.shape,
        columns.rotations_wxyz.shape,
    )
    if shapes != ((count,), (count,), (count, 3), (count, 4)):
        raise MessageValueError(TYPE_NAME, f"{count} transforms do not have columns {shapes}")
