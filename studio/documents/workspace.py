"""The workspace of a document: its entry file, the folders around it, and the texts in them."""

from __future__ import annotations

import asyncio
import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.description.editing.sources import Sources
from studio.description.values import ReadPolicy
from studio.errors import CommandError, NotAllowedError
from studio.packages.roots import package_folder_of
from studio.packages.run_folders import RunFolders, is_program
from studio.packages.uris import resolve_uri
from studio.protocol.roles import Role
from studio.settings import XACRO_ENVIRONMENT

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.packages.roots import ServedRoots
    from studio.packages.workspace import Location

_TYPED_ALONE: Final = (
    "it is a program, which the owner changes in Source alone, not by a value, a name or a fix."
)


class Workspace:
    """Files and texts of a document; a package chosen later changes the location.

    Attributes:
        entry: The entry file.
        path: The same, as a string.
        location: The folders that may be read and written, and the packages in them.
        sources: The texts and arguments with their edits.

    Raises:
        CommandError: The location has no entry file.
    """

    def __init__(
        self,
        location: Location,
        arguments: Mapping[str, str],
        *,
        trusted: bool = False,
        runs: RunFolders | None = None,
    ) -> None:
        if location.entry is None:
            raise CommandError(f"{location.root} holds no robot description: open a file.")
        self.entry, self.path = location.entry, str(location.entry)
        self._trusted, self._runs = trusted, runs or RunFolders()
        self.location, self._policy = location, read_policy(location, trusted=trusted)
        self._confined: frozenset[str] | None = None
        self.sources = Sources(
            # Asked again each time: a package that is chosen later is served from then on.
            lambda path: self.served.read(path),  # noqa: PLW0108
            lambda path: self.served.resolve(path),  # noqa: PLW0108
            lambda path: self.may_write(path),  # noqa: PLW0108
            arguments,
            lambda file: _TYPED_ALONE if is_program(file) else "",
        )
        self._packages_of: tuple[tuple[str, ...], Location] | None = None
        self._packages: dict[str, str] = {}

    @property
    def title(self) -> str:
        """The entry file's name, or which untitled text it is."""
        return self.location.title

    @property
    def policy(self) -> ReadPolicy:
        """Files that the document's xacro worker may read."""
        if self._confined is None:
            return self._policy
        return replace(self._policy, roots=tuple(sorted(self._confined)))

    @property
    def confined(self) -> frozenset[str] | None:
        """The only files that xacro may read; None: those of all opened folders."""
        return self._confined

    def confine(self, files: Iterable[str]) -> None:
        """Let xacro read these files and no others, until `free`; the first time counts."""
        if self._confined is None:
            self._confined = frozenset(files)

    def free(self) -> bool:
        """Let xacro read all opened folders again; return whether it could not."""
        was_confined, self._confined = self._confined is not None, None
        return was_confined

    @property
    def served(self) -> ServedRoots:
        """The folders that may be read and written."""
        return self.location.served

    def may_write(self, path: Path | str) -> bool:
        """Whether a file can be saved; a program only where the owner may run it."""
        return self.served.may_write(path) and self.may_program(path)

    def may_program(self, path: Path | str) -> bool:
        """Whether a file is none that is run, or the owner may run it."""
        return not is_program(path) or self._runs.may_edit(path)

    @property
    def may_run(self) -> bool:
        """Whether what lies beside the entry file may be run."""
        return self._runs.allows(self.path)

    def check_role(self, files: Iterable[str], role: Role) -> None:
        """Pass if a person of that role may change these files: programs are the owner's alone.

        Raises:
            NotAllowedError: One is a program.
        """
        if role is not Role.PRESENTER and any(map(is_program, files)):
            raise NotAllowedError(role, "change_programs")

    def resolve_uri(self, uri: str) -> Path:
        """Return the file of a URI in this document; reads the disk, thread-safe.

        Raises:
            PackageError: It names no file that may be read.
        """
        return resolve_uri(uri, self.entry, self.location.index, self.location.served)

    async def choose_package(self, name: str, folder: Path) -> None:
        """Use a folder for a package from now on, read-only.

        Raises:
            PackageError: It does not hold that package.
        """
        self.location = await asyncio.to_thread(self.location.choose_package, name, folder)
        self._policy = read_policy(self.location, trusted=self._trusted)

    def packages_of(self, files: Iterable[str]) -> dict[str, str]:
        """Return the package of each file: its name, and which copy it is.

        Returns:
            The same object while neither the files nor the location change.
        """
        asked = tuple(files)
        before = self._packages_of
        if before is None or before[0] != asked or before[1] is not self.location:
            self._packages_of = asked, self.location
            parents = {Path(one).parent for one in asked}
            folders = {package_folder_of(Path(folder)) for folder in parents}
            packages = self.location.index.packages
            self._packages = {
                one.name: str(one.folder) for one in packages if one.folder in folders
            }
        return self._packages


def read_policy(location: Location, *, trusted: bool) -> ReadPolicy:
    """Return what the xacro worker of a location with an entry file may read.

    Trust gives the files the whole environment, and nothing else: expressions stay bounded, and
    only served files may be read. The content of an archive is never trusted.
    """
    assert location.entry is not None
    trusted = trusted and not location.is_unpacked
    environment = {
        name: value for name, value in os.environ.items() if trusted or name in XACRO_ENVIRONMENT
    }
    return ReadPolicy(
        roots=tuple(map(str, location.served.all)),
        packages=location.index.mapping_for(location.entry),
        environment=environment,
        trusted=trusted,
    )
