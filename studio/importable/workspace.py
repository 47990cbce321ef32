"""Workspace: what a user's process knows of the packages that were passed on to it."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Final

from studio.errors import StudioError
from studio.packages.passing import passed_packages
from studio.packages.sources.interfaces import packages_of_interface
from studio.packages.sources.package_source import PackageSource
from studio.ros.messages import INTERFACES_VARIABLE, shared_types
from studio.ros.names import KINDS
from studio.ros.types.files import texts_of_package

if TYPE_CHECKING:
    from pathlib import Path

_INSTALLING: Final = "ament_python_install_package"


class Workspace:
    """Takes types of a package when it is first imported, with those of the packages it uses."""

    def __init__(self) -> None:
        self.folders = passed_packages(os.environ)
        self._taken: set[str] = set()

    def take_types(self, package: str) -> None:
        """Let the types of a package be those of its folder; texts that break rules are told.

        Types of the environment are kept: what `--interfaces` names comes first.
        """
        if package in self._taken:
            return
        self._taken.add(package)
        folder = self.folders.get(package)
        if folder is None or os.environ.get(INTERFACES_VARIABLE):
            return
        if not any((folder / kind).is_dir() for kind in KINDS):
            return
        try:
            texts = texts_of_package(folder, package)
        except StudioError as error:
            self._tell(str(error))
            return
        for text in texts.texts.values():
            for other in packages_of_interface(text, "", package):
                self.take_types(other)
        for fault in shared_types().add_sound_texts(texts).values():
            self._tell(str(fault))

    def python_package(self, name: str) -> Path | None:
        """Return the file of a top-level module that a package of the workspace installs."""
        for folder in self._folders_of(name):
            for path in (folder / name / "__init__.py", folder / f"{name}.py"):
                if path.is_file() and self._installs(folder, name):
                    return path
        return None

    def _folders_of(self, name: str) -> list[Path]:
        """Return the folders to look in, that of a package of the same name first."""
        named = [self.folders[name]] if name in self.folders else []
        return [*named, *(one for one in self.folders.values() if one not in named)]

    def _installs(self, folder: Path, name: str) -> bool:
        source = PackageSource(folder)
        if source.setup is None:
            return source.cmake is not None and bool(source.cmake.of(_INSTALLING))
        return source.setup.packages is None or name in source.setup.packages

    def _tell(self, text: str) -> None:
        os.write(2, f"studio: {text}\n".encode(errors="replace"))
