"""Drafts of unsaved work in the data folder: a file for each open document, a journal of saves.

A document holds a lock beside its draft as long as it is open. So two studios that edit the same
file keep a draft each, and what a killed studio left is taken over by the next one.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import msgspec

from studio.description.editing.undo import KeptSources  # noqa: TC001 - msgspec reads it
from studio.errors import DraftError
from studio.files import write_whole
from studio.system import hold_file

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path
    from typing import IO


class PlannedFile(msgspec.Struct, frozen=True):
    """A file of a save: digests of its bytes before and after."""

    file: str
    before: str
    after: str


_PLAN_DECODER: Final = msgspec.json.Decoder(tuple[PlannedFile, ...])


class SaveJournal:
    """A small file that exists during a save, and after one that was interrupted."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def begin(self, files: Iterable[tuple[str, bytes, bytes]]) -> None:
        """Note a save: of each file its name and its bytes before and after.

        Where that cannot be written the save goes on: it is better than its journal.
        """
        plan = [PlannedFile(file, digest(before), digest(after)) for file, before, after in files]
        with contextlib.suppress(OSError, UnicodeEncodeError):
            self._path.write_bytes(msgspec.json.encode(plan))

    def end(self) -> None:
        """The save is over, or what was cut off is mended."""
        with contextlib.suppress(OSError):
            self._path.unlink(missing_ok=True)

    def cut(self, saved: Callable[[str], bytes]) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Return the files that a save wrote, and those that it did not come to.

        Both are empty when none was cut off. `saved` gives what the disk has of a file now; what
        somebody wrote since belongs to neither.
        """
        try:
            plan = _PLAN_DECODER.decode(self._path.read_bytes())
        except (OSError, msgspec.MsgspecError, UnicodeDecodeError):
            return (), ()
        now = {one.file: digest(saved(one.file)) for one in plan}
        written = tuple(one.file for one in plan if now[one.file] == one.after)
        missed = tuple(one.file for one in plan if now[one.file] == one.before)
        return (written, missed) if written and missed else ((), ())


def digest(data: bytes) -> str:
    """Names a content."""
    return hashlib.sha256(data).hexdigest()


FOLDER: Final = "drafts"
_BROKEN: Final = "broken"
_VERSION: Final = 1
_SLOTS: Final = 32
"""Documents that may have the same file open with the same data folder, in all studios."""
_CHECKED_MAX: Final = 50
_TRIES: Final = 5
_TRY_AGAIN_S: Final = 0.01
_LIMIT_BYTES: Final = 256 << 20
"""Limit of a draft's file, above anything that is written."""


@dataclass(frozen=True, slots=True)
class Draft:
    """The work on one entry file that no disk has; `at` is UTC, as ISO 8601."""

    entry: str
    at: str
    opened_with: dict[str, str]
    """The arguments that the document was opened with."""
    kept: KeptSources
    confined: tuple[str, ...] | None = None
    """The only files that xacro may read, since others than a presenter edited; None: any."""
    version: int = _VERSION


_DECODER: Final = msgspec.json.Decoder(Draft)
_BROKEN_JSON: Final = (msgspec.MsgspecError, UnicodeDecodeError, RecursionError)


