"""Propagates a change through the graph of a run: what depends on it is evaluated once more.

Texts are evaluated in the order of the run, and no further than values change. Names mean what they
meant in the run, whatever was defined since. What is decided by more than values (whether
something comes out, under which name, from which file), and a text that would read anything else
than it did, is refused: only a full run knows what else would follow.

When a text becomes a literal it reads nothing, and a property that it was the first to read
is evaluated by its next reader: a moment later, so its names must still mean the same then. If
nothing else reads the property, it is not evaluated at all.
"""

from __future__ import annotations

import heapq
import math
import re
from typing import TYPE_CHECKING, Any, Final, cast

from studio.description.evaluator.graph import Cell, Record, Role, Scope, YamlReads, behind
from studio.description.evaluator.texts import literal_value, truth_of
from studio.description.expressions.bounds import is_lasting
from studio.description.expressions.guards import text_of
from studio.description.faults import Fault, Refusal
from studio.description.syntax.source_tree import SourceText

if TYPE_CHECKING:
    from collections.abc import Iterator
    from contextlib import AbstractContextManager

    from studio.description.evaluator.graph import Argument, MadeElement, Readable
    from studio.description.evaluator.output_tree import OutputElement, OutputIndex
    from studio.description.evaluator.texts import Texts

_SIMPLE: Final = frozenset({int, str, bool, type(None)})
_COMPARES: Final = re.compile(r"[=<>]|\bin\b")
_NAME: Final = re.compile(r"[A-Za-z_]\w*")


class PatchRefused(Exception):  # noqa: N818 - no error: the full run does it
    """Only a full run can evaluate an edit; the argument says why."""


class Replay:
    """Evaluates the records of one run again."""

    def __init__(self, texts: Texts) -> None:
        self._texts = texts
        self._scratch = Record("", cast("Scope", texts), "", Role.NOTHING, None)
        """What is being read."""
        self._record = self._scratch

    def going_on(self) -> AbstractContextManager[None]:
        """Within: records may be evaluated `again`."""
        return self._texts.replayed(self)

    def again(self, record: Record) -> Any:  # noqa: ANN401
        """Return the value of a record's text now; the record stays as it is.

        Raises:
            PatchRefused: It fails, warns, or reads other things than it did.
        """
        if record.is_noisy:
            raise PatchRefused(f"{record.text!r} has another effect than its value")
        self._record, self._scratch.reads = record, []
        self._texts.replay_from(record.file, self._scratch)
        try:
            value = self._value(record)
        except (Fault, RecursionError, MemoryError) as error:
            raise PatchRefused(f"{record.text!r} fails: {error}") from None
        reads = self._scratch.reads
        if len(reads) != len(record.reads) or any(map(_differ, reads, record.reads)):
            raise PatchRefused(f"{record.text!r} reads other things")
        return value

    def _value(self, record: Record) -> Any:  # noqa: ANN401
        if record.forwards:
            return self.value_of(record.text, record.scope)
        return self._texts.value(record.text, record.scope)

    def value_of(self, name: str, scope: Scope) -> Any:  # noqa: ANN401
        """Return what a name meant at this point of the text, with its present value.

        Raises:
            PatchRefused: The text did not read it the first time.
        """
        reads, expected = self._scratch.reads, self._record.reads
        cell = expected[len(reads)] if len(reads) < len(expected) else None
        if type(cell) is Cell and cell.name == name and scope.is_inside(cell.scope):
            reads.append(cell)
            return cell.value
        if name not in scope.run.symbols or scope.find(name) is not None:
            raise PatchRefused(f'"{name}" was not read before')
        return scope.run.symbols[name]

    def refuse(self, reason: str) -> None:
        """Raise.

        Raises:
            PatchRefused: Always.
        """
        raise PatchRefused(reason)


def _differ(one: object, other: object) -> bool:
    return one is not other


