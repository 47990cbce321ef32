"""The edits of a document: made in its sources, run, timed, and taken back."""

from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING, Final, Protocol

from studio.description.editing.undo import Change
from studio.errors import CommandError
from studio.protocol.commands import Commands, OnCopies, Scope
from studio.protocol.documents import SetArgument, SetArguments
from studio.protocol.edits import Built, EditSite, History, Redo, ResetSite, Undo
from studio.protocol.roles import Role
from studio.protocol.saving import UndoTo

if TYPE_CHECKING:
    from collections.abc import Awaitable, Mapping, Sequence

    from studio.description.editing.sources import Sources
    from studio.description.values import Edit
    from studio.documents.runs import Runs
    from studio.documents.sites import SiteTable
    from studio.documents.workspace import Workspace
    from studio.protocol.listeners import Audience

TEXT_LIMIT_BYTES: Final = 4 << 20
"""More than any robot description needs, and no trouble for an editor in a browser."""
READ_ONLY: Final = "it lies where the studio may only read."
PROGRAM: Final = (
    "it is a program, and who edits it could have it run: start the studio with --allow-run "
    "{folder}."
)
_NOT_READ: Final = (".py", ".msg", ".srv", ".action", ".cfg", ".toml", ".txt", ".md", ".rst")
"""Endings of texts that xacro reads nothing from, unless it was seen to."""
_SHOWN_WITHIN_S: Final = 0.05
"""An edit is shown before it is written down, but for a run that takes longer."""


class EditObserver(Protocol):
    """Is called when the sources have changed."""

    def value_edited(self) -> None:
        """A value was written that no run has shown for a while."""
        ...

    def texts_changed(self) -> None:
        """Texts, or what the disk has of them, are other ones."""
        ...

    def arguments_changed(self) -> None:
        """Other arguments are passed."""
        ...


