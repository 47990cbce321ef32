"""Where a person's own poses are kept: a YAML file beside the robot's entry, else this session."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.poses.poses_file import SIZE_LIMIT_BYTES, read_poses, write_poses
from studio.engine.side_file import SideFile
from studio.errors import PackageError, PosesFileError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from studio.description.poses.named_poses import NamedPose
    from studio.packages.roots import ServedRoots


class PoseShelf:
    """Reads and writes one file of poses; what cannot be written is kept for the session."""

    def __init__(self, entry: Path, served: ServedRoots) -> None:
        self._entry = entry
        self._file = SideFile(entry, "poses", served)
        self.path = self._file.path
        self._data = b""
        self._here: tuple[NamedPose, ...] | None = None
        """The poses of this session, once they could not be written."""
        self.poses: tuple[NamedPose, ...] = ()
        self._fault: PosesFileError | PackageError | None = None
        """What is wrong with the file; the last good poses stay."""

    @property
    def only_here(self) -> str:
        """Why poses are kept for this session only; empty: they are saved."""
        return self._file.only_here

    @property
    def trouble(self) -> str:
        """What is wrong with the file, in a sentence."""
        return str(self._fault or "")

    def look(self) -> None:
        """Read the file."""
        if self._here is not None:
            return
        try:
            data = self._file.read(SIZE_LIMIT_BYTES)
            if data != self._data or self._fault is not None:
                self._data = data
                self.poses, self._fault = read_poses(str(self.path), data), None
        except (PosesFileError, PackageError) as error:
            self._fault = error

    def put(self, poses: Sequence[NamedPose]) -> None:
        """Keep these from now on.

        Raises:
            PosesFileError: The file as it is cannot be read: it is not overwritten.
            PackageError: It leads out of the opened folders, or is no file.
            NotSavedError: The disk refused it.
        """
        self.look()
        if self._fault is not None:
            raise self._fault
        if self._here is not None or self.only_here:
            self._here = self.poses = tuple(poses)
            return
        data = write_poses(str(self.path), self._entry.name, self._data, poses)
        self._file.write(data)
        self.look()
