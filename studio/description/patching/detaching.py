"""What follows when a text is no expression any more: it reads nothing, so others read it first.

A property is evaluated when its first reader asks. When that reader is gone, the next one asks: a
moment later, and the value is the same only if its names still mean the same then. If nobody else
reads it, it is not evaluated at all.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from studio.description.evaluator.graph import Record, behind
from studio.description.evaluator.run_record import YamlReads
from studio.description.evaluator.scopes import Cell
from studio.description.patching.replay import PatchRefused

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.evaluator.graph import Readable
    from studio.description.patching.propagation import Propagation

_COMPARES: Final = re.compile(r"[=<>]|\bin\b")
_NAME: Final = re.compile(r"[A-Za-z_]\w*")


class Detaching:
    """Takes evaluations out of a graph; `unlinked` are those whose readers became other ones."""

    def __init__(self, propagation: Propagation, asked_at: dict[str, float]) -> None:
        self._propagation, self._asked_at = propagation, asked_at
        self.unlinked: dict[Readable, None] = {}

    def detach(self, record: Record) -> None:
        """Undo that a text was evaluated.

        Raises:
            PatchRefused: Only a full run can tell what follows.
        """
        if record.is_noisy or _COMPARES.search(record.text):
            raise PatchRefused(f"{record.text!r} says more than its value")
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
            raise PatchRefused("the order of evaluation cannot be told")
        if any(cell in around.reads for around in _around(reader)):
            raise PatchRefused("who reads it next cannot be told")
        moved = list(_with_nested(evaluated))
        for one in moved:
            self._check_meaning(one, evaluated, reader)
        evaluated.trigger = reader
        for number, one in enumerate(moved, 1):
            one.order = reader.order - 1 + number / (len(moved) + 1)
        for read in dict.fromkeys(read for one in moved for read in one.reads):
            read.readers.sort(key=_order)

    def _check_meaning(self, one: Record, first: Record, reader: Record) -> None:
        """See that a text comes to the same when `reader` reads it.

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
    """The properties that a record was the first to read."""
    for read in dict.fromkeys(record.reads):
        if isinstance(read, Cell) and read.record is not None and read.record.trigger is record:
            yield read, read.record


def _around(record: Record) -> Iterator[Record]:
    """The evaluations within which a record was evaluated."""
    while record.trigger is not None:
        record = record.trigger
        yield record


def _with_nested(record: Record) -> Iterator[Record]:
    """A record behind those that it was the first to read."""
    for _, nested in _triggered(record):
        yield from _with_nested(nested)
    yield record


def _is_read_between(read: Readable, first: Record, reader: Record, by: Record) -> bool:
    """Whether a lazily evaluated property inside would find an earlier first reader."""
    if not isinstance(read, Cell) or read.record is None or read.record.trigger is not by:
        return False
    return any(one is not by and one.order < reader.order for one in read.readers)
