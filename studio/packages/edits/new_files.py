"""A new node, interface or launch file of a package, with the entries that the build needs."""

from __future__ import annotations

import keyword
import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal, TypeAlias, TypeVar, get_args

from studio.errors import NotMadeError
from studio.packages.edits import cmake_edits, manifest_edits, setup_edits
from studio.packages.edits.imports_needed import needed_packages
from studio.packages.edits.package_edit import PackageEdit
from studio.packages.known import Known
from studio.packages.sources.interfaces import KIND_NAMES, PACKAGE_NEEDS, packages_of_interface
from studio.packages.sources.python_file import PythonFile
from studio.problems import NewFile, Replacement

if TYPE_CHECKING:
    from studio.packages.sources.cmake import CMakeLists
    from studio.packages.sources.package_source import PackageSource
    from studio.packages.sources.setup_py import SetupPy

NodeTemplate: TypeAlias = Literal[
    "publisher",
    "subscriber",
    "service_server",
    "service_client",
    "action_server",
    "action_client",
    "parameters",
    "timer",
    "empty",
]
NODE_TEMPLATES: Final[tuple[NodeTemplate, ...]] = get_args(NodeTemplate)
InterfaceKind: TypeAlias = Literal["msg", "srv", "action"]
LaunchFormat: TypeAlias = Literal["py", "xml", "yaml"]
LAUNCH_FORMATS: Final[tuple[LaunchFormat, ...]] = get_args(LaunchFormat)
TEXT_LIMIT: Final = 100_000
_TEMPLATES: Final = Path(__file__).parent / "node_templates"
_MODULE: Final = re.compile(r"[a-z][a-z0-9_]{0,79}")
_TYPE: Final = re.compile(r"[A-Z][A-Za-z0-9]{0,79}")
_LAUNCH: Final = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,79}")
_SAMPLES: Final[dict[str, str]] = {
    "msg": "# One field a line: its type, then its name.\nstring text\nint32 count\n",
    "srv": "# The request.\nint64 a\nint64 b\n---\n# The response.\nint64 sum\n",
    "action": (
        "# The goal.\nint32 order\n---\n# The result.\nint32[] sequence\n---\n"
        "# The feedback.\nint32[] partial_sequence\n"
    ),
}

_Edits: TypeAlias = Iterable[Replacement]
_File = TypeVar("_File")


class _Changes:
    """Collects what an edit changes; what cannot be done safely becomes a sentence."""

    def __init__(self, source: PackageSource) -> None:
        self.source = source
        self.edits: list[Replacement] = []
        self.by_hand: list[str] = []

    def take(self, file: str, line: str, change: Callable[[], _Edits]) -> None:
        """Make a change of a file, or say which line is to be written into it."""
        try:
            self.edits += change()
        except ValueError:
            self.by_hand.append(
                f"{file} cannot be changed safely as it is: mend it first, or write by hand: {line}"
            )

    def in_setup(self, line: str, change: Callable[[SetupPy], _Edits]) -> None:
        """Change setup.py, or say what is to stand in it."""
        self._in_file("setup.py", self.source.setup, line, change)

    def in_cmake(self, line: str, change: Callable[[CMakeLists], _Edits]) -> None:
        """Change CMakeLists.txt, or say what is to stand in it."""
        self._in_file("CMakeLists.txt", self.source.cmake, line, change)

    def _in_file(
        self, name: str, file: _File | None, line: str, change: Callable[[_File], _Edits]
    ) -> None:
        if file is None:
            self.by_hand.append(f"The package has no {name}, in which this is to stand: {line}")
        else:
            self.take(name, line, lambda: change(file))

    def depend(self, rows: Iterable[tuple[str, str]]) -> None:
        """Say in package.xml what the package needs; rows are (tag, name)."""
        for tag, name in rows:
            self.take(
                "package.xml",
                f"<{tag}>{name}</{tag}>",
                lambda tag=tag, name=name: manifest_edits.added(self.source.manifest, tag, name),
            )

    def edit(self, label: str, opened: str, new: Iterable[NewFile]) -> PackageEdit:
        """Return the whole edit, in the order of files and places."""
        ordered = sorted(self.edits, key=lambda one: one.file)
        return PackageEdit(label, opened, tuple(new), tuple(ordered), tuple(self.by_hand))