def is_same(old: Any, new: Any) -> bool:  # noqa: ANN401
    """Whether two values are indistinguishable: by type, as they print, in any expression."""
    kind = cast("type[object]", type(old))
    if kind is not type(new):
        return False
    if kind in _SIMPLE:
        return old == new
    if kind is float:
        return old == new and math.copysign(1, old) == math.copysign(1, new)
    if kind is list or kind is tuple:
        return len(old) == len(new) and all(map(is_same, old, new))
    if kind is dict:
        pairs = zip(old.items(), new.items(), strict=False)
        return len(old) == len(new) and all(is_same(one, other) for one, other in pairs)
    return False


class Propagation:
    """Carries one request through the graph."""

    def __init__(self, replay: Replay, index: OutputIndex) -> None:
        self._replay, self._index = replay, index
        self._heap: list[tuple[float, int, Record]] = []
        self._queued: set[Record] = set()
        self.parts: dict[OutputElement, None] = {}
        """Parts that came to be other ones."""
        self.changed: dict[Cell | Argument, None] = {}
        """Those whose value changed."""

    def put(self, holder: Cell | Argument, value: Any) -> None:  # noqa: ANN401
        """Give something named another value, and have its readers evaluated again."""
        if isinstance(holder, Cell):
            value = literal_value(value)
            if not is_lasting(value):
                raise PatchRefused("an iterator is used up by its first reader")
        if not is_same(holder.value, value):
            holder.value = value
            self.changed[holder] = None
            self.touch(holder)

    def touch(self, read: Readable) -> None:
        """Have the readers of something evaluated again."""
        for record in read.readers:
            if record not in self._queued:
                self._queued.add(record)
                heapq.heappush(self._heap, (record.order, len(self._queued), record))

    def forget(self, record: Record) -> None:
        """Leave out a record that is none any more."""
        self._queued.add(record)
        self._heap = [one for one in self._heap if one[2] is not record]
        heapq.heapify(self._heap)

    def run(self) -> None:
        """Evaluate all that depends on what was touched.

        Raises:
            PatchRefused: Only a full run can evaluate it.
        """
        with self._replay.going_on():
            while self._heap:
                record = heapq.heappop(self._heap)[2]
                try:
                    self._take(record, self._replay.again(record))
                except (Fault, Refusal) as fault:
                    raise PatchRefused(str(fault)) from None

    def _take(self, record: Record, value: Any) -> None:  # noqa: ANN401
        match record.sink:
            case Role.STRUCTURE:
                if not is_same(record.value, value):
                    raise PatchRefused(f"{record.text!r} decides what is evaluated")
            case Role.CONDITION:
                if truth_of(value, record.text) != truth_of(record.value, record.text):
                    raise PatchRefused(f"the condition {record.text!r} turns")
                record.value = value
            case Role.NOTHING:
                record.value = value
            case list() as elements:
                self._write(record, elements, text_of(value))
            case SourceText() as text:
                self._write_text(record, text, text_of(value))
            case Cell() as cell:
                record.value = value
                self.put(cell, value)
            case argument:
                record.value = value
                self.put(argument, text_of(value))

    def _write(self, record: Record, elements: list[MadeElement], text: str) -> None:
        if text == record.value:
            return
        if "$" in text or "$" in record.value or record.consumer is None:
            raise PatchRefused("a block's text would be evaluated again")
        record.value = text
        name = record.consumer[1]
        for element in elements:
            if element.makers.get(name) is record:
                self.write(element, name, text)

    def write(self, element: MadeElement, name: str, text: str) -> None:
        """Give an attribute that came out another text.

        Raises:
            PatchRefused: It names a part, or is a namespace.
        """
        if name.startswith("xmlns") or (name == "name" and element in self._index.keys):
            raise PatchRefused(f"{name} is more than a value")
        element.attributes = {**element.attributes, name: text}
        part = self._index.part_of.get(cast("OutputElement", element))
        if part is not None:
            self.parts[part] = None

    def _write_text(self, record: Record, node: SourceText, text: str) -> None:
        if text == record.value:
            return
        if "$" in text or "$" in record.value:
            raise PatchRefused("a block's text would be evaluated again")
        if bool(text.strip()) != bool(node.text.strip()):
            raise PatchRefused("a text comes or goes")
        record.value = node.text = text
        self.parts.update(dict.fromkeys(self._index.parts_of_text.get(node, ())))