class Edits:
    """Makes edits of values and arguments, and undoes steps; each returns when the result shows.

    Args:
        workspace: The texts and arguments.
        runs: Runs them.
        sites: The sites in the texts.
        audience: Is sent the duration of each run.
        observer: Called when the sources have changed.
    """

    def __init__(
        self,
        workspace: Workspace,
        runs: Runs,
        sites: SiteTable,
        audience: Audience,
        observer: EditObserver,
    ) -> None:
        self._workspace, self._sources = workspace, workspace.sources
        self._runs, self._sites, self._audience = runs, sites, audience
        self._observer = observer

    async def edit_site(self, site: str, text: str, gesture: str) -> None:
        """Write a new text at a site and show what it does."""
        edit = self._sources.edit_site(site, text, gesture)
        edited = self._observer.value_edited
        late = asyncio.get_running_loop().call_later(_SHOWN_WITHIN_S, edited)
        try:
            await self.timed(self._runs.edit((edit,), in_gesture=bool(gesture)))
        except Exception:
            edited()
            raise
        finally:
            late.cancel()

    async def reset_site(self, site: str) -> None:
        """Put a site back to its text on disk."""
        if edit := self._sources.reset_site(site):
            await self.timed(self._runs.edit((edit,)))

    async def undo(self, role: Role = Role.PRESENTER) -> None:
        """Take the last step back.

        Raises:
            NotAllowedError: It edited a program, which is a presenter's alone.
        """
        self._check_steps(len(self._sources.undo_labels) - 1, role)
        await self.follow(self._sources.undo())

    async def redo(self, role: Role = Role.PRESENTER) -> None:
        """Do the step last taken back again; errors as `undo`."""
        self._check_steps(len(self._sources.undo_labels) + 1, role)
        await self.follow(self._sources.redo())

    async def undo_to(self, command: UndoTo, role: Role = Role.PRESENTER) -> None:
        """Undo or redo until that many steps are done.

        Raises:
            CommandError: The list is another one by now.
            NotAllowedError: A step between edited a program, which is a presenter's alone.
        """
        count = len(self._sources.undo_labels) + len(self._sources.redo_labels)
        if command.of != count or command.position > count:
            raise CommandError("The undo list changed meanwhile: choose the step again.")
        self._check_steps(command.position, role)
        await self.follow(self._sources.undo_to(command.position))

    def _check_steps(self, position: int, role: Role) -> None:
        self._workspace.check_role(self._sources.files_of_steps(position), role)

    async def pass_arguments(self, values: Mapping[str, str | None]) -> None:
        """Pass or take back arguments as one step; with arguments that break it, none is made.

        Raises:
            CommandError: The robot cannot be made with them; it is as before.
        """
        sources, last = self._sources, self._runs.last
        before, was_failed = sources.kept(), last.failed
        label = "Arguments" if len(values) > 1 else next(iter(values))
        sources.set_arguments(values, label)
        await self.follow(Change(label, arguments=sources.arguments))
        if was_failed or not last.failed:
            return
        sentence = last.failure
        if given_up := sources.give_up(before):
            await self.follow(given_up)
            raise CommandError(f"{sentence} The arguments are as they were.")

    async def follow(self, change: Change | None) -> None:
        """Run what a step has changed in the sources; None changes nothing."""
        if change is None:
            return
        if change.arguments is None:
            await self.timed(self._run(change.edits))
        elif change.edits:  # both wait for the same run
            await asyncio.gather(self._run(change.edits), self._run_arguments())
        else:
            await self._run_arguments()

    async def follow_disk(self, edits: Sequence[Edit]) -> None:
        """Run edits that came from the disk, after which any site may compare otherwise."""
        self._sites.invalidate()
        await self.follow(Change("", tuple(edits)))

    async def run(self, edits: Sequence[Edit], *, in_gesture: bool = False) -> None:
        """Run with edits of texts that the sources already hold; of a gesture more will come."""
        self._observer.texts_changed()
        await self.timed(self._run(edits, in_gesture=in_gesture))

    def disk_changed(self) -> None:
        """Send what differs after files were read again, or written."""
        self._sites.invalidate()
        self._observer.texts_changed()

    async def timed(self, run: Awaitable[None]) -> None:
        """Wait for a run, and report the time from the edit to the scene."""
        began_s = time.perf_counter()
        await run
        took_ms = (time.perf_counter() - began_s) * 1000
        self._audience.send(Built(ok=not self._runs.last.failed, duration_ms=took_ms))

    async def _run(self, edits: Sequence[Edit], *, in_gesture: bool = False) -> None:
        files = {edit.file for edit in edits}
        unread = files - set(self._runs.last.files)
        if files == unread and all(one.endswith(_NOT_READ) for one in files):
            return  # no robot is made of such a file
        if not unread:
            await self._runs.edit(edits, in_gesture=in_gesture)
        else:  # the worker holds no text of what the last run did not read
            await self._runs.reload(files)

    async def _run_arguments(self) -> None:
        self._sites.invalidate()
        self._observer.arguments_changed()
        await self.timed(self._runs.arguments_changed())


COMMANDS: Final = Commands[Edits](Scope.DOCUMENT)
COMMANDS.controller(
    EditSite,
    lambda edits, c, _: edits.edit_site(c.site, c.text, c.gesture),
    on_copies=OnCopies.WITHIN_ROOM,
)
COMMANDS.controller(ResetSite, lambda edits, c, _: edits.reset_site(c.site))
COMMANDS.controller(SetArgument, lambda edits, c, _: edits.pass_arguments({c.name: c.value}))
COMMANDS.controller(SetArguments, lambda edits, c, _: edits.pass_arguments(c.values))
COMMANDS.controller(Undo, lambda edits, _, who: edits.undo(who.role))
COMMANDS.controller(Redo, lambda edits, _, who: edits.redo(who.role))
COMMANDS.controller(UndoTo, lambda edits, c, who: edits.undo_to(c, who.role))


def history_event(sources: Sources) -> History:
    """Return the steps that can be undone and redone, and what is unsaved."""
    return History(
        undo=sources.undo_labels,
        redo=sources.redo_labels,
        unsaved_files=sources.unsaved_files,
        unsaved_count=sources.unsaved_count,
    )
