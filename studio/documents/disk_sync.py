"""The files of a document as others write them: read again, merged, and collisions resolved."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Final

from studio.description.editing.sources import FileChange
from studio.description.editing.undo import Change
from studio.errors import EditError
from studio.problems import Fix, Place, Problem, Severity
from studio.protocol.commands import Commands, OnCopies, Scope
from studio.protocol.roles import Role
from studio.protocol.saving import (
    Collisions,
    CollisionView,
    DiskMerged,
    GetCollisions,
    Reload,
    ResolveCollisions,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.description.editing.merging import Merge
    from studio.description.editing.merging import Place as MergePlace
    from studio.description.values import Edit
    from studio.documents.edits import Edits
    from studio.documents.findings import Findings
    from studio.documents.runs import Runs
    from studio.documents.workspace import Workspace
    from studio.protocol.listeners import Audience

_SHOWN: Final = 50
"""Collisions shown of one file: nobody reads more."""
_SHOWN_BYTES: Final = 4000


class DiskSync:
    """Takes over what others write into the files, and has collisions resolved."""

    def __init__(
        self,
        workspace: Workspace,
        runs: Runs,
        edits: Edits,
        findings: Findings,
        audience: Audience,
    ) -> None:
        self._workspace, self._sources, self._runs = workspace, workspace.sources, runs
        self._edits, self._findings, self._audience = edits, findings, audience
        self._gone: set[str] = set()

    async def changed(self, files: set[str]) -> None:
        """Read again those of these files that are the document's, and run with what is new."""
        last = self._runs.last
        ours = files & {*last.files, *self._sources.files, *self._sources.conflicts}
        edits = self.refresh(sorted(ours))
        self._edits.disk_changed()
        if edits:
            await self._edits.follow(Change("", edits))
        elif last.failed and files - ours:
            await self._edits.timed(self._runs.reload(()))

    def refresh(self, files: Iterable[str]) -> tuple[Edit, ...]:
        """Take over what changed on disk where it can be; the edits that did it, in order."""
        found = {file: self._sources.refresh(file) for file in files}
        self._gone -= found.keys()
        self._gone |= {file for file, change in found.items() if change.what is FileChange.GONE}
        self._report()
        for file, change in found.items():
            if change.what is FileChange.MERGED:
                self._audience.send(DiskMerged(file=file, kept=change.kept))
        return tuple(edit for change in found.values() for edit in change.edits)

    async def reload(self, role: Role = Role.PRESENTER) -> None:
        """Take the disk's text of every file; undo brings unsaved edits back.

        Raises:
            NotAllowedError: One with unsaved edits is a program, which is a presenter's alone.
        """
        sources = self._sources
        self._workspace.check_role(sources.unsaved_files, role)
        edits = [edit for file in sources.files if (edit := sources.reload(file))]
        self._findings.replace("disk", ())
        await self._edits.follow_disk(edits)

    async def discard(self, arguments: Mapping[str, str]) -> None:
        """Pass these arguments and no others, and take the disk's text of every file."""
        sources, now = self._sources, self._sources.arguments
        if now != arguments:
            values = {one: arguments.get(one) for one in now.keys() | arguments.keys()}
            sources.set_arguments(values, "Discard the restored arguments")
            await self._edits.follow(Change("", arguments=sources.arguments))
        await self.reload()

    async def resolve(self, command: ResolveCollisions, role: Role = Role.PRESENTER) -> None:
        """Choose whose text stands where edits collide with a change on disk.

        Raises:
            EditError: They do not collide, or elsewhere than in the command.
            NotAllowedError: It is a program, which is a presenter's alone.
        """
        file = self._name(command.file)
        self._workspace.check_role([file], role)
        if command.state and command.state != _state(self._sources.collisions(file)):
            raise EditError(f"{command.file} was changed meanwhile: compare it again.")
        edits = self._sources.resolve(file, command.keep, command.each)
        self._report()
        await self._edits.follow_disk(edits)

    def collisions(self, command: GetCollisions) -> Collisions:
        """Return where a file's unsaved edits collide with changes on disk.

        Raises:
            EditError: There are none.
        """
        file = self._name(command.file)
        merged = self._sources.collisions(file)
        views = tuple(_view(merged, place) for place in merged.collisions[:_SHOWN])
        count = len(merged.collisions)
        return Collisions(
            request=command.request, file=file, places=views, count=count, state=_state(merged)
        )

    def report_watch(self, trouble: str) -> None:
        """Report that the system does not watch the files, and why; empty: that it does."""
        self._findings.replace("watch", [not_watched(trouble)] if trouble else ())

    def _report(self) -> None:
        """Report which files are gone, and which wait for a choice."""
        gone = [file_gone(file) for file in sorted(self._gone)]
        waiting = [changed_on_disk(file) for file in sorted(self._sources.conflicts)]
        self._findings.replace("disk", (*gone, *waiting))

    def _name(self, file: str) -> str:
        return str(self._workspace.served.resolve(file))


COMMANDS: Final = Commands[DiskSync](Scope.DOCUMENT)
COMMANDS.controller(GetCollisions, lambda disk, c, _: disk.collisions(c))
COMMANDS.controller(
    ResolveCollisions, lambda disk, c, who: disk.resolve(c, who.role), on_copies=OnCopies.REFUSED
)
COMMANDS.controller(
    Reload, lambda disk, _, who: disk.reload(who.role), on_copies=OnCopies.REFUSED, reviews=True
)


def changed_on_disk(file: str) -> Problem:
    """Another program wrote a file in the very places that have unsaved edits here."""
    sentence = (
        "This file was changed on disk where it has unsaved edits: "
        "choose whose text stands (undo brings the other back)."
    )
    fix = Fix("Compare and choose", "resolve_collisions", file)
    return Problem(Severity.WARNING, "changed-on-disk", sentence, Place(file), fix=fix)


def file_gone(file: str) -> Problem:
    """A file was deleted, or can no longer be read."""
    sentence = "This file can no longer be read from disk; its last text is kept here."
    return Problem(Severity.WARNING, "file-gone", sentence, Place(file))


def not_watched(reason: str) -> Problem:
    """The system has no watch left, or no file handle for one."""
    sentence = (
        f"The system does not watch the files of this robot ({reason.rstrip('. ')}), so what other "
        "programs write is seen only every two seconds: close programs that watch many files, or "
        "raise fs.inotify.max_user_instances."
    )
    return Problem(Severity.WARNING, "not-watched", sentence)


def _state(merged: Merge) -> str:
    """Other collisions, another name."""
    return hashlib.sha256(repr(merged.collisions).encode()).hexdigest()[:20]


def _view(merged: Merge, place: MergePlace) -> CollisionView:
    """Return a collision in whole lines, so that one sees what stands around it."""
    base = merged.base
    start = base.rfind(b"\n", 0, place.start) + 1
    end = base.find(b"\n", place.end)
    before = base[start : place.start]
    after = base[place.end : len(base) if end < 0 else end]
    return CollisionView(
        line=base.count(b"\n", 0, start) + 1,
        base=_text(before + base[place.start : place.end] + after),
        mine=_text(before + place.mine + after),
        theirs=_text(before + place.theirs + after),
    )


def _text(data: bytes) -> str:
    shown = data[:_SHOWN_BYTES].decode("utf-8", "replace").replace("\r", "")
    return shown if len(data) <= _SHOWN_BYTES else f"{shown} …"
