"""A text of a finished run evaluated once more, with what it read as that is now.

Names mean what they meant when the run came by, whatever was defined since. A text that would read
anything else than it did then is refused: only a full run knows what else would follow.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final, cast

from studio.description.evaluator.graph import Record, Role
from studio.description.evaluator.scopes import Cell, Scope
from studio.description.faults import Fault

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from studio.description.evaluator.texts import Texts

_SIMPLE: Final = frozenset({int, str, bool, type(None)})


class PatchRefused(Exception):  # noqa: N818 - no error: the full run does it
    """Only a full run can tell what an edit does; the argument says why."""


class Replay:
    """Evaluates the records of one run again."""

    def __init__(self, texts: Texts) -> None:
        self._texts = texts
        self._scratch = Record("", cast("Scope", texts), "", Role.NOTHING, None)
        """What is read now."""
        self._record = self._scratch

    def going_on(self) -> AbstractContextManager[None]:
        """Within: records may be evaluated `again`."""
        return self._texts.replayed(self)

    def again(self, record: Record) -> Any:  # noqa: ANN401
        """The value of a record's text now; the record stays as it is.

        Raises:
            PatchRefused: It fails, warns, or reads other things than it did.
        """
        if record.is_noisy:
            raise PatchRefused(f"{record.text!r} says more than its value")
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
        """What a name meant at this point of the text, as it is now.

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
        """Give up.

        Raises:
            PatchRefused: Always.
        """
        raise PatchRefused(reason)


def _differ(one: object, other: object) -> bool:
    return one is not other


def is_same(old: Any, new: Any) -> bool:  # noqa: ANN401
    """Whether two values cannot be told apart: by type, as they print, in any expression."""
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
