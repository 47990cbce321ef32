"""What a save of several files is about to write, so that one that was cut off can be told."""

from __future__ import annotations

import contextlib
import hashlib
from typing import TYPE_CHECKING, Final

import msgspec

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path


class PlannedFile(msgspec.Struct, frozen=True):
    """A file of a save: digests of its bytes before and after."""

    file: str
    before: str
    after: str


_DECODER: Final = msgspec.json.Decoder(tuple[PlannedFile, ...])


class SaveJournal:
    """A small file that is there while a save is under way, and after one that was cut off."""

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
        """The files that a save wrote, and those that it did not come to.

        Both are empty when none was cut off. `saved` gives what the disk has of a file now; what
        somebody wrote since belongs to neither.
        """
        try:
            plan = _DECODER.decode(self._path.read_bytes())
        except (OSError, msgspec.MsgspecError, UnicodeDecodeError):
            return (), ()
        now = {one.file: digest(saved(one.file)) for one in plan}
        written = tuple(one.file for one in plan if now[one.file] == one.after)
        missed = tuple(one.file for one in plan if now[one.file] == one.before)
        return (written, missed) if written and missed else ((), ())


def digest(data: bytes) -> str:
    """Names a content."""
    return hashlib.sha256(data).hexdigest()
