"""Mends what is found wrong with a document: its fixes' edits, as steps that undo takes back."""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING

from studio.description.editing.edits import apart, edits_of
from studio.description.editing.sources import Change
from studio.documents.questions.texts import TEXT_LIMIT_BYTES
from studio.errors import CommandError, EditError, ReadOnlyTextError
from studio.problems import Severity

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from studio.documents.document import Document
    from studio.problems import Fix, Problem, Replacement

_MEND_ALL = "Mend all"


class MendingDesk:
    """Carries out fixes whose action is `edit`; the others are the page's."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._mended = count(1)

    async def apply(self, code: str, sentence: str, label: str) -> None:
        """Mend one problem, and show what that does.

        Raises:
            CommandError: It is no longer found, or its fix is no edit.
            StaleTextError: The text is another one by now.
            ReadOnlyTextError: A file may not be written.
        """
        for problem in self._document.board.found:
            fix = problem.fix
            if (problem.code, problem.sentence) == (code, sentence) and fix and fix.label == label:
                if not fix.edits:
                    break
                await self._edit(fix.edits, label)
                return
        raise CommandError("This problem is no longer found: look at the list again.")

    async def apply_all(self) -> None:
        """Mend every error and warning that an edit mends, in one step.

        Raises:
            CommandError: There is none.
            StaleTextError: The text is another one by now.
        """
        fixes = [fix.edits for fix in _fixes(self._document.board.found)]
        if not fixes:
            raise CommandError("Nothing that is found has a fix: mend it in the source.")
        await self._edit(apart(fixes), _MEND_ALL)

    async def _edit(self, replacements: Sequence[Replacement], label: str) -> None:
        sources, served = self._document.sources, self._document.location.served
        for file in {one.file for one in replacements}:
            if not served.may_write(file):
                raise ReadOnlyTextError(file, "it lies where the studio may only read.")
        edits = edits_of(replacements, sources.text)
        for edit in edits:
            if len(sources.text(edit.file)) + len(edit.new) > TEXT_LIMIT_BYTES:
                raise EditError(f"{edit.file} would grow too large: mend it by hand.")
        sources.edit_all(edits, label, f"fix {next(self._mended)}")
        await self._document.follow(Change(label, edits))


def _fixes(problems: Sequence[Problem]) -> Iterator[Fix]:
    """The fixes that are edits, of what hinders; several problems may share one."""
    fixes = (one.fix for one in problems if one.severity is not Severity.INFO)
    yield from dict.fromkeys(fix for fix in fixes if fix and fix.edits)
