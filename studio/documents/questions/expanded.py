"""What the unsaved edits make of the URDF: the files on disk are run beside, off the edit path."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.description.editing.line_diff import LineDiff
from studio.description.values import Expansion, OpenRequest
from studio.documents.questions.urdf_lines import PartLines, difference, part_lines
from studio.errors import CommandError
from studio.protocol.texts import GetUrdfChanges, Urdf, UrdfChanges, hunk_views

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.description.client import DescriptionWorker
    from studio.description.values import Part
    from studio.documents.document import Document
    from studio.protocol.texts import GetUrdf


@dataclass(frozen=True, slots=True)
class _Saved:
    """What the files on disk came to, and which bytes of them it was."""

    of: dict[str, bytes]
    lines: list[PartLines]
    fault: str = ""


class ExpandedDesk:
    """Compares the URDF of now with the one that the files make, opened as the document was.

    Args:
        document: Whose edits they are.
        take_worker: Gives an xacro worker; it is ended when the files are run.
    """

    def __init__(self, document: Document, take_worker: Callable[[], DescriptionWorker]) -> None:
        self._document, self._take_worker = document, take_worker
        self._arguments = document.sources.arguments
        self._saved: _Saved | None = None
        self._turn = asyncio.Lock()

    async def urdf(self, command: GetUrdf) -> Urdf:
        """The URDF as it is now.

        Raises:
            CommandError: There is none yet.
        """
        return Urdf(request=command.request, text=await self._document.urdf())

    async def changes(self, command: GetUrdfChanges) -> UrdfChanges:
        """What differs now.

        Raises:
            CommandError: The document has no URDF yet.
        """
        document = self._document
        expansion = document.expansion
        if expansion is None:
            raise CommandError(f"{document.title} has not been expanded yet: mend its problems.")
        if not document.sources.unsaved_files and document.sources.arguments == self._arguments:
            return _told(command.request, LineDiff())
        async with self._turn:  # who asks meanwhile finds it done
            saved = await self._run_saved()
        if saved.fault:
            return _told(command.request, LineDiff(), saved.fault)
        root, parts = expansion.root_attributes, tuple(document.model.assembly.parts())
        found = await asyncio.to_thread(_compare, saved.lines, root, parts)
        return _told(command.request, found)

    async def _run_saved(self) -> _Saved:
        sources = self._document.sources
        texts = {file: sources.saved(file) for file in sources.files}
        if self._saved is not None and self._saved.of == texts:
            return self._saved
        target = self._document.target
        worker = self._take_worker()
        try:
            answer = await worker.open(
                OpenRequest(target.entry, self._arguments, target.policy, texts)
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


def _ordered(parts: Iterable[Part], expansion: Expansion) -> list[Part]:
    by_key = {part.key: part for part in parts}
    return [by_key[key] for key in expansion.part_order or by_key]


def _compare(
    before: list[PartLines], root: Iterable[tuple[str, str]], parts: Iterable[Part]
) -> LineDiff:
    return difference(before, part_lines(root, parts))


def _told(request: int, found: LineDiff, fault: str = "") -> UrdfChanges:
    return UrdfChanges(
        request=request,
        added=found.added,
        removed=found.removed,
        hunks=hunk_views(found),
        left_out=found.left_out,
        fault=fault,
    )