def new_node(
    source: PackageSource, name: str, template: NodeTemplate = "empty", known: Known | None = None
) -> PackageEdit:
    """Return the edit that adds a Python node and starts it by its name.

    In a package of ament_python it is a module with an entry in `console_scripts`; else a script
    in `scripts/` that CMake installs.

    Raises:
        NotMadeError: The name is none for a module, or taken.
    """
    _check_module(name)
    text = node_text(name, template)
    changes = _Changes(source)
    own = source.name
    if source.is_python:
        below = own if source.has(f"{own}/__init__.py") else _only_module(source) or own
        file = f"{below}/{name}.py"
        _check_free(source, file)
        if any(one.name == name for one in (source.setup.scripts if source.setup else ())):
            raise NotMadeError(file, f"setup.py has an executable {name} already.")
        place = f"{below.replace('/', '.')}.{name}:main"
        changes.in_setup(
            f"'{name} = {place}' in console_scripts",
            lambda setup: setup_edits.script_added(setup, name, place),
        )
        new = [NewFile(source.file(file), text)]
        if not source.has(f"{below}/__init__.py"):
            new.append(NewFile(source.file(f"{below}/__init__.py"), ""))
    else:
        file = f"scripts/{name}.py"
        _check_free(source, file)
        changes.in_cmake(
            f"install(PROGRAMS {file} DESTINATION lib/${{PROJECT_NAME}})",
            lambda lists: cmake_edits.installed_program(lists, file),
        )
        new = [NewFile(source.file(file), f"#!/usr/bin/env python3\n{text}")]
    known = known or Known()
    python = PythonFile(file, text.encode())
    needed = needed_packages(python, own, known.has_package)
    changes.depend((tag, package) for tag, package, _ in needed)
    return changes.edit(f"New node {name}", new[0].file, new)


def node_text(name: str, template: NodeTemplate) -> str:
    """Return the text of a node by one of `NODE_TEMPLATES`."""
    text = (_TEMPLATES / f"{template}.py.in").read_text(encoding="utf-8")
    parts = "".join(part[:1].upper() + part[1:] for part in name.split("_"))
    return text.replace("@NODE@", name).replace("@CLASS@", parts)


def _only_module(source: PackageSource) -> str | None:
    """Return the folder of the only Python package, where it is not called like the package."""
    found = {one.partition("/")[0] for one in source.below("", "/__init__.py")} - {"test"}
    return next(iter(found)) if len(found) == 1 else None


def new_interface(
    source: PackageSource,
    kind: InterfaceKind,
    name: str,
    text: str = "",
    known: Known | None = None,
) -> PackageEdit:
    """Return the edit that adds a message, service or action and has its code generated.

    Args:
        source: A package that CMake builds.
        kind: Which of the three.
        name: Of the type, without its ending.
        text: What it defines; empty for a sample.
        known: Says whether the text defines a type.

    Raises:
        NotMadeError: The name or the text defines no type, the file is there, or the package is
            built by setuptools, which cannot generate code.
    """
    file = f"{kind}/{name}.{kind}"
    text = text or _SAMPLES[kind]
    _check_interface(source, file, text, known or Known())
    packages = packages_of_interface(text, kind, source.name)
    changes = _Changes(source)
    changes.in_cmake(
        f'rosidl_generate_interfaces(${{PROJECT_NAME}} "{file}")',
        lambda lists: cmake_edits.generated(lists, file, packages),
    )
    generators, *others = PACKAGE_NEEDS
    changes.depend([generators, *(("depend", one) for one in packages), *others])
    ended = text if text.endswith("\n") else f"{text}\n"
    path = source.file(file)
    return changes.edit(f"New {KIND_NAMES[kind]} {name}", path, [NewFile(path, ended)])


