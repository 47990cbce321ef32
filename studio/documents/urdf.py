"""The URDF of a document, and how its unsaved edits change it, line by line."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import TYPE_CHECKING, Final
from xml.etree import ElementTree

from studio.description.editing.line_diff import DiffLine, LineDiff, line_diff
from studio.description.urdf import part_element, urdf_text
from studio.description.values import Expansion, OpenRequest
from studio.errors import CommandError
from studio.protocol.commands import Commands, Scope
from studio.protocol.texts import GetUrdf, GetUrdfChanges, Urdf, UrdfChanges, hunk_views

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from studio.description.client import DescriptionWorker
    from studio.description.values import Part
    from studio.documents.model import Model
    from studio.documents.runs import LastRun
    from studio.documents.workspace import Workspace


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
    """Return a robot's lines as `Model.urdf` writes them; its own tags are the end parts."""
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
    """Compare parts by their keys, then line by line; yield all lines of both."""
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
        """Yield the lines of a part that both have."""
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
        """Yield lines of both."""
        for text in lines:
            self._before += 1
            self._after += 1
            yield DiffLine("same", self._before, self._after, text)

    def gone(self, lines: Iterable[str]) -> Iterator[DiffLine]:
        """Yield lines of the text before only."""
        for text in lines:
            self._before += 1
            yield DiffLine("old", self._before, None, text)

    def come(self, lines: Iterable[str]) -> Iterator[DiffLine]:
        """Yield lines of the text after only."""
        for text in lines:
            self._after += 1
            yield DiffLine("new", None, self._after, text)


def _hunks(lines: Sequence[DiffLine]) -> Iterator[tuple[DiffLine, ...]]:
    """Yield the lines that differ with those around them, what nearly touches in one."""
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


@dataclass(frozen=True, slots=True)
class _Saved:
    """The URDF of the files on disk, and the bytes it was made from."""

    of: dict[str, bytes]
    lines: list[PartLines]
    fault: str = ""


class UrdfText:
    """Writes the URDF, and compares it with the one that the files on disk make.

    Args:
        workspace: The files, and their texts as they are edited.
        last_run: The last good run.
        model: The robot that it made.
        take_worker: Gives an xacro worker; it is ended when the files are run.
    """

    def __init__(
        self,
        workspace: Workspace,
        last_run: LastRun,
        model: Model,
        take_worker: Callable[[], DescriptionWorker],
    ) -> None:
        self._workspace, self._last_run, self._model = workspace, last_run, model
        self._take_worker = take_worker
        self._arguments = workspace.sources.arguments
        self._saved: _Saved | None = None
        self._turn = asyncio.Lock()

    async def text(self) -> str:
        """Return the expanded URDF of the last good run, written in another thread.

        Raises:
            CommandError: There was none yet.
        """
        expansion, title = self._last_run.expansion, self._workspace.title
        if expansion is None:
            raise CommandError(f"{title} has not been expanded yet: mend its problems first.")
        parts, root = self._model.assembly.parts(), expansion.root_attributes
        return await asyncio.to_thread(urdf_text, parts, root)

    async def answer(self, command: GetUrdf) -> Urdf:
        """Return the URDF as it is now; raises as `text` does."""
        return Urdf(request=command.request, text=await self.text())

    async def changes(self, command: GetUrdfChanges) -> UrdfChanges:
        """Return the present differences.

        Raises:
            CommandError: The document has no URDF yet.
        """
        expansion, sources = self._last_run.expansion, self._workspace.sources
        if expansion is None:
            title = self._workspace.title
            raise CommandError(f"{title} has not been expanded yet: mend its problems.")
        if not sources.unsaved_files and sources.arguments == self._arguments:
            return _changes(command.request, LineDiff())
        async with self._turn:  # who asks meanwhile finds it done
            saved = await self._run_saved()
        if saved.fault:
            return _changes(command.request, LineDiff(), saved.fault)
        root, parts = expansion.root_attributes, tuple(self._model.assembly.parts())
        found = await asyncio.to_thread(_compare, saved.lines, root, parts)
        return _changes(command.request, found)

    async def _run_saved(self) -> _Saved:
        workspace, sources = self._workspace, self._workspace.sources
        texts = {file: sources.saved(file) for file in sources.files}
        if self._saved is not None and self._saved.of == texts:
            return self._saved
        worker = self._take_worker()
        try:
            answer = await worker.open(
                OpenRequest(workspace.path, self._arguments, workspace.policy, texts)
            )
        finally:
            await worker.close()
        if isinstance(answer, Expansion):
            sources.track(answer.files)
            texts |= {file: sources.saved(file) for file in answer.files if file in sources.files}
            lines = await asyncio.to_thread(
                part_lines, answer.root_attributes, _ordered(answer.changed_parts, answer)
            )
            self._saved = _Saved(texts, lines)
        else:
            self._saved = _Saved(texts, [], f"The files on disk do not run: {answer.problem}")
        return self._saved


COMMANDS: Final = Commands[UrdfText](Scope.DOCUMENT)
COMMANDS.viewer(GetUrdf, lambda urdf, c, _: urdf.answer(c), same_for_all=True)
COMMANDS.viewer(GetUrdfChanges, lambda urdf, c, _: urdf.changes(c))


def _ordered(parts: Iterable[Part], expansion: Expansion) -> list[Part]:
    by_key = {part.key: part for part in parts}
    return [by_key[key] for key in expansion.part_order or by_key]


def _compare(
    before: list[PartLines], root: Iterable[tuple[str, str]], parts: Iterable[Part]
) -> LineDiff:
    return difference(before, part_lines(root, parts))


def _changes(request: int, found: LineDiff, fault: str = "") -> UrdfChanges:
    return UrdfChanges(
        request=request,
        added=found.added,
        removed=found.removed,
        hunks=hunk_views(found),
        left_out=found.left_out,
        fault=fault,
    )
