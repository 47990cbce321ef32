"""Who reads what: each text that a run evaluated, what it read, and what it made.

A `Record` is one evaluation of one text. `reads` are the things that it asked for, in order: cells
(bindings of a name in a scope), arguments, YAML values and YAML files; each of these keeps its
`readers`. So the graph can be walked both ways:

- From an attribute that came out back to the source: `element.makers[name]` is the record whose
  text made it; no entry means that it stands in the source as it came out. Each `Cell` among its
  `reads` has a `binding` (where it is written: element, attribute, text), and a `record` when its
  text was evaluated, whose `reads` lead on. `behind` walks that way.
- From a text of the source to what it shapes: `Binding.holders` are the cells (or the argument)
  that it was bound to, once per macro call; their `readers` lead to records, a record with a cell
  or an argument for `sink` to the readers of that; the records whose `sink` is a list of elements
  are attributes that came out (`consumer[1]` is the name).

A block that is evaluated again shares the records of its first evaluation, so one record may have
made the same attribute of several elements; some of them may not have come out.
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.evaluator.output_tree import OutputElement
    from studio.description.evaluator.scopes import Cell, Scope
    from studio.description.evaluator.texts import Argument
    from studio.description.syntax.source_tree import SourceText

Consumer: TypeAlias = tuple[str, str]
"""An attribute that came out: (`link/visual/geometry/cylinder`, `radius`). A condition of
`xacro:if` is (`xacro:if`, `value`), the text of an element has the attribute ``."""


class Role(Enum):
    """What a text is for that makes neither output nor a binding."""

    CONDITION = "condition"
    """Whether something comes out at all."""
    STRUCTURE = "structure"
    """A name, a file, a flag: what it comes to decides what is evaluated next."""
    NOTHING = "nothing"
    """xacro evaluates it and leaves the value lying; it can still fail."""


class Readable:
    """Anything that an evaluated text can ask for."""

    __slots__ = ("readers",)

    def __init__(self) -> None:
        self.readers: list[Record] = []
        """Who read it, once per read, in the order in which their evaluations ended."""


class Record:
    """One evaluation of one text in one scope, as it was in the run.

    `order` counts evaluations as they end, so whatever a record read has a lower one.
    """

    __slots__ = (
        "consumer",
        "file",
        "forwards",
        "is_noisy",
        "order",
        "reads",
        "scope",
        "sink",
        "text",
        "trigger",
        "value",
    )

    def __init__(
        self, text: str, scope: Scope, file: str, sink: Sink, consumer: Consumer | None
    ) -> None:
        self.text, self.scope, self.file = text, scope, file
        self.sink, self.consumer = sink, consumer
        self.reads: list[Readable] = []
        self.order: float = 0
        self.value: Any = None
        """What it came to: of an attribute or a text as it is printed, else as evaluated."""
        self.trigger: Record | None = None
        """Of a property: the first reader, within whose evaluation this one took place."""
        self.forwards = False
        """`text` is a name that is passed on as it is (`:=^`)."""
        self.is_noisy = False
        """It did more than come to a value: a warning, say."""

    @property
    def counts(self) -> bool:
        """Whether it uses what it reads."""
        return self.sink is not Role.NOTHING

    @property
    def made(self) -> Cell | Argument | None:
        """What it was bound to, when it is the text of a property, parameter or arg."""
        sink = self.sink
        if isinstance(sink, Readable):
            return sink  # pyright: ignore[reportReturnType] - the only readable sinks
        return None

    def __repr__(self) -> str:
        return f"{self.order}: {self.text!r} = {self.value!r}"


Sink: TypeAlias = "Cell | Argument | SourceText | list[OutputElement] | Role"
"""What an evaluated text is for: a binding, the text of an element, an attribute of elements."""


def behind(start: Record) -> Iterator[Readable]:
    """All that a record was made from, the nearest first, each once."""
    seen: set[Readable] = set()
    front = list(start.reads)
    while front:
        found = [one for one in dict.fromkeys(front) if one not in seen]
        seen.update(found)
        yield from found
        front = [read for one in found for read in _reads_behind(one)]


def _reads_behind(one: Readable) -> list[Readable]:
    record: Record | None = getattr(one, "record", None)
    return record.reads if record is not None else []