def _check_interface(source: PackageSource, file: str, text: str, known: Known) -> None:
    """Raise NotMadeError if a file of that name, with that text, defines no type."""
    kind, _, name = file.partition("/")
    name = name.removesuffix(f".{kind}")
    if not _TYPE.fullmatch(name):
        raise NotMadeError(
            file, "a type is named in letters and digits, a capital first: GetNowPlaying, say."
        )
    if source.is_python:
        raise NotMadeError(
            file,
            f"{source.name} is a package of ament_python, in which no code is generated of "
            f"interfaces: make a package for them, {source.name}_interfaces.",
        )
    _check_free(source, file)
    if len(text) > TEXT_LIMIT:
        raise NotMadeError(file, f"its text has more than {TEXT_LIMIT} characters.")
    if fault := known.type_fault(f"{source.name}/{kind}/{name}", text):
        raise NotMadeError(file, fault.sentence)


def new_launch_file(
    source: PackageSource,
    name: str,
    form: LaunchFormat = "py",
    nodes: Iterable[tuple[str, str]] = (),
) -> PackageEdit:
    """Return the edit that adds a launch file for these (package, executable), and installs it.

    Raises:
        NotMadeError: The name is none for a file, or taken.
    """
    stem = name.removesuffix(f".{form}").removesuffix(".launch").removesuffix("_launch")
    file = f"launch/{stem}.launch.{form}"
    if not _LAUNCH.fullmatch(stem):
        raise NotMadeError(file, "name it in letters, digits and underscores: bringup, say.")
    _check_free(source, file)
    changes = _Changes(source)
    rows = list(nodes)
    _install_folder(changes, "launch", f"*.launch.{form}")
    tags = ["launch", "launch_ros"] + [f"launch_{form}"] * (form != "py")
    packages = dict.fromkeys(package for package, _ in rows if package != source.name)
    changes.depend(("exec_depend", one) for one in (*tags, *packages))
    text = launch_text(form, rows)
    path = source.file(file)
    return changes.edit(f"New launch file {stem}", path, [NewFile(path, text)])


def _install_folder(changes: _Changes, folder: str, pattern: str) -> None:
    """Have a folder of the package installed into its share folder."""
    if changes.source.is_python:
        changes.in_setup(
            f"('share/' + package_name + '/{folder}', glob('{folder}/{pattern}'))",
            lambda setup: setup_edits.data_files_added(setup, [(folder, pattern)]),
        )
    else:
        changes.in_cmake(
            f"install(DIRECTORY {folder} DESTINATION share/${{PROJECT_NAME}})",
            lambda lists: cmake_edits.installed_folder(lists, folder),
        )


def launch_text(form: LaunchFormat, nodes: Iterable[tuple[str, str]]) -> str:
    """Return the text of a launch file that starts these (package, executable)."""
    rows = list(nodes)
    if form == "xml":
        lines = [
            f'  <node pkg="{package}" exec="{name}" output="screen"/>' for package, name in rows
        ]
        return "\n".join(["<launch>", *lines, "</launch>", ""])
    if form == "yaml":
        parts = [
            f"  - node:\n      pkg: {package}\n      exec: {name}\n      output: screen\n"
            for package, name in rows
        ]
        return "launch:\n" + "".join(parts) if parts else "launch: []\n"
    imports = "from launch import LaunchDescription\n"
    if not rows:
        body = "    return LaunchDescription([])\n"
    else:
        imports += "from launch_ros.actions import Node\n"
        items = "".join(
            f"        Node(package={package!r}, executable={name!r}, output='screen'),\n"
            for package, name in rows
        )
        body = f"    return LaunchDescription([\n{items}    ])\n"
    says = '    """Say what is started."""\n'
    return f"{imports}\n\ndef generate_launch_description():\n{says}{body}"


def _check_module(name: str) -> None:
    if not _MODULE.fullmatch(name) or keyword.iskeyword(name):
        raise NotMadeError(
            f"The node {name[:80]}",
            "it is named in small letters, digits and underscores, a letter first: talker, say.",
        )


def _check_free(source: PackageSource, file: str) -> None:
    if source.has(file) or source.path(file).exists():
        raise NotMadeError(source.file(file), "it is there already: choose another name.")
