"""A number out of each of many messages by numpy: all of them are walked at once, field by field.

Where the messages stand is one number for all of them as long as what lies before the field is as
long in each; from the first text of another length on it is one for each message.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np

from studio.errors import CdrError, FieldPathError
from studio.ros.columns.field_paths import (
    ANGLES,
    NORM_ITEMS,
    FieldStep,
    IndexStep,
    Step,
    WorkStep,
    angle_of,
    number_at,
    steps_of,
)
from studio.ros.columns.layout import HEADER_BYTES
from studio.ros.types.classes import class_of_field, definition_of
from studio.ros.types.definitions import FieldType, Message, Shape

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from numpy.typing import NDArray
    from typing_extensions import TypeIs

    from studio.ros.types.classes import MessageValue

Integers: TypeAlias = "NDArray[np.int64]"
Floats: TypeAlias = "NDArray[np.float64]"
_KINDS: Final = {
    "bool": "u1", "byte": "u1", "char": "u1", "float32": "f4", "float64": "f8",
    **{f"int{bits}": f"i{bits // 8}" for bits in (8, 16, 32, 64)},
    **{f"uint{bits}": f"u{bits // 8}" for bits in (8, 16, 32, 64)},
}  # fmt: skip
_ALIGNMENTS: Final = np.arange(8)
_SETTLED: Final = 8
"""After so many items, the places at which items begin modulo 8 come round again."""
_ITEMS_MAX, _ROWS_LEAST = 32, 32
"""Walking over more items in fewer messages takes longer than decoding these one by one."""


# What a message is made of. `steps` is how far one gets over it from a place, by that place modulo
# 8; None where messages differ in that.


@dataclass(frozen=True, slots=True)
class _Number:
    kind: str
    is_bool: bool = False

    @property
    def size(self) -> int:
        return int(self.kind[1])

    @property
    def steps(self) -> Integers | None:
        return -_ALIGNMENTS % self.size + self.size


@dataclass(frozen=True, slots=True)
class _Text:
    steps: Integers | None = None


@dataclass(frozen=True, slots=True)
class _WideText:
    """Has no form that all implementations write."""

    steps: Integers | None = None


@dataclass(frozen=True)
class _Struct:
    name: str
    parts: dict[str, _Node]

    @cached_property
    def steps(self) -> Integers | None:
        # A type without fields has one byte.
        return _all_steps(self.parts.values()) if self.parts else np.ones(8, np.int64)


@dataclass(frozen=True)
class _List:
    """`count` is None for a sequence, which says itself how many follow."""

    item: _Node
    count: int | None

    @cached_property
    def runs(self) -> _Runs | None:
        return None if self.item.steps is None else _Runs(self.item.steps)

    @cached_property
    def steps(self) -> Integers | None:
        if self.count is None or self.runs is None:
            return None
        return self.runs.bytes_of(self.count, _ALIGNMENTS)


_Node: TypeAlias = "_Number | _Text | _WideText | _Struct | _List"


def _all_steps(parts: Iterable[_Node]) -> Integers | None:
    passed = np.zeros(8, np.int64)
    for part in parts:
        if part.steps is None:
            return None
        passed = passed + part.steps[(_ALIGNMENTS + passed) & 7]
    return passed


class _Runs:
    """How many bytes any number of items takes that are alike but for what fills up before them."""

    def __init__(self, steps: Integers) -> None:
        passed = [np.zeros(8, np.int64)]
        for _ in range(2 * _SETTLED):
            passed.append(passed[-1] + steps[(_ALIGNMENTS + passed[-1]) & 7])
        self._passed = np.stack(passed, axis=1)
        places = (_ALIGNMENTS[:, None] + self._passed) & 7
        again = places[:, _SETTLED + 1 :] == places[:, _SETTLED : _SETTLED + 1]
        self._round = again.argmax(axis=1) + 1
        settled = self._passed[:, _SETTLED]
        self._round_bytes = self._passed[_ALIGNMENTS, _SETTLED + self._round] - settled

    def bytes_of(self, count: int | Integers, at: int | Integers) -> Any:  # noqa: ANN401
        """Return the bytes from a place on, of one message or of each."""
        place = at & 7
        first = np.minimum(count, _SETTLED)
        more, size = count - first, self._round[place]
        rounds = more // size
        return self._passed[place, first + more % size] + rounds * self._round_bytes[place]


def _node(kind: type[MessageValue], known: dict[str, _Node]) -> _Node:
    """Describe a class; of one that is there twice the same."""
    message: Message = definition_of(kind)
    if message.name not in known:
        parts: dict[str, _Node] = {}
        for one in message.fields:
            item = (
                _node(class_of_field(kind, one), known)
                if one.type.nested
                else _plain(one.type.base)
            )
            parts[one.name] = _listed(item, one.type)
        known[message.name] = _Struct(message.name, parts)
    return known[message.name]


def _plain(base: str) -> _Node:
    if base == "string":
        return _Text()
    return _WideText() if base == "wstring" else _Number(_KINDS[base], base == "bool")


def _listed(item: _Node, kind: FieldType) -> _Node:
    if kind.shape is Shape.SINGLE:
        return item
    return _List(item, kind.count if kind.shape is Shape.ARRAY else None)


@dataclass(eq=False, slots=True)
class _Batch:
    """Messages in one piece of memory, all of one order of bytes."""

    raw: NDArray[np.uint8]
    order: str
    count: int
    left: list[Integers] = field(default_factory=list["Integers"])
    """Those that are to be decoded one by one."""
    views: dict[str, NDArray[Any]] = field(default_factory=dict[str, "NDArray[Any]"])

    def view(self, kind: str) -> NDArray[Any]:
        """View the memory as numbers that begin at every byte."""
        if kind not in self.views:
            dtype = np.dtype(self.order + kind)
            count = max(0, self.raw.size - dtype.itemsize + 1)
            self.views[kind] = np.ndarray((count,), dtype, self.raw.data, strides=(1,))
        return self.views[kind]


class _Rows:
    """Some messages of a batch, and how far they have been walked.

    Attributes:
        index: Their numbers within what was given.
        begins: Where their bodies begin in the memory.
        sizes: Bytes of their bodies.
        at: Where they stand in their bodies; one number if that is the same for all.
    """

    __slots__ = ("at", "batch", "begins", "index", "sizes")

    def __init__(
        self,
        batch: _Batch,
        index: Integers,
        begins: Integers,
        sizes: Integers,
        at: int | Integers = 0,
    ) -> None:
        self.batch, self.index, self.begins, self.sizes = batch, index, begins, sizes
        self.at: Any = at

    def __len__(self) -> int:
        return self.index.size

    def only(self, chosen: NDArray[np.bool_]) -> _Rows:
        """Return some of them."""
        at = self.at[chosen] if np.ndim(self.at) else self.at
        return _Rows(
            self.batch, self.index[chosen], self.begins[chosen], self.sizes[chosen], _joined(at)
        )

    def keep(self, chosen: NDArray[np.bool_]) -> None:
        """Leave the others out: they end too early, or have no such item."""
        kept = self.only(chosen)
        self.index, self.begins, self.sizes, self.at = kept.index, kept.begins, kept.sizes, kept.at

    def need(self, total_bytes: int | Integers) -> NDArray[np.bool_] | None:
        """Leave out those that end within so many bytes; return which stay, None: all."""
        there = self.at + total_bytes <= self.sizes
        if there.all():
            return None
        self.keep(there)
        return there

    def take(self, number: _Number) -> NDArray[Any]:
        """Read a number of each."""
        size = number.size
        self.at = self.at + (-self.at & (size - 1))
        self.need(size)
        found = self.batch.view(number.kind)[self.begins + self.at]
        self.at = self.at + size
        return found != 0 if number.is_bool else found

    def count(self, bytes_least: int) -> int | Integers:
        """Read how many items follow, or bytes of a text; one number if it is the same for all."""
        counts = self.take(_COUNT).astype(np.int64)
        stay = self.need(counts * bytes_least)
        return _joined(counts if stay is None else counts[stay])

    def spread(self, values: NDArray[Any]) -> Floats:
        """Return values in the places of their messages; NaN where there are none."""
        if len(self) == self.batch.count:
            spread = np.empty(self.batch.count)
        else:
            spread = np.full(self.batch.count, math.nan)
        spread[self.index] = values
        return spread


_COUNT: Final = _Number("u4")


def _joined(numbers: Any) -> Any:  # noqa: ANN401
    """Return one number if all are the same."""
    if not np.ndim(numbers) or not numbers.size:
        return numbers if not np.ndim(numbers) else 0
    first = numbers[0]
    return int(first) if (numbers == first).all() else numbers


def _merged(parts: Sequence[_Rows]) -> _Rows:
    """Put groups together again, in any order."""
    if len(parts) == 1:
        return parts[0]
    at = np.concatenate([np.broadcast_to(one.at, (len(one),)) for one in parts])
    arrays = (
        np.concatenate([getattr(one, name) for one in parts])
        for name in ("index", "begins", "sizes")
    )
    return _Rows(parts[0].batch, *arrays, at=_joined(at))


def _skip(node: _Node, rows: _Rows) -> _Rows:
    """Walk over a part."""
    if node.steps is not None:
        rows.at = rows.at + node.steps[rows.at & 7]
        return rows
    match node:
        case _Struct():
            for part in node.parts.values():
                rows = _skip(part, rows)
            return rows
        case _List():
            count = rows.count(1) if node.count is None else node.count
            return _skip_items(node, rows, count)
        case _:
            size = rows.count(1)
            rows.at = rows.at + size
            return rows


def _skip_items(node: _List, rows: _Rows, counts: int | Integers) -> _Rows:
    """Walk over so many items of a list."""
    if node.runs is not None:
        rows.at = rows.at + node.runs.bytes_of(counts, rows.at)
        return rows
    if not isinstance(counts, np.ndarray):
        return _skip_alike(node, rows, counts)
    return _merged(
        [_skip_alike(node, rows.only(counts == one), int(one)) for one in np.unique(counts)]
    )


def _skip_alike(node: _List, rows: _Rows, count: int) -> _Rows:
    """Walk over items that can differ in their bytes."""
    if count > _ITEMS_MAX and len(rows) < _ROWS_LEAST:
        rows.batch.left.append(rows.index)
        rows.keep(np.zeros(len(rows), np.bool_))
    for _ in range(count if len(rows) else 0):
        rows = _skip(node.item, rows)
    return rows


# A way through a message: parts to walk over, and lists to walk into.


@dataclass(frozen=True, slots=True)
class _Into:
    """To an item of a list; of a negative index, counted from its end."""

    node: _List
    index: int

    def walk(self, rows: _Rows) -> _Rows:
        index = self.index
        if self.node.count is not None:
            return _skip_items(self.node, rows, index % self.node.count)
        counts = rows.count(1)
        found = index + counts if index < 0 else counts * 0 + index
        there = np.broadcast_to((found >= 0) & (found < counts), (len(rows),))
        rows.keep(there)
        return _skip_items(
            self.node, rows, _joined(found[there]) if isinstance(found, np.ndarray) else found
        )


_Move: TypeAlias = "_Into | _Node"
_Leaf: TypeAlias = "Callable[[_Rows], Floats]"


def _number_of(node: _Node, rows: _Rows) -> tuple[Floats, _Rows]:
    """Read what a part is as a number, NaN if it is none, and walk over it."""
    if isinstance(node, _Number):
        values = rows.take(node)
        return rows.spread(values), rows
    if _is_time(node):
        parts, rows = _numbers_of(node, rows)
        return parts["sec"] + parts["nanosec"] / 1e9, rows
    rows = _skip(node, rows)
    return np.full(rows.batch.count, math.nan), rows


def _numbers_of(node: _Struct, rows: _Rows) -> tuple[dict[str, Floats], _Rows]:
    found: dict[str, Floats] = {}
    for name, part in node.parts.items():
        found[name], rows = _number_of(part, rows)
    return found, rows


def _is_time(node: _Node) -> TypeIs[_Struct]:
    return isinstance(node, _Struct) and {"sec", "nanosec"} <= {*node.parts}


class FieldReader:
    """Reads the number at a path out of many messages of a type.

    Args:
        kind: The class of the messages.
        path: As `studio.ros.columns.field_paths` has it.
        decode: Decodes one message; for those whose parts are better read one by one.

    Raises:
        FieldPathError: It is no path, or messages of the type have no number there.
    """

    def __init__(
        self, kind: type[MessageValue], path: str, decode: Callable[[bytes], MessageValue]
    ) -> None:
        self._path, self._decode = path, decode
        self._steps = steps_of(path)
        self._moves: list[_Move] = []
        self._turns: list[float] = []
        """What a number is multiplied with in the end, one after another."""
        node = _node(kind, {})
        if _holds_wide_text(node):
            raise self._none("messages of its type hold a wstring, which is not read")
        self._leaf = self._find(node)

    def read(
        self, data: bytes | bytearray | memoryview, offsets: Integers, lengths: Integers
    ) -> Floats:
        """Return the number of each message, NaN where there is none.

        A message that is cut off behind the number has one all the same.

        Args:
            data: What holds the messages, each with its header of four bytes.
            offsets: Shape (N,), where each begins.
            lengths: Shape (N,), of each in bytes; all lie within `data`.

        Returns:
            Shape (N,).
        """
        values = np.full(offsets.size, math.nan)
        raw = np.frombuffer(data, np.uint8)
        long_enough = np.flatnonzero(lengths >= HEADER_BYTES)
        heads = offsets[long_enough]
        is_plain = raw[heads] == 0
        for order, mark in (("<", 1), (">", 0)):
            index = long_enough[is_plain & (raw[heads + 1] == mark)]
            if index.size:
                bodies, sizes = offsets[index] + HEADER_BYTES, lengths[index] - HEADER_BYTES
                batch = _Batch(raw, order, index.size)
                with np.errstate(all="ignore"):  # the numbers are whatever was sent
                    values[index] = self._read_batch(
                        _Rows(batch, np.arange(index.size), bodies, sizes)
                    )
                for at in (one for left in batch.left for one in index[left].tolist()):
                    begin = int(offsets[at])
                    values[at] = self._read_one(bytes(data[begin : begin + int(lengths[at])]))
        return values

    def _read_batch(self, rows: _Rows) -> Floats:
        if self._leaf is None:
            rows.batch.left.append(rows.index)
            return np.full(rows.batch.count, math.nan)
        for move in self._moves:
            rows = move.walk(rows) if isinstance(move, _Into) else _skip(move, rows)
        values = self._leaf(rows)
        for work in self._turns:
            values = values * 180 / math.pi if work > 1 else values * math.pi / 180
        return values

    def _read_one(self, payload: bytes) -> float:
        try:
            return number_at(self._decode(payload), self._steps)
        except CdrError:
            return math.nan

    def _find(self, node: _Node) -> _Leaf | None:
        """Find the way to the number; None: it is to be decoded one by one."""
        steps = list(self._steps)
        while steps and not isinstance(steps[0], WorkStep):
            node = self._step(node, steps.pop(0))
        leaf: _Leaf | None = _leaf_of(node)
        works = [step.work for step in steps if isinstance(step, WorkStep)]
        if len(works) < len(steps):
            raise self._none("nothing lies within a number")
        if works and works[0] not in ("deg", "rad"):
            leaf = self._worked(node, works.pop(0))
        elif leaf is None:
            raise self._none(f"{_name_of(node)} lies there")
        if any(work not in ("deg", "rad") for work in works):
            raise self._none(f"@{works[-1]} is not worked out of a number")
        self._turns = [180.0 if work == "deg" else 0.0 for work in works]
        return leaf

    def _step(self, node: _Node, step: Step) -> _Node:
        match node, step:
            case _Struct(), FieldStep(name) if name in node.parts:
                for other, part in node.parts.items():
                    if other == name:
                        return part
                    self._moves.append(part)
            case _List(), IndexStep(index):
                if node.count is not None and not -node.count <= index < node.count:
                    raise self._none(f"the list has {node.count} items")
                self._moves.append(_Into(node, index))
                return node.item
            case _Struct(), FieldStep(name):
                raise self._none(f"{node.name} has no field {name}")
            case _:
                pass
        raise self._none(f"{_name_of(node)} lies before {_shown(step)}")

    def _none(self, reason: str) -> FieldPathError:
        return FieldPathError(self._path, reason)

    def _worked(self, node: _Node, work: str) -> _Leaf | None:
        match node:
            case _List() if work == "length":
                return _length_leaf(node)
            case _Text() if work == "length":
                return None
            case _List(_Number(), int(count)) if work == "norm" and count <= NORM_ITEMS:
                return _norm_leaf(_Struct("", {str(n): node.item for n in range(count)}))
            case _List() if work == "norm":
                return None
            case _Struct() if work == "norm" and len(node.parts) <= NORM_ITEMS:
                return _norm_leaf(node)
            case _Struct() if work in ANGLES and {*"xyzw"} <= {*node.parts}:
                return _angle_leaf(node, work)
            case _:
                raise self._none(f"@{work} is not worked out of {_name_of(node)}")


def _leaf_of(node: _Node) -> _Leaf | None:
    if not isinstance(node, _Number) and not _is_time(node):
        return None
    return lambda rows: _number_of(node, rows)[0]


def _length_leaf(node: _List) -> _Leaf:
    def length(rows: _Rows) -> Floats:
        count = node.count
        return rows.spread(np.asarray(rows.count(1) if count is None else count))

    return length


def _norm_leaf(node: _Struct) -> _Leaf:
    def norm(rows: _Rows) -> Floats:
        parts = list(_numbers_of(node, rows)[0].values())
        return np.hypot.reduce(parts) if parts else rows.spread(np.zeros(len(rows)))

    return norm


def _angle_leaf(node: _Struct, work: str) -> _Leaf:
    def angle(rows: _Rows) -> Floats:
        parts, _ = _numbers_of(node, rows)
        return angle_of(work, *(parts[axis] for axis in "xyzw"))

    return angle


def _holds_wide_text(node: _Node) -> bool:
    match node:
        case _WideText():
            return True
        case _List():
            return _holds_wide_text(node.item)
        case _Struct():
            return any(map(_holds_wide_text, node.parts.values()))
        case _:
            return False


def _name_of(node: _Node) -> str:
    match node:
        case _Number():
            return "a number"
        case _Struct():
            return f"a {node.name}"
        case _List():
            return "a list"
        case _:
            return "a text"


def _shown(step: Step) -> str:
    match step:
        case FieldStep(name):
            return f".{name}"
        case IndexStep(index):
            return f"[{index}]"
        case WorkStep(work):
            return f"@{work}"
