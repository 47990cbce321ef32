"""Point clouds of any layout, and a slow reader of them that shares nothing with the displays."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from hypothesis import strategies as st

from tests.support.display_messages import received

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.displays.display import Received

CLOUD = "sensor_msgs/msg/PointCloud2"
LETTERS = {1: "b", 2: "B", 3: "h", 4: "H", 5: "i", 6: "I", 7: "f", 8: "d"}
_WHOLE = {1: (-128, 127), 2: (0, 255), 3: (-32768, 32767), 4: (0, 65535)}


@dataclass(frozen=True)
class Layout:
    """Where the numbers of a point lie, and where the points."""

    fields: tuple[tuple[str, int, int], ...]
    """Name, offset and datatype of each."""
    point_step: int
    row_padding: int = 0
    big: bool = False

    def fields_of_message(self) -> list[dict[str, Any]]:
        return [
            {"name": name, "offset": offset, "datatype": datatype, "count": 1}
            for name, offset, datatype in self.fields
        ]


FLOATS = Layout((("x", 0, 7), ("y", 4, 7), ("z", 8, 7)), 12)
INTENSITY = Layout((*FLOATS.fields, ("intensity", 12, 7)), 16)
RGB = Layout((*FLOATS.fields, ("rgb", 12, 7)), 16)


def packed(layout: Layout, rows: Sequence[Sequence[Sequence[float]]]) -> bytes:
    """Points, row by row, as their bytes; every byte between the numbers is 0xAA."""
    order = ">" if layout.big else "<"
    written = bytearray()
    for row in rows:
        for point in row:
            begin = len(written)
            written += b"\xaa" * layout.point_step
            for value, (_, offset, datatype) in zip(point, layout.fields, strict=True):
                struct.pack_into(order + LETTERS[datatype], written, begin + offset, value)
        written += b"\xaa" * layout.row_padding
    return bytes(written)


def cloud(
    layout: Layout,
    rows: Sequence[Sequence[Sequence[float]]],
    *,
    little: bool = True,
    **fields: Any,  # noqa: ANN401
) -> Received:
    """The message of points; other fields of it may be given, wrong ones too."""
    columns = len(rows[0]) if rows else 0
    whole = {
        "height": len(rows),
        "width": columns,
        "fields": layout.fields_of_message(),
        "is_bigendian": layout.big,
        "point_step": layout.point_step,
        "row_step": columns * layout.point_step + layout.row_padding,
        "data": packed(layout, rows),
    }
    return received(CLOUD, whole | fields, little=little)


@st.composite
def layouts(draw: st.DrawFn) -> Layout:
    """Fields x, y, z and one more in any order, of any type, with gaps between them."""
    names = draw(st.permutations(["x", "y", "z", "extra"]))
    offset, fields = 0, list[tuple[str, int, int]]()
    for name in names:
        datatype = draw(st.sampled_from(sorted(LETTERS)))
        offset += draw(st.sampled_from([0, 0, 1, 3, 4]))
        fields.append((name, offset, datatype))
        offset += struct.calcsize(LETTERS[datatype])
    point_step = offset + draw(st.integers(0, 5))
    return Layout(tuple(fields), point_step, draw(st.integers(0, 7)), draw(st.booleans()))


def numbers(datatype: int) -> st.SearchStrategy[float]:
    """Numbers of a datatype; floats also NaN and infinite."""
    if datatype in _WHOLE:
        return st.integers(*_WHOLE[datatype])
    if datatype in (5, 6):
        return st.integers(0 if datatype == 6 else -(2**31), 2**31 - 1)
    return st.floats(width=32)


@st.composite
def laid_clouds(draw: st.DrawFn) -> tuple[Layout, list[list[tuple[float, ...]]]]:
    """A layout and its points, up to three rows of four."""
    layout = draw(layouts())
    point = st.tuples(*[numbers(datatype) for _, _, datatype in layout.fields])
    columns = draw(st.integers(1, 4))
    row = st.lists(point, min_size=columns, max_size=columns)
    return layout, draw(st.lists(row, min_size=1, max_size=3))
