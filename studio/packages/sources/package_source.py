"""The source of one package: its files by name, each read once and parsed when it is asked for."""

from __future__ import annotations

import os
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.errors import PackageError
from studio.files import is_file
from studio.packages.folder_memory import is_text
from studio.packages.manifest import FILE_NAME
from studio.packages.roots import ServedRoots, is_below
from studio.packages.sources import setup_cfg, setup_py
from studio.packages.sources.python_file import SIZE_LIMIT_BYTES, PythonFile
from studio.packages.sources.setup_cfg import SetupCfg
from studio.packages.sources.setup_py import SetupPy
from studio.packages.sources.spans import SourceText

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from studio.packages.sources.cmake import CMakeLists
    from studio.packages.sources.package_xml import PackageXml
    from studio.packages.sources.scripts import Script

FILES_MAX: Final = 4_000
"""Of one package: of more, the rest is not looked at."""
_DEPTH_MAX: Final = 12
_NOT_SOURCE: Final = frozenset({"build", "install", "log", "__pycache__", "node_modules"})


class PackageSource:
    """A package's folder as it is now; an object is for one look at it.

    Args:
        folder: Resolved.
        read: Returns the bytes of a file as they are edited now, None to read the disk.
        name: That of the package, where it is known; else its package.xml is asked.
    """

    def __init__(
        self,
        folder: Path,
        read: Callable[[Path], bytes | None] | None = None,
        name: str = "",
    ) -> None:
        self.folder = folder
        self._given_name = name
        self._edited = read
        self._roots = ServedRoots([folder])
        self._data: dict[str, bytes | None] = {}
        self._python: dict[str, PythonFile] = {}
        self.is_complete = True

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Its files, as paths with `/` below the folder, sorted; packages inside are left out."""
        found: list[str] = []
        waiting = [("", 0)]
        while waiting:
            below, depth = waiting.pop()
            try:
                with os.scandir(self.folder / below) as entries:
                    listed = sorted(entries, key=lambda one: one.name)
            except OSError:
                continue
            if below and any(one.name == FILE_NAME for one in listed):
                continue
            for one in listed:
                if one.name.startswith(".") or not is_text(one.name):
                    continue
                if one.is_dir(follow_symlinks=False):
                    if one.name not in _NOT_SOURCE and depth < _DEPTH_MAX:
                        waiting.append((f"{below}{one.name}/", depth + 1))
                elif len(found) >= FILES_MAX:
                    self.is_complete = False
                    return tuple(sorted(found))
                else:
                    found.append(below + one.name)
        return tuple(sorted(found))

    def path(self, name: str) -> Path:
        """Return a file of the package by its name below the folder."""
        return self.folder / name

    def file(self, name: str) -> str:
        """Return the path of a file as problems and edits name it."""
        return str(self.folder / name)

    def has(self, name: str) -> bool:
        """Whether there is a file of that name, which leads to no place outside the package."""
        if self._edited_data(name) is not None:
            return True
        path = self.folder / name
        return is_file(path) and is_below(Path(os.path.realpath(path)), self._real)

    @cached_property
    def _real(self) -> Path:
        return Path(os.path.realpath(self.folder))

    def has_folder(self, name: str) -> bool:
        """Whether files lie below a folder of that name."""
        return any(one.startswith(f"{name}/") for one in self.names)

    def below(self, folder: str, *suffixes: str) -> Iterator[str]:
        """Yield the names of files below a folder (empty: all) that end so."""
        start = f"{folder}/" if folder else ""
        yield from (
            one
            for one in self.names
            if one.startswith(start) and (not suffixes or one.endswith(suffixes))
        )

    def data(self, name: str) -> bytes | None:
        """Return the bytes of a file; None if it is not there, too large or no regular file."""
        if name not in self._data:
            edited = self._edited_data(name)
            self._data[name] = self._from_disk(name) if edited is None else edited
        return self._data[name]

    def _edited_data(self, name: str) -> bytes | None:
        return self._edited(self.folder / name) if self._edited is not None else None

    def _from_disk(self, name: str) -> bytes | None:
        try:
            return self._roots.read(self.folder / name, SIZE_LIMIT_BYTES)
        except PackageError:
            return None

    def text(self, name: str) -> SourceText | None:
        """Return a file with its lines; None as for `data`."""
        data = self.data(name)
        return None if data is None else SourceText(self.file(name), data)

    def python(self, name: str) -> PythonFile | None:
        """Return a Python file, parsed; None as for `data`."""
        if name not in self._python:
            data = self.data(name)
            if data is None:
                return None
            self._python[name] = PythonFile(self.file(name), data)
        return self._python[name]

    @cached_property
    def manifest(self) -> PackageXml:
        """Its package.xml; an empty one if it cannot be read."""
        # Imported when it is asked for, as cmake is: a node of Python starts without both.
        from studio.packages.sources.package_xml import PackageXml  # noqa: PLC0415

        return PackageXml(self.file(FILE_NAME), self.data(FILE_NAME) or b"")

    @cached_property
    def setup(self) -> SetupPy | None:
        """Its setup.py."""
        data = self.data(setup_py.FILE_NAME)
        return None if data is None else SetupPy(self.file(setup_py.FILE_NAME), data)

    @cached_property
    def config(self) -> SetupCfg | None:
        """Its setup.cfg."""
        data = self.data(setup_cfg.FILE_NAME)
        return None if data is None else SetupCfg(self.file(setup_cfg.FILE_NAME), data)

    @cached_property
    def scripts(self) -> tuple[Script, ...]:
        """The entries of `console_scripts` in setup.py, then in setup.cfg."""
        files = (self.setup, self.config)
        return tuple(one for file in files if file is not None for one in file.scripts)

    def script(self, name: str) -> Script | None:
        """Return the entry of an executable; of several, the first."""
        return next((one for one in self.scripts if one.name == name), None)

    def module(self, module: str) -> tuple[str, str] | None:
        """Find a module by its dotted name.

        Returns:
            The folder that it is imported from, below the package (empty: the package's own), and
            the name of its file; None if no file of the package is that module.
        """
        steps = module.replace(".", "/")
        given = self.setup.package_dir.get("", "").strip("/") if self.setup else ""
        for root in dict.fromkeys((given.removeprefix("./").removeprefix("."), "", "src")):
            start = f"{root}/{steps}" if root else steps
            for name in (f"{start}.py", f"{start}/__init__.py"):
                if self.has(name):
                    return root, name
        return None

    @cached_property
    def cmake(self) -> CMakeLists | None:
        """Its CMakeLists.txt."""
        from studio.packages.sources import cmake  # noqa: PLC0415

        data = self.data(cmake.FILE_NAME)
        return (
            None if data is None else cmake.CMakeLists(self.file(cmake.FILE_NAME), data, self.name)
        )

    @cached_property
    def name(self) -> str:
        """The name in its package.xml, else that of its folder."""
        return self._given_name or self.manifest.name or self.folder.name

    @cached_property
    def build_type(self) -> str:
        """How colcon builds it: as exported, else `ament_cmake` by its files."""
        exported = self.manifest.build_type()
        if exported:
            return exported
        tools = {one.text for one in self.manifest.of("buildtool_depend")}
        if "catkin" in tools:
            return "catkin"
        return "ament_cmake" if "ament_cmake" in tools else "cmake"

    @cached_property
    def is_python(self) -> bool:
        """Whether setuptools builds it: by its build type, or by its files where that is wrong."""
        return self.build_type == "ament_python" or (self.setup is not None and self.cmake is None)
