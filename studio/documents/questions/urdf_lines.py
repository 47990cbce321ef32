"""A URDF as lines, part by part, and what differs between two: fast also for large robots."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import TYPE_CHECKING, Final
from xml.etree import ElementTree

from studio.description.editing.line_diff import DiffLine, LineDiff, line_diff
from studio.robot.urdf_text import part_element

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from studio.description.values import Part

LINES_SHOWN: Final = 4_000
_AROUND: Final = 3
_PART_LINES: Final = 2_000
"""A part of more lines that differ is shown whole, old and new."""


@dataclass(frozen=True, slots=True)
class PartLines:
    """The lines of one part, indented as in the whole."""

    key: str
    lines: tuple[str, ...]


def part_lines(
    root_attributes: Iterable[tuple[str, str]], parts: Iterable[Part]
) -> list[PartLines]:
    """A robot's lines as `Model.urdf` writes them; the first and the last part are its own tags."""
    root = ElementTree.Element("robot", dict(root_attributes))
    root.text = "\n"
    opening, _, _ = ElementTree.tostring(root, encoding="unicode").partition("\n")
    return [
        PartLines("<robot>", ('<?xml version="1.0" ?>', opening)),
        *(PartLines(part.key, _lines(part, root.attrib)) for part in parts),
        PartLines("</robot>", ("</robot>",)),
    ]


def _lines(part: Part, root_attributes: Mapping[str, str]) -> tuple[str, ...]:
    element = part_element(part, root_attributes)
    ElementTree.indent(element)
    text = ElementTree.tostring(element, encoding="unicode").rstrip()
    return tuple(f"  {line}" for line in text.split("\n"))


def difference(before: Sequence[PartLines], after: Sequence[PartLines]) -> LineDiff:
    """Compare two robots."""
    return line_diff(list(_hunks(list(_compared(before, after)))), LINES_SHOWN)


def _compared(before: Sequence[PartLines], after: Sequence[PartLines]) -> Iterator[DiffLine]:
    """All lines of both; parts are told by their keys, then line by line."""
    keys = [part.key for part in before], [part.key for part in after]
    numbers = _Numbers()
    for tag, i, j, k, m in SequenceMatcher(None, *keys, autojunk=False).get_opcodes():
        if tag == "equal":
            for old, new in zip(before[i:j], after[k:m], strict=True):
                yield from numbers.part(old.lines, new.lines)
        else:
            yield from numbers.gone(line for part in before[i:j] for line in part.lines)
            yield from numbers.come(line for part in after[k:m] for line in part.lines)


class _Numbers:
    """Counts the lines of both texts."""

    def __init__(self) -> None:
        self._before = self._after = 0

    def part(self, old: Sequence[str], new: Sequence[str]) -> Iterator[DiffLine]:
        """The lines of a part that both have."""
        if old == new:
            yield from self.same(new)
            return
        if max(len(old), len(new)) > _PART_LINES:
            yield from (*self.gone(old), *self.come(new))
            return
        for tag, i, j, k, m in SequenceMatcher(None, old, new, autojunk=False).get_opcodes():
            if tag == "equal":
                yield from self.same(new[k:m])
            else:
                yield from (*self.gone(old[i:j]), *self.come(new[k:m]))

    def same(self, lines: Iterable[str]) -> Iterator[DiffLine]:
        """Lines of both."""
        for text in lines:
            self._before += 1
            self._after += 1
            yield DiffLine("same", self._before, self._after, text)

    def gone(self, lines: Iterable[str]) -> Iterator[DiffLine]:
        """Lines of the text before only."""
        for text in lines:
            self._before += 1
            yield DiffLine("old", self._before, None, text)

    def come(self, lines: Iterable[str]) -> Iterator[DiffLine]:
        """Lines of the text after only."""
        for text in lines:
            self._after += 1
            yield DiffLine("new", None, self._after, text)


def _hunks(lines: Sequence[DiffLine]) -> Iterator[tuple[DiffLine, ...]]:
    """The lines that differ with those around them, what nearly touches in one."""
    differing = [at for at, line in enumerate(lines) if line.kind != "same"]
    start = end = -1
    for at in differing:
        if start >= 0 and at - _AROUND > end:
            yield tuple(lines[start:end])
            start = -1
        if start < 0:
            start = max(0, at - _AROUND)
        end = at + _AROUND + 1
    if start >= 0:
        yield tuple(lines[start:end])