class DraftFile:
    """The place of one document's draft, its own until `close`."""

    def __init__(self, path: Path, lock: IO[bytes]) -> None:
        self._path, self._lock = path, lock

    @property
    def journal(self) -> SaveJournal:
        """Beside the draft: what a save of the document is about to write."""
        return SaveJournal(self._path.with_suffix(".saving"))

    def read(self) -> Draft | None:
        """Return the draft of an earlier run, with its undo steps if they fit its texts.

        Raises:
            DraftError: It cannot be read, and was put aside.
        """
        try:
            if self._path.stat().st_size > _LIMIT_BYTES:
                raise self._put_aside("it is too large")
            draft = _DECODER.decode(self._path.read_bytes())
        except FileNotFoundError:
            return None
        except OSError as error:
            raise DraftError(str(self._path), _reason(error)) from error
        except _BROKEN_JSON as error:
            raise self._put_aside(f"it is broken ({error})") from error
        if draft.version != _VERSION:
            raise self._put_aside(f"it has the format {draft.version} of another studio")
        return replace(draft, kept=draft.kept.sound())

    def write(self, draft: Draft) -> None:
        """Put a draft in the place of the one before.

        Raises:
            DraftError: The disk refuses it; the one before is still there.
        """
        try:
            data = msgspec.json.encode(draft)
        except UnicodeEncodeError as error:
            raise DraftError(draft.entry, "a file has a name that is no text") from error
        try:
            write_whole(self._path, data, flush=True)
        except OSError as error:
            raise DraftError(str(self._path), _reason(error)) from error

    def remove(self) -> None:
        """Remove the draft."""
        with contextlib.suppress(OSError):
            self._path.unlink(missing_ok=True)

    def close(self) -> None:
        """Release the draft, which the next one to open the file takes."""
        self._lock.close()

    def _put_aside(self, reason: str) -> DraftError:
        """Rename a file that cannot be read, so that it is not taken for a draft."""
        aside = self._path.parent / _BROKEN / self._path.name
        try:
            aside.parent.mkdir(exist_ok=True)
            self._path.replace(aside)
        except OSError as error:
            return DraftError(str(self._path), _reason(error))
        return DraftError(str(aside), reason)


def draft_file(data_folder: Path, entry: Path) -> DraftFile:
    """Return the first free place for a draft of this file, one with a draft if there is any.

    Raises:
        DraftError: The data folder is not writable, or too many documents hold the file.
    """
    folder = data_folder / FOLDER
    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        for path in _slots(folder, entry):
            if lock := _hold_soon(path):
                return DraftFile(path, lock)
    except OSError as error:
        raise DraftError(str(folder), _reason(error)) from error
    raise DraftError(str(folder), "too many documents hold this file")


def _hold_soon(path: Path) -> IO[bytes] | None:
    """Hold a draft; a mere check whether it is held releases it a moment later."""
    for _ in range(_TRIES if path.exists() else 1):
        if lock := hold_file(path.with_suffix(".lock")):
            return lock
        time.sleep(_TRY_AGAIN_S)
    return None


def forget_drafts(data_folder: Path, entries: Iterable[Path]) -> None:
    """Remove the drafts of these files, except those that are open now."""
    folder = data_folder / FOLDER
    for path in (slot for entry in entries for slot in _slots(folder, entry)):
        if path.exists() and (lock := hold_file(path.with_suffix(".lock"))):
            DraftFile(path, lock).remove()
            lock.close()


def left_drafts(data_folder: Path) -> list[Draft]:
    """Drafts with unsaved texts that no open document holds, the newest first."""
    folder = data_folder / FOLDER
    found = [draft for path in _newest(folder) if (draft := _left(path)) is not None]
    return sorted(found, key=lambda one: one.at, reverse=True)


def _newest(folder: Path) -> list[Path]:
    """Return the newest files, so few that checking them does not take long."""
    try:
        known = [(path.stat().st_mtime, path) for path in folder.glob("*.json")]
    except OSError:
        return []
    return [path for _, path in sorted(known, reverse=True)[:_CHECKED_MAX]]


def _left(path: Path) -> Draft | None:
    try:
        lock = hold_file(path.with_suffix(".lock"))
        if lock is None:
            return None
        lock.close()  # at once: somebody may be about to open the file
        if path.stat().st_size > _LIMIT_BYTES:
            return None
        draft = _DECODER.decode(path.read_bytes())
    except (OSError, *_BROKEN_JSON):
        return None  # reported when its file is opened
    return draft if draft.version == _VERSION and draft.kept.unsaved_files else None


def _slots(folder: Path, entry: Path) -> list[Path]:
    key = hashlib.sha256(os.fsencode(entry)).hexdigest()[:24]
    return [folder / f"{key}-{number}.json" for number in range(1, _SLOTS + 1)]


def _reason(error: OSError) -> str:
    return error.strerror or "the disk refused it"