class Detaching:
    """Takes evaluations out of a graph; `unlinked` are those whose readers became other ones."""

    def __init__(self, propagation: Propagation, asked_at: dict[str, float]) -> None:
        self._propagation, self._asked_at = propagation, asked_at
        self.unlinked: dict[Readable, None] = {}

    def detach(self, record: Record) -> None:
        """Undo the evaluation of a text.

        Raises:
            PatchRefused: Only a full run knows what follows.
        """
        if record.is_noisy or _COMPARES.search(record.text):
            raise PatchRefused(f"{record.text!r} has another effect than its value")
        self.unlinked.update(dict.fromkeys(behind(record)))
        self._propagation.forget(record)
        for read in dict.fromkeys(record.reads):
            if isinstance(read, YamlReads) and read.readers[0] is record:
                raise PatchRefused("a file may not be read any more")
            read.readers = [one for one in read.readers if one is not record]
        for cell, evaluated in _triggered(record):
            if cell.readers:
                self._move(cell, evaluated, min(cell.readers, key=_order))
            else:
                self._leave_unread(cell, evaluated)

    def _leave_unread(self, cell: Cell, evaluated: Record) -> None:
        cell.pending, cell.value, cell.record = evaluated.text, evaluated.text, None
        self._propagation.changed[cell] = None
        self.detach(evaluated)

    def _move(self, cell: Cell, evaluated: Record, reader: Record) -> None:
        """Let a property be evaluated by its next reader."""
        if reader.order % 1 or any(_triggered(reader)):
            raise PatchRefused("the order of evaluation is not known")
        if any(cell in around.reads for around in _around(reader)):
            raise PatchRefused("its next reader is not known")
        moved = list(_with_nested(evaluated))
        for one in moved:
            self._check_meaning(one, evaluated, reader)
        evaluated.trigger = reader
        for number, one in enumerate(moved, 1):
            one.order = reader.order - 1 + number / (len(moved) + 1)
        for read in dict.fromkeys(read for one in moved for read in one.reads):
            read.readers.sort(key=_order)

    def _check_meaning(self, one: Record, first: Record, reader: Record) -> None:
        """Check that a text has the same value when `reader` reads it.

        Raises:
            PatchRefused: It may not.
        """
        if one.is_noisy or (reader.file != one.file and "(" in one.text):
            raise PatchRefused(f"{one.text!r} depends on the file that is read")
        cells = {read.name: read for read in one.reads if isinstance(read, Cell)}
        for name in _NAME.findall(one.text):
            found = one.scope.find(name)
            if (found[0] if found else None) is not cells.get(name):
                raise PatchRefused(f'"{name}" may mean something else later')
        for read in one.reads:
            if isinstance(read, YamlReads):
                self._read_later(read.path, first, reader)
            elif _is_read_between(read, first, reader, one):
                raise PatchRefused("a property inside is read in between")

    def _read_later(self, file: str, first: Record, reader: Record) -> None:
        """A file is read first when `reader` comes by: none other may come in between."""
        began = self._asked_at[file]
        if any(began <= at < reader.order for one, at in self._asked_at.items() if one != file):
            raise PatchRefused("files would be read in another order")
        self._asked_at[file] = reader.order - 1


def _order(record: Record) -> float:
    return record.order


def _triggered(record: Record) -> Iterator[tuple[Cell, Record]]:
    """Yield the properties that a record was the first to read."""
    for read in dict.fromkeys(record.reads):
        if isinstance(read, Cell) and read.record is not None and read.record.trigger is record:
            yield read, read.record


def _around(record: Record) -> Iterator[Record]:
    """Yield the evaluations within which a record was evaluated."""
    while record.trigger is not None:
        record = record.trigger
        yield record


def _with_nested(record: Record) -> Iterator[Record]:
    """Yield a record behind those that it was the first to read."""
    for _, nested in _triggered(record):
        yield from _with_nested(nested)
    yield record


def _is_read_between(read: Readable, first: Record, reader: Record, by: Record) -> bool:
    """Whether a lazily evaluated property inside would find an earlier first reader."""
    if not isinstance(read, Cell) or read.record is None or read.record.trigger is not by:
        return False
    return any(one is not by and one.order < reader.order for one in read.readers)
