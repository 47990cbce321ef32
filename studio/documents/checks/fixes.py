"""The fixes of problems that are edits: of one problem, or of all at once."""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING, Final

from studio.description.editing.edits import apart, edits_of
from studio.description.editing.undo import Change
from studio.documents.edits import READ_ONLY, TEXT_LIMIT_BYTES
from studio.errors import CommandError, EditError, ReadOnlyTextError
from studio.problems import Severity
from studio.protocol.commands import Commands, Scope
from studio.protocol.edits import ApplyFix, MendAll

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from studio.documents.edits import Edits
    from studio.documents.findings import Findings
    from studio.documents.workspace import Workspace
    from studio.problems import Fix, Problem, Replacement

_FIX_ALL: Final = "Mend all"


class Fixes:
    """Makes fixes whose action is `edit`; the others are the page's."""

    def __init__(self, workspace: Workspace, findings: Findings, edits: Edits) -> None:
        self._workspace, self._findings, self._edits = workspace, findings, edits
        self._applied = count(1)

    async def apply(self, code: str, sentence: str, label: str) -> None:
        """Fix one problem, and show what that does.

        Raises:
            CommandError: It is no longer found, or its fix is no edit.
            StaleTextError: The text is another one by now.
            ReadOnlyTextError: A file may not be written.
        """
        for problem in self._findings.all():
            fix = problem.fix
            if (problem.code, problem.sentence) == (code, sentence) and fix and fix.label == label:
                if not fix.edits:
                    break
                await self._edit(fix.edits, label)
                return
        raise CommandError("This problem is no longer found: look at the list again.")

    async def apply_all(self) -> None:
        """Fix every error and warning that an edit fixes, in one step.

        Raises:
            CommandError: There is none.
            StaleTextError: The text is another one by now.
        """
        fixes = [fix.edits for fix in _fixes(self._findings.all())]
        if not fixes:
            raise CommandError("Nothing that is found has a fix: mend it in the source.")
        await self._edit(apart(fixes), _FIX_ALL)

    async def _edit(self, replacements: Sequence[Replacement], label: str) -> None:
        sources, served = self._workspace.sources, self._workspace.served
        for file in {one.file for one in replacements}:
            if not served.may_write(file):
                raise ReadOnlyTextError(file, READ_ONLY)
        edits = edits_of(replacements, sources.text)
        for edit in edits:
            if len(sources.text(edit.file)) + len(edit.new) > TEXT_LIMIT_BYTES:
                raise EditError(f"{edit.file} would grow too large: mend it by hand.")
        sources.edit_all(edits, label, f"fix {next(self._applied)}")
        await self._edits.follow(Change(label, edits))


COMMANDS: Final = Commands[Fixes](Scope.DOCUMENT)
COMMANDS.controller(ApplyFix, lambda fixes, c, _: fixes.apply(c.code, c.sentence, c.label))
COMMANDS.controller(MendAll, lambda fixes, _, __: fixes.apply_all())


def _fixes(problems: Sequence[Problem]) -> Iterator[Fix]:
    """Yield the fixes that are edits, of what hinders; several problems may share one."""
    fixes = (one.fix for one in problems if one.severity is not Severity.INFO)
    yield from dict.fromkeys(fix for fix in fixes if fix and fix.edits)
