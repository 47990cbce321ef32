"""The texts of an open document as the disk has them and as they are edited, with undo and saving.

The main process's truth about the files; the worker holds a copy that follows the same edits. Pure:
it reads and writes files when asked, and waits for nothing.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum, auto
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

from studio.description.editing.edits import apply_to, decode, difference, edit_at
from studio.description.editing.merging import hunks_between, merge
from studio.description.editing.saving import FileToSave, save_files
from studio.description.editing.spans import ChangedRegions, SpanTable
from studio.description.editing.undo import (
    ArgumentChange,
    Change,
    KeptSources,
    KeptText,
    Splice,
    Step,
    UndoStack,
)
from studio.description.values import Edit
from studio.errors import EditError, PackageError, ReadOnlyTextError

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

    from studio.description.editing.merging import Merge, Side
    from studio.description.values import Expansion, Span


class HeldText:
    """A file's bytes with the edits that the disk does not have."""

    __slots__ = ("disk", "file", "now", "regions")

    def __init__(self, file: str, disk: bytes) -> None:
        self.file, self.disk, self.now = file, disk, disk
        self.regions = ChangedRegions(disk)

    def apply(self, edits: Iterable[Edit]) -> tuple[Splice, ...]:
        """Apply edits one after the other and note what differs then; what each one did.

        Raises:
            EditError: An edit lies outside the text; those before it are applied.
        """
        text = bytearray(self.now)
        try:
            return tuple(self._apply(edit, text) for edit in edits)
        finally:
            self.now = bytes(text)

    def saved_at(self, span: Span) -> bytes | None:
        """Return the bytes on disk where `span` is now; None when a reload changed them."""
        base = self.regions.base_span(span)
        return None if base is None else self.disk[base.start : base.end]

    def saved_text(self, span: Span) -> str | None:
        """Return the text on disk where `span` is now, if it differs and can be found."""
        base = self.regions.base_span(span)
        if base is None:
            return None
        is_same = self.disk[base.start : base.end] == self.now[span.start : span.end]
        return None if is_same else decode(self.disk, base)

    def rebased(self, disk: bytes) -> HeldText:
        """Return the same text, with its differences counted against another text of the disk."""
        text = HeldText(self.file, disk)
        text.apply(edits_between(self.file, disk, self.now))
        return text

    def _apply(self, edit: Edit, text: bytearray) -> Splice:
        taken = apply_to(text, edit)
        self.regions.note(edit, text)
        return Splice(edit.file, edit.start, taken, edit.new)


def edits_between(file: str, old: bytes, new: bytes) -> tuple[Edit, ...]:
    """Return the edits between two texts, the last place first: so offsets hold."""
    hunks = reversed(hunks_between(old, new))
    return tuple(Edit(file, hunk.start, hunk.end, hunk.new) for hunk in hunks)


class FileChange(Enum):
    """What another program did to a file."""

    NONE = auto()
    """Nothing: it is as it was read, or as it is edited here."""
    RELOADED = auto()
    """It changed without unsaved edits here: its new text is taken."""
    MERGED = auto()
    """It changed in other places than here: its changes are taken, unsaved edits are kept."""
    CONFLICT = auto()
    """It changed where there are unsaved edits: nothing is taken until the user chooses."""
    GONE = auto()
    """It cannot be read any more; its text here is kept."""


@dataclass(frozen=True, slots=True)
class DiskChange:
    """The change, the edits that took it over (in order), and how many places stay edited."""

    what: FileChange
    edits: tuple[Edit, ...] = ()
    kept: int = 0


