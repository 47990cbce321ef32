"""A small file of the studio's beside the entry of a robot: read as hostile, written whole."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.errors import NotSavedError
from studio.files import write_whole
from studio.packages.presence import is_there

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.roots import ServedRoots

_ENDINGS: Final = (".urdf.xacro", ".xacro", ".urdf", ".xml")


class SideFile:
    """`<robot>.<kind>.yaml` beside the entry file."""

    def __init__(self, entry: Path, kind: str, served: ServedRoots) -> None:
        self.path = entry.with_name(f"{_stem(entry.name)}.{kind}.yaml")
        self._served = served

    @property
    def only_here(self) -> str:
        """Why what belongs in it is kept for this session only; empty: it can be written."""
        if self._served.may_write(self.path):
            return ""
        return f"the folder {self.path.parent} may only be read here."

    def read(self, limit_bytes: int) -> bytes:
        """Its bytes; none when it is not there.

        Raises:
            PackageError: It leads out of the opened folders, is no file, or is too large.
        """
        if not is_there(self.path):
            return b""
        return self._served.read(self.path, limit_bytes)

    def write(self, data: bytes) -> None:
        """Whole or not at all: beside it, then renamed over it. A symlink stays.

        Raises:
            PackageError: It leads out of the opened folders.
            NotSavedError: The disk refused it.
        """
        target = self._served.resolve(self.path)
        try:
            mode = target.stat().st_mode & 0o777 if is_there(target) else 0o644
            write_whole(target, data, mode=mode, flush=True)
        except OSError as error:
            reason = error.strerror or "the disk refused it"
            raise NotSavedError(str(self.path), reason) from error


def _stem(name: str) -> str:
    return next((name.removesuffix(end) for end in _ENDINGS if name.endswith(end)), name)
