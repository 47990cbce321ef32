"""PointCloud2: points of any layout and byte order, as depth cameras, lidars and maps send them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Final

import numpy as np

from studio.displays.cloud import Cloud, kept, listed, nothing_of, rgb_of_shares
from studio.displays.cloud_display import CloudDisplay
from studio.displays.display import TopicRole, stamp_ns_of
from studio.displays.selection import FACTS_MAX, Fact, number_fact, numbers_fact
from studio.errors import DisplayMessageError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.display import Limits, Received

RAW_POINTS_MAX: Final = 8_000_000
"""With more points in a message, every second, third ... is read."""

# By `datatype` of sensor_msgs/PointField: INT8 1 to FLOAT64 8.
_NUMBERS: Final = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
_FIELDS_MAX: Final = 1000
_NUMBERS_OF_FIELD_MAX: Final = 33
"""Of one point that are shown: a descriptor FPFH has as many."""
_PACKED: Final = ("rgb", "rgba")
_PARTS: Final = ("r", "g", "b")


class CloudFields:
    """The columns of one PointCloud2; numbers are read from its bytes when they are needed."""

    def __init__(self, message: Any) -> None:  # noqa: ANN401 - a sensor_msgs/PointCloud2
        """Check that the data holds all points.

        Raises:
            DisplayMessageError: It does not.
        """
        _check(message)
        self._message = message
        self._order = ">" if message.is_bigendian else "<"
        self._columns, self._rows = int(message.width), int(message.height)
        self.count: int = self._columns * self._rows
        self._row_bytes = _row_bytes(message)
        if self._row_bytes == self._columns * int(message.point_step):
            # Without bytes between the rows they are one, of which columns are taken faster.
            self._columns, self._rows = self.count, 1
            self._row_bytes = self.count * int(message.point_step)
        self._fields: dict[str, Any] = {}
        self._faults: dict[str, str] = {}
        for field in message.fields:
            self._add(field)
        self.names: tuple[str, ...] = tuple(self._fields)

    @property
    def size_bytes(self) -> int:
        """Memory that the data takes."""
        return int(self._message.data.nbytes)

    def positions(self) -> tuple[NDArray[np.float32], NDArray[np.intp] | None]:
        """Return places of the points, m, shape (N, 3), also of those that are NaN; a new array.

        Of huge clouds only some are read; their indices come second, else None.

        Raises:
            DisplayMessageError: There is no x, y or z.
        """
        if not self.count:
            return np.empty((0, 3), dtype=np.float32), None
        for name in "xyz":
            if name not in self._fields:
                none = f"it has no {name}, its fields are {listed(self.names)}"
                raise self._error(self._faults.get(name, none))
        step = -(-self.count // RAW_POINTS_MAX)
        if step > 1:
            raw = np.arange(0, self.count, step)
            return self._stacked(raw), raw
        if self._interleaved():
            view = self._view("x", np.dtype(f"{self._order}f4"), count=3)
            return view.astype(np.float32, order="C").reshape(-1, 3), None
        return self._stacked(None), None

    def numbers(self, name: str, raw: NDArray[np.intp] | None) -> NDArray[np.float32] | None:
        """Return a field's numbers for these raw points, all when None; None without the field.

        Of a field with several numbers for each point it is the first.
        """
        if name not in self._fields:
            return None
        with np.errstate(over="ignore", invalid="ignore"):
            return self._taken(self._view(name, self._dtype(name)), raw).astype(np.float32)

    def colours(self, raw: NDArray[np.intp] | None) -> NDArray[np.uint8] | None:
        """Colours that were sent as bytes, shape (N, 3); None when there are none.

        Those are packed into the bits of one number of four bytes, whatever its type, or lie in
        three fields r, g and b of bytes.
        """
        name = next((one for one in _PACKED if one in self._fields), None)
        if name is not None and self._fields[name].datatype in (5, 6, 7):
            return np.ascontiguousarray(self._taken(self._bytes_view(name), raw))
        if not self._are_parts(2):
            return None
        parts = [self._taken(self._view(one, self._dtype(one)), raw) for one in _PARTS]
        return np.stack(parts, axis=1).astype(np.uint8, copy=False)

    def float_colours(self, raw: NDArray[np.intp] | None) -> NDArray[np.uint8] | None:
        """Colours of fields r, g and b between 0 and 1, shape (N, 3); None when there are none."""
        if not self._are_parts(7):
            return None
        parts = [self.numbers(one, raw) for one in _PARTS]
        return rgb_of_shares([one for one in parts if one is not None])

    def facts(self, index: int) -> tuple[Fact, ...]:
        """Return the fields of one point as they were sent, but for its place."""
        if not 0 <= index < self.count:
            return ()
        row, column = divmod(index, self._columns)
        return tuple(
            self._fact(name, row, column)
            for name in self.names[: FACTS_MAX + 3]
            if name not in "xyz"
        )

    def _fact(self, name: str, row: int, column: int) -> Fact:
        field = self._fields[name]
        if name in _PACKED and field.datatype in (5, 6, 7):
            red, green, blue = (float(one) / 255 for one in self._bytes_view(name)[row, column])
            return Fact(name, (red, green, blue, 1.0), kind="colour")
        dtype = self._dtype(name)
        fits = (int(self._message.point_step) - int(field.offset)) // dtype.itemsize
        count = min(max(int(field.count), 1), fits, _NUMBERS_OF_FIELD_MAX)
        if count > 1:
            return numbers_fact(name, self._view(name, dtype, count)[row, column], kind="field")
        return number_fact(name, self._view(name, dtype)[row, column].item(), kind="field")

    def _add(self, field: Any) -> None:  # noqa: ANN401 - a sensor_msgs/PointField
        """Add a field by its name; of two with one name the first counts, as in RViz.

        One that cannot be read is as if it were not there, until it is needed for a place.
        """
        name = str(field.name)
        if name in self._fields or name in self._faults:
            return
        numbers = _NUMBERS.get(field.datatype)
        if numbers is None:
            fault = f"has the unknown datatype {field.datatype}"
        elif field.offset + np.dtype(numbers).itemsize > self._message.point_step:
            fault = (
                f"ends after the {self._message.point_step} bytes of a point: point_step or the "
                "offset is wrong"
            )
        else:
            self._fields[name] = field
            return
        self._faults[name] = f'its field "{name[:60]}" {fault}'

    def _are_parts(self, datatype: int) -> bool:
        return all(one in self._fields and self._fields[one].datatype == datatype for one in _PARTS)

    def _interleaved(self) -> bool:
        """Whether x, y and z are floats that lie one after the other, as nearly everywhere."""
        x, y, z = (self._fields[name] for name in "xyz")
        return (
            (x.datatype, y.datatype, z.datatype) == (7, 7, 7)
            and y.offset == x.offset + 4
            and z.offset == x.offset + 8
        )

    def _stacked(self, raw: NDArray[np.intp] | None) -> NDArray[np.float32]:
        parts = [self.numbers(name, raw) for name in "xyz"]
        return np.stack([part for part in parts if part is not None], axis=1)

    def _taken(self, view: NDArray[Any], raw: NDArray[np.intp] | None) -> NDArray[Any]:
        """Return the points of rows and columns in one row, as a view where possible."""
        if raw is None:
            return view.reshape(-1, *view.shape[2:])
        if self._rows == 1:
            return view[0][raw]
        return view[raw // self._columns, raw % self._columns]

    def _dtype(self, name: str) -> np.dtype[Any]:
        return np.dtype(self._order + _NUMBERS[self._fields[name].datatype])

    def _view(self, name: str, dtype: np.dtype[Any], count: int = 0) -> NDArray[Any]:
        """Return numbers at a field's offset, shape (rows, columns) or (rows, columns, count)."""
        strides = (self._row_bytes, int(self._message.point_step))
        inner = (count,) if count else ()
        return np.ndarray(
            (self._rows, self._columns, *inner), dtype, self._message.data,
            int(self._fields[name].offset), strides + ((dtype.itemsize,) if count else ()),
        )  # fmt: skip

    def _bytes_view(self, name: str) -> NDArray[np.uint8]:
        """Red, green and blue of a packed colour: bits 16 to 23, 8 to 15 and 0 to 7."""
        at, step = (1, 1) if self._order == ">" else (2, -1)
        return np.ndarray(
            (self._rows, self._columns, 3), np.dtype(np.uint8), self._message.data,
            int(self._fields[name].offset) + at,
            (self._row_bytes, int(self._message.point_step), step),
        )  # fmt: skip

    def _error(self, reason: str) -> DisplayMessageError:
        return DisplayMessageError("PointCloud2", reason)