class Sources:
    """The files of one document; `spans` answers where its sites stand now.

    Args:
        read: Reads a file below the opened folders, or raises a PackageError.
        resolve: Gives a path's real place below the opened folders, or raises.
        may_write: Whether that place may be written; default: any.
        arguments: The xacro arguments that the document was opened with.
        only_typed: Says why a file is changed in an editor alone; default: none is.
    """

    def __init__(
        self,
        read: Callable[[Path], bytes],
        resolve: Callable[[Path], Path],
        may_write: Callable[[Path], bool] = lambda _: True,
        arguments: Mapping[str, str] | None = None,
        only_typed: Callable[[str], str] = lambda _: "",
    ) -> None:
        self._read, self._resolve, self._may_write = read, resolve, may_write
        self._only_typed = only_typed
        self._texts: dict[str, HeldText] = {}
        self._steps = UndoStack()
        self._arguments = dict(arguments or {})
        self._conflicts: dict[str, bytes] = {}
        """By file, the bytes on disk that collide with unsaved edits."""
        self.spans = SpanTable()

    @property
    def files(self) -> tuple[str, ...]:
        """Every file whose text is held."""
        return tuple(self._texts)

    @property
    def arguments(self) -> dict[str, str]:
        """The arguments as they are now; a copy."""
        return dict(self._arguments)

    @property
    def undo_labels(self) -> tuple[str, ...]:
        """The steps that can be taken back, newest last."""
        return tuple(step.label for step in self._steps.done)

    @property
    def redo_labels(self) -> tuple[str, ...]:
        """The steps that can be done again, newest last."""
        return tuple(step.label for step in self._steps.undone)

    @property
    def unsaved_files(self) -> tuple[str, ...]:
        """Files whose text differs from the disk's as it was read."""
        return tuple(file for file, text in self._texts.items() if text.now != text.disk)

    @property
    def unsaved_count(self) -> int:
        """The number of places that differ, in all files."""
        return sum(len(text.regions) for text in self._texts.values())

    @property
    def conflicts(self) -> frozenset[str]:
        """Files that changed on disk where they have unsaved edits."""
        return frozenset(self._conflicts)

    def files_of_steps(self, count: int) -> frozenset[str]:
        """Return the files that change until `count` steps are done, as `undo_to` does them."""
        done, undone = self._steps.done, self._steps.undone
        between = done[max(0, count) :] or undone[max(0, len(undone) + len(done) - count) :]
        return frozenset(splice.file for step in between for splice in step.splices)

    def since_saved(self) -> tuple[Edit, ...]:
        """Return the edits from the files as saved to the present texts."""
        texts = [self._texts[file] for file in self.unsaved_files]
        return tuple(edit for one in texts for edit in edits_between(one.file, one.disk, one.now))

    def overlay(self) -> dict[str, bytes]:
        """Return the edited texts by file, for a run that starts from the disk."""
        return {file: self._texts[file].now for file in self.unsaved_files}

    def text(self, file: str) -> bytes:
        """Return a file's text as it is now.

        Raises:
            PackageError: It is not held and cannot be read.
        """
        return self._held(file).now

    def saved(self, file: str) -> bytes:
        """Return a file's text as it was last read from the disk or written to it.

        Raises:
            PackageError: It is not held and cannot be read.
        """
        return self._held(file).disk

    def track(self, files: Iterable[str]) -> None:
        """Hold the texts of these files too; one that cannot be read is left out."""
        for file in files:
            try:
                self._held(file)
            except PackageError:
                continue

    def adopt(self, expansion: Expansion, version: int) -> None:
        """Take over a good run: its files and sites, true at that `spans.version`."""
        self.track(expansion.files)
        self.spans.adopt(expansion.changed_sites, expansion.site_order, version)

    def edit(self, edit: Edit, name: str, gesture: str = "", *, is_value: bool = True) -> None:
        """Apply an edit as an undo step called `name`, e.g. `wheel_radius 0.1 → 0.12`.

        Edits of the same gesture are one step, until something else happens. `is_value`: the step
        shows what its bytes were and are.

        Raises:
            ReadOnlyTextError: The file is changed in an editor alone.
            EditError: The edit lies outside the file.
            PackageError: The file cannot be read.
        """
        self._refuse_closed((edit,))
        self._push((edit,), Step(name, gesture=gesture, is_value=is_value))

    def edit_all(self, edits: Iterable[Edit], name: str, gesture: str = "") -> None:
        """Apply edits, each to what those before it left, as one undo step; errors as `edit`."""
        listed = tuple(edits)
        self._refuse_closed(listed)
        self._push(listed, Step(name, gesture=gesture, is_value=False))

    def type_in(self, edit: Edit, name: str, gesture: str = "") -> None:
        """Apply what was typed into an editor, as `edit`; who calls it has asked who may."""
        self._push((edit,), Step(name, gesture=gesture, is_value=False))

    def edit_site(self, site_id: str, text: str, gesture: str = "") -> Edit:
        """Write a new text at a site, quoted and escaped as its place needs it.

        Raises:
            StaleEditError: The site is no longer where the last run saw it.
            EditError: The place cannot hold the text.
        """
        site, span = self.spans.site(site_id), self.spans.span(site_id)
        edit = edit_at(site.place.file, self.text(site.place.file), span, text)
        self.edit(edit, site.name, gesture)
        self.spans.wrote(site_id)
        return edit

    def reset_site(self, site_id: str) -> Edit | None:
        """Put a site back to the bytes that the disk has; None when it has them.

        Raises:
            StaleEditError: The site is no longer where the last run saw it.
            EditError: A reload changed the file around it.
        """
        site, span = self.spans.site(site_id), self.spans.span(site_id)
        text = self._held(site.place.file)
        saved = text.saved_at(span)
        if saved is None:
            raise EditError(f"{site.name} has no saved value any more: edit it instead.")
        if saved == text.now[span.start : span.end]:
            return None
        edit = Edit(site.place.file, span.start, span.end, saved)
        self.edit(edit, site.name)
        return edit

    def saved_text(self, site_id: str) -> str | None:
        """Return the text on disk at a site, if it differs from the text here.

        Raises:
            StaleEditError: The site is no longer where the last run saw it.
        """
        site = self.spans.site(site_id)
        text = self._texts.get(site.place.file)
        if text is None or not len(text.regions):
            return None
        return text.saved_text(self.spans.span(site_id))

    def current_text(self, site_id: str) -> str:
        """Return the present text of a site, whether or not a run has seen it.

        Raises:
            StaleEditError: The site is no longer where the last run saw it.
        """
        site = self.spans.site(site_id)
        return decode(self._held(site.place.file).now, self.spans.span(site_id))

    def set_argument(self, name: str, value: str | None, gesture: str = "") -> None:
        """Pass an argument, or take it back with None; an undo step like any edit."""
        self.set_arguments({name: value}, name, gesture)

    def set_arguments(
        self, values: Mapping[str, str | None], label: str, gesture: str = ""
    ) -> None:
        """Pass several arguments, or take those with None back, as one undo step."""
        old = self._arguments
        changes = [ArgumentChange(one, old.get(one), value) for one, value in values.items()]
        self._put_arguments(values)
        self._steps.push(Step(label, arguments=tuple(changes), gesture=gesture))

    def undo(self) -> Change | None:
        """Take the newest step back; None when there is none."""
        step = self._steps.undo()
        if step is None:
            return None
        edits = tuple(splice.backward() for splice in reversed(step.splices))
        return self._carry_out(step, edits, {one.name: one.old for one in step.arguments})

    def redo(self) -> Change | None:
        """Do the step last taken back again; None when there is none."""
        step = self._steps.redo()
        if step is None:
            return None
        edits = tuple(splice.forward() for splice in step.splices)
        return self._carry_out(step, edits, {one.name: one.new for one in step.arguments})

    def undo_to(self, count: int) -> Change | None:
        """Take steps back, or do them again, until `count` of them are done."""
        change: Change | None = None
        while len(self._steps.done) != count:
            one = self.undo() if len(self._steps.done) > count else self.redo()
            if one is None:
                break
            change = change.then(one) if change else one
        return change

    def kept(self) -> KeptSources:
        """Return what would be lost with the process: unsaved edits, and the undo list."""
        named = self._steps.files()
        texts = (
            KeptText(file, text.disk, text.now)
            for file, text in self._texts.items()
            if text.now != text.disk or file in named
        )
        steps = self._steps
        return KeptSources(tuple(texts), self.arguments, tuple(steps.done), tuple(steps.undone))

    def put(self, kept: KeptSources) -> None:
        """Restore what was kept; `refresh` then takes what changed on disk since."""
        for one in kept.texts:
            self._texts[one.file] = HeldText(one.file, one.now).rebased(one.disk)
        self._arguments = dict(kept.arguments)
        self._steps = UndoStack([*kept.done], [*kept.undone])

    def give_up(self, before: KeptSources) -> Change | None:
        """Take the newest step back as if it had never been; None when it is not the only new one.

        Args:
            before: What `kept` gave before that step.
        """
        if tuple(self._steps.done[:-1]) != before.done or not self._steps.done:
            return None
        change = self.undo()
        self._steps = UndoStack([*before.done], [*before.undone])
        return change

    def save(self, files: Collection[str] | None = None) -> tuple[str, ...]:
        """Write these changed files, or every one, all or none; the files written.

        Raises:
            SaveConflictError: A file on disk is no longer the one that was read.
            NotSavedError: A file cannot be written.
            OutsideRootsError: A file leads out of the opened folders.
        """
        changed = [
            FileToSave(file, self._texts[file].disk, self._texts[file].now)
            for file in self.unsaved_files
            if files is None or file in files
        ]
        self._steps.end_gesture()
        save_files(changed, self._resolve, self._may_write, self._saved)
        return tuple(one.file for one in changed)

    def refresh(self, file: str) -> DiskChange:
        """Read a held file again, after another program may have written it.

        What the disk changed is taken, as a step to take back, and unsaved edits stay unsaved
        against the new text; where both changed the same place nothing is taken.
        """
        text = self._texts.get(file)
        if text is None:
            return DiskChange(FileChange.NONE)
        try:
            disk = self._disk(file)
        except PackageError:
            return DiskChange(FileChange.GONE)
        self._conflicts.pop(file, None)
        merged = merge(text.disk, text.now, disk)
        if merged.collisions:
            self._conflicts[file] = disk
            return DiskChange(FileChange.CONFLICT)
        # A burst of writes is one step.
        step = Step(f"Changed on disk: {Path(file).name}", gesture=f"disk {file}", is_value=False)
        edits = self._become(file, merged.text(), step)
        self._texts[file] = self._held(file).rebased(disk)
        if not edits:
            return DiskChange(FileChange.NONE)
        what = FileChange.MERGED if merged.kept else FileChange.RELOADED
        return DiskChange(what, edits, merged.kept)

    def collisions(self, file: str) -> Merge:
        """Return the unsaved edits and the disk's changes of a file, as they stand now.

        Raises:
            EditError: They do not collide.
        """
        disk, text = self._conflicts.get(file), self._texts.get(file)
        if disk is None or text is None:
            raise EditError(f"{file}: its edits collide with no change on disk any more.")
        return merge(text.disk, text.now, disk)

    def resolve(self, file: str, wins: Side, each: Sequence[Side] = ()) -> tuple[Edit, ...]:
        """Take the disk's changes; where they collide with unsaved edits, the winner's.

        Undo brings back the other one's, and then the text before. `each`: as `Merge.text`.

        Raises:
            EditError: They do not collide.
        """
        merged, name = self.collisions(file), Path(file).name
        taken = Step(f"Take the changes on disk: {name}", is_value=False)
        edits = self._become(file, merged.text("theirs"), taken)
        kept = Step(f"Keep the edits: {name}", is_value=False)
        edits += self._become(file, merged.text(wins, each), kept)
        self._texts[file] = self._held(file).rebased(self._conflicts.pop(file))
        return edits

    def reload(self, file: str) -> Edit | None:
        """Take the disk's text, unsaved edits given up (undo brings them back).

        Returns:
            The edit that does the same to the text before; None when nothing changed.

        Raises:
            PackageError: The file cannot be read; its text here is kept.
        """
        return self._take(file, self._disk(file))

    def _held(self, file: str) -> HeldText:
        text = self._texts.get(file)
        if text is None:
            text = self._texts[file] = HeldText(file, self._disk(file))
        return text

    def _disk(self, file: str) -> bytes:
        return self._read(Path(file))

    def _take(self, file: str, disk: bytes) -> Edit | None:
        """Make the text on disk the base and the text; the edit between is a step to undo."""
        edit = difference(file, self._held(file).now, disk)
        if edit is not None:
            self._push((edit,), Step(f"Reload {Path(file).name}", is_value=False))
        self._texts[file] = HeldText(file, disk)
        self._conflicts.pop(file, None)
        return edit

    def _become(self, file: str, wanted: bytes, step: Step) -> tuple[Edit, ...]:
        """Make a text another one, place by place; the edits that did it, the last place first."""
        edits = edits_between(file, self._held(file).now, wanted)
        if edits:
            self._push(edits, step)
        return edits

    def _refuse_closed(self, edits: Sequence[Edit]) -> None:
        for file in {one.file for one in edits}:
            if reason := self._only_typed(file):
                raise ReadOnlyTextError(file, reason)

    def _push(self, edits: Iterable[Edit], step: Step) -> None:
        self._steps.push(replace(step, splices=tuple(self._apply(edits))))

    def _apply(self, edits: Iterable[Edit]) -> list[Splice]:
        """Apply edits; what each one did."""
        splices: list[Splice] = []
        for file, group in groupby(edits, key=lambda one: one.file):
            splices += self._held(file).apply(edits_of_file := tuple(group))
            self.spans.note(edits_of_file)
        return splices

    def _carry_out(
        self, step: Step, edits: tuple[Edit, ...], arguments: Mapping[str, str | None]
    ) -> Change:
        self._apply(edits)
        if not arguments:
            return Change(step.label, edits)
        self._put_arguments(arguments)
        return Change(step.label, edits, self.arguments)

    def _put_arguments(self, values: Mapping[str, str | None]) -> None:
        now = {**self._arguments, **values}
        self._arguments = {name: value for name, value in now.items() if value is not None}

    def _saved(self, saved: FileToSave) -> None:
        self._texts[saved.file] = HeldText(saved.file, saved.data)
        self._conflicts.pop(saved.file, None)
