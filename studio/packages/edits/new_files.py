"""A new node, interface or launch file of a package, with the entries that the build needs."""

from __future__ import annotations

import keyword
import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal, TypeAlias, get_args

from studio.errors import NotMadeError
from studio.packages.edits import cmake_edits, manifest_edits, setup_edits
from studio.packages.edits.imports_needed import needed_packages
from studio.packages.edits.package_edit import PackageEdit
from studio.packages.known import Known
from studio.packages.sources.interfaces import KIND_NAMES, packages_of_interface
from studio.packages.sources.python_file import PythonFile
from studio.problems import NewFile, Replacement

if TYPE_CHECKING:
    from studio.packages.sources.package_source import PackageSource

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

_Change: TypeAlias = Callable[[], Iterable[Replacement]]


class _Changes:
    """Collects what an edit changes; what cannot be done safely becomes a sentence."""

    def __init__(self, source: PackageSource) -> None:
        self.source = source
        self.edits: list[Replacement] = []
        self.by_hand: list[str] = []

    def take(self, file: str, line: str, change: _Change) -> None:
        """Make a change of a file, or say which line is to be written into it."""
        try:
            self.edits += change()
        except ValueError:
            self.by_hand.append(
                f"{file} cannot be changed safely as it is: mend it first, or write by hand: {line}"
            )

    def missing(self, file: str, line: str) -> None:
        """Say that a file is not there in which a line is to stand."""
        self.by_hand.append(f"The package has no {file}, in which this is to stand: {line}")

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
        _add_script(changes, name, f"{below.replace('/', '.')}.{name}:main")
        new = [NewFile(source.file(file), text)]
        if not source.has(f"{below}/__init__.py"):
            new.append(NewFile(source.file(f"{below}/__init__.py"), ""))
    else:
        file = f"scripts/{name}.py"
        _check_free(source, file)
        lists = source.cmake
        line = f"install(PROGRAMS {file} DESTINATION lib/${{PROJECT_NAME}})"
        if lists is None:
            changes.missing("CMakeLists.txt", line)
        else:
            changes.take("CMakeLists.txt", line, lambda: cmake_edits.installed_program(lists, file))
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


def _add_script(changes: _Changes, name: str, place: str) -> None:
    setup = changes.source.setup
    line = f"'{name} = {place}' in console_scripts"
    if setup is None:
        changes.missing("setup.py", line)
    else:
        changes.take("setup.py", line, lambda: setup_edits.script_added(setup, name, place))


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
    text = text or _SAMPLES[kind]
    known = known or Known()
    _check_free(source, file)
    if len(text) > TEXT_LIMIT:
        raise NotMadeError(file, f"its text has more than {TEXT_LIMIT} characters.")
    if fault := known.type_fault(f"{source.name}/{kind}/{name}", text):
        raise NotMadeError(file, fault.sentence)
    packages = packages_of_interface(text, kind, source.name)
    changes = _Changes(source)
    lists = source.cmake
    line = f'rosidl_generate_interfaces(${{PROJECT_NAME}} "{file}")'
    if lists is None:
        changes.missing("CMakeLists.txt", line)
    else:
        changes.take("CMakeLists.txt", line, lambda: cmake_edits.generated(lists, file, packages))
    changes.depend([("buildtool_depend", "rosidl_default_generators")])
    changes.depend([("depend", one) for one in packages])
    changes.depend([("exec_depend", "rosidl_default_runtime")])
    changes.depend([("member_of_group", "rosidl_interface_packages")])
    ended = text if text.endswith("\n") else f"{text}\n"
    path = source.file(file)
    return changes.edit(f"New {KIND_NAMES[kind]} {name}", path, [NewFile(path, ended)])


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
    install_folder(changes, "launch", f"*.launch.{form}")
    tags = ["launch", "launch_ros"] + [f"launch_{form}"] * (form != "py")
    packages = dict.fromkeys(package for package, _ in rows if package != source.name)
    changes.depend(("exec_depend", one) for one in (*tags, *packages))
    text = launch_text(form, rows)
    path = source.file(file)
    return changes.edit(f"New launch file {stem}", path, [NewFile(path, text)])


def install_folder(changes: _Changes, folder: str, pattern: str) -> None:
    """Have a folder of the package installed into its share folder."""
    source = changes.source
    setup, lists = source.setup, source.cmake
    if source.is_python:
        line = f"('share/' + package_name + '/{folder}', glob('{folder}/{pattern}'))"
        if setup is None:
            changes.missing("setup.py", line)
        else:
            rows = [(folder, pattern)]
            changes.take("setup.py", line, lambda: setup_edits.data_files_added(setup, rows))
    else:
        line = f"install(DIRECTORY {folder} DESTINATION share/${{PROJECT_NAME}})"
        if lists is None:
            changes.missing("CMakeLists.txt", line)
        else:
            changes.take(
                "CMakeLists.txt", line, lambda: cmake_edits.installed_folder(lists, folder)
            )


def installing_edit(source: PackageSource, folder: str, pattern: str) -> PackageEdit:
    """Return the edit that has the build install a folder of the package."""
    changes = _Changes(source)
    install_folder(changes, folder, pattern)
    return changes.edit(f"Install {folder}", "", ())


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