def _row_bytes(message: Any) -> int:  # noqa: ANN401
    """Bytes from row to row: some senders leave `row_step` as it is, and rows follow closely."""
    packed = int(message.width) * int(message.point_step)
    if message.height <= 1 or (
        message.row_step < packed and packed * int(message.height) == message.data.nbytes
    ):
        return packed
    return int(message.row_step)


def _check(message: Any) -> None:  # noqa: ANN401
    columns, rows = int(message.width), int(message.height)
    if len(message.fields) > _FIELDS_MAX:
        raise DisplayMessageError("PointCloud2", f"it has {len(message.fields):,} fields")
    if not columns * rows:
        return
    point, row, held = int(message.point_step), _row_bytes(message), int(message.data.nbytes)
    if not point:
        raise DisplayMessageError("PointCloud2", "its point_step is 0")
    if row < columns * point:
        raise DisplayMessageError(
            "PointCloud2",
            f"its row_step of {row:,} bytes is shorter than {columns:,} points of {point:,} bytes",
        )
    needed = (rows - 1) * row + columns * point
    if needed > held:
        raise DisplayMessageError(
            "PointCloud2",
            f"{columns:,} x {rows:,} points of {point:,} bytes need {needed:,} bytes, and it has "
            f"{held:,}",
        )


class PointCloud2Display(CloudDisplay):
    """Draws every point that has a position, or as many as the limits allow."""

    KIND: ClassVar[str] = "PointCloud2"
    DOC: ClassVar[str] = "Points in space, in colours that are sent or made of their numbers."
    ICON: ClassVar[str] = "cloud"
    TOPICS: ClassVar[tuple[TopicRole, ...]] = (
        TopicRole("", ("sensor_msgs/msg/PointCloud2",), reliable=False),
    )

    def read(self, received: Received, limits: Limits) -> Cloud:
        """Return the cloud of a message.

        Raises:
            StudioError: It cannot be read, or its data does not match its fields.
        """
        message = self.decode(received)
        fields = CloudFields(message)
        positions, read_rows = fields.positions()
        shown, chosen, available = kept(positions, limits.points)
        if read_rows is not None:
            chosen = read_rows if chosen is None else read_rows[chosen]
            available = available * fields.count // len(read_rows)
        return Cloud(
            message.header.frame_id, stamp_ns_of(message.header), shown, chosen, available, fields,
            nothing_of(fields.count, shown),
        )  # fmt: skip

    def channel_facts(self, cloud: Cloud, index: int) -> tuple[Fact, ...]:
        """Return the fields of a point with the numbers that were sent, not only as colours."""
        channels = cloud.channels
        if isinstance(channels, CloudFields):
            return channels.facts(index)
        return super().channel_facts(cloud, index)
