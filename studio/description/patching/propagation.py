"""How a change runs through the graph of a run: what depends on it is evaluated once more.

In the order of the run, and no further than values change. What is decided by more than values
(whether something comes out, under which name, from which file) is refused.
"""

from __future__ import annotations

import heapq
from typing import TYPE_CHECKING, Any

from studio.description.evaluator.graph import Role
from studio.description.evaluator.scopes import Cell, literal_value, truth_of
from studio.description.expressions.bounded_values import is_lasting
from studio.description.expressions.guarded_operations import text_of
from studio.description.faults import Fault, Refusal
from studio.description.patching.replay import PatchRefused, is_same
from studio.description.syntax.source_tree import SourceText

if TYPE_CHECKING:
    from studio.description.evaluator.graph import Readable, Record
    from studio.description.evaluator.output_tree import OutputElement
    from studio.description.evaluator.texts import Argument
    from studio.description.patching.output_index import OutputIndex
    from studio.description.patching.replay import Replay


class Propagation:
    """One request's way through the graph."""

    def __init__(self, replay: Replay, index: OutputIndex) -> None:
        self._replay, self._index = replay, index
        self._heap: list[tuple[float, int, Record]] = []
        self._queued: set[Record] = set()
        self.parts: dict[OutputElement, None] = {}
        """Parts that came to be other ones."""
        self.changed: dict[Cell | Argument, None] = {}
        """Whose value is another one."""

    def put(self, holder: Cell | Argument, value: Any) -> None:  # noqa: ANN401
        """Give something named another value, and have its readers look again."""
        if isinstance(holder, Cell):
            value = literal_value(value)
            if not is_lasting(value):
                raise PatchRefused("an iterator is used up by its first reader")
        if not is_same(holder.value, value):
            holder.value = value
            self.changed[holder] = None
            self.touch(holder)

    def touch(self, read: Readable) -> None:
        """Have those who read something look again."""
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
            PatchRefused: Only a full run can tell.
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

    def _write(self, record: Record, elements: list[OutputElement], text: str) -> None:
        if text == record.value:
            return
        if "$" in text or "$" in record.value or record.consumer is None:
            raise PatchRefused("a block's text would be evaluated again")
        record.value = text
        name = record.consumer[1]
        for element in elements:
            if element.makers.get(name) is record:
                self.write(element, name, text)

    def write(self, element: OutputElement, name: str, text: str) -> None:
        """Give an attribute that came out another text.

        Raises:
            PatchRefused: It names a part, or is a namespace.
        """
        if name.startswith("xmlns") or (name == "name" and element in self._index.keys):
            raise PatchRefused(f"{name} is more than a value")
        element.attributes = {**element.attributes, name: text}
        part = self._index.part_of.get(element)
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
