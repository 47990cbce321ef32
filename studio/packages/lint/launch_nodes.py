"""Checks of launch files: do they start something that is there, and depended on."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.packages.edits import manifest_edits
from studio.packages.executables import executables
from studio.packages.inspection.inspecting import launch_format
from studio.packages.lint.checked import ERROR, WARNING, edit, found, meant, safely
from studio.packages.ros_packages import EXECUTABLES, PACKAGES
from studio.packages.sources.python_file import last_name

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.lint.checked import CheckedPackage
    from studio.packages.sources.spans import SourceText
    from studio.problems import Fix, Problem

_NODE: Final = re.compile(rb"<node\b[^<>]*>")
_ATTRIBUTE: Final = re.compile(rb"""\b(pkg|exec)\s*=\s*["']([^"'$<>]*)["']""")
_RUN_TAGS: Final = ("exec_depend", "depend", "run_depend")
"""What is installed where the package runs; the last is of format 1."""
_NAME: Final = re.compile(r"[A-Za-z][A-Za-z0-9_.-]*")


class _Word(NamedTuple):
    """A text of a launch file with its bytes, without quotes."""

    text: str
    start: int
    end: int


def findings(checked: CheckedPackage) -> Iterator[Problem]:
    """Yield files that start nothing, nodes that cannot be started, and what they depend on."""
    said: set[str] = set()
    for name in checked.source.names:
        form = launch_format(name)
        text = checked.source.text(name) if form else None
        if text is None or not text.is_utf8:
            continue
        if _is_empty(checked, name, text, form):
            sentence = f"{name} is empty: ros2 launch cannot start it."
            yield found(ERROR, "launch-empty", sentence, text)
            continue
        rows = _of_python(checked, name) if form == "python" else _of_xml(text)
        for package, executable in rows if form != "yaml" else ():
            yield from _node(checked, text, package, executable)
            if package is not None and package.text not in said:
                said.add(package.text)
                yield from _depends(checked, text, package)


def _is_empty(checked: CheckedPackage, name: str, text: SourceText, form: str) -> bool:
    """Whether a file holds nothing; one of Python may hold comments all the same."""
    if not text.data.strip():
        return True
    python = checked.source.python(name) if form == "python" else None
    tree = python.tree if python else None
    return tree is not None and not tree.body


def _of_python(checked: CheckedPackage, name: str) -> Iterator[tuple[_Word | None, _Word | None]]:
    python = checked.source.python(name)
    for node in python.nodes if python else ():
        if not isinstance(node, ast.Call) or python is None:
            continue
        if last_name(node.func) not in {"Node", "LifecycleNode"}:
            continue
        words: dict[str, _Word] = {}
        for one in node.keywords:
            value = one.value
            text = value.value if isinstance(value, ast.Constant) else None
            if one.arg in {"package", "executable"} and isinstance(text, str):
                start, end = python.span(value)
                words[one.arg] = _Word(text, start + 1, end - 1)
        yield words.get("package"), words.get("executable")


def _of_xml(text: SourceText) -> Iterator[tuple[_Word | None, _Word | None]]:
    for node in _NODE.finditer(text.data):
        words = {
            one[1].decode(): _Word(
                one[2].decode(), node.start() + one.start(2), node.start() + one.end(2)
            )
            for one in _ATTRIBUTE.finditer(node[0])
        }
        yield words.get("pkg"), words.get("exec")


def _node(
    checked: CheckedPackage, text: SourceText, package: _Word | None, executable: _Word | None
) -> Iterator[Problem]:
    if package is not None and not checked.has_package(package.text):
        right = meant(package.text, {*PACKAGES, *checked.packages}, 0.8)
        if right or not _NAME.fullmatch(package.text):
            hint = f": {right} is meant" if right else ""
            sentence = f'No package "{package.text}" is known{hint}.'
            mend = _written(text, package, right)
            yield found(ERROR, "launch-package", sentence, text, package.start, mend)
    if executable is None:
        return
    known = _executables(checked, package.text if package else "")
    if known is None:
        alike = {one for names in EXECUTABLES.values() for one in names}
        right = meant(executable.text, alike, 0.85)
        if not re.fullmatch(r"[\w.-]+", executable.text):
            sentence = f'"{executable.text}" is no name of an executable.'
            mend = _written(text, executable, right)
            yield found(ERROR, "launch-executable", sentence, text, executable.start, mend)
    elif executable.text not in known and package is not None:
        right = meant(executable.text, known, 0.6)
        listed = f": it has {', '.join(sorted(known))}" if 0 < len(known) < 9 else ""
        sentence = f'{package.text} has no executable "{executable.text}"{listed}.'
        mend = _written(text, executable, right)
        yield found(WARNING, "launch-executable", sentence, text, executable.start, mend)


def _depends(checked: CheckedPackage, text: SourceText, package: _Word) -> Iterator[Problem]:
    """Yield that package.xml does not name a package of which a node is started."""
    name, manifest = package.text, checked.source.manifest
    if name == checked.source.name or not manifest.source.data or manifest.fault:
        return
    if not checked.has_package(name) or any(one.text == name for one in manifest.of(*_RUN_TAGS)):
        return
    element = f"<exec_depend>{name}</exec_depend>"
    mend = safely(
        "Add it to package.xml", lambda: manifest_edits.added(manifest, "exec_depend", name)
    )
    sentence = f"A node of {name} is started, and package.xml does not name {name}: add {element}."
    yield found(WARNING, "launch-depend", sentence, text, package.start, mend)


def _executables(checked: CheckedPackage, package: str) -> frozenset[str] | None:
    """Return the names of what a package starts; None where they are not all known."""
    source = checked.packages.get(package)
    if source is None:
        return EXECUTABLES.get(package)
    found_names = frozenset(one.name for one in executables(source))
    # CMake may install by loops and variables that nobody evaluates.
    return found_names if source.is_python or found_names else None


def _written(text: SourceText, word: _Word, right: str) -> Fix | None:
    if not right or text.slice(word.start, word.end) != word.text:
        return None
    return edit(f"Write {right}", text.replaced(word.start, word.end, right))


WHY: Final = {
    "launch-depend": {
        "en": "Where the package is not installed by chance, ros2 launch does not find it: rosdep "
        "installs what package.xml names.",
        "de": "Wo das Paket nicht zufällig installiert ist, findet ros2 launch es nicht: rosdep "
        "installiert, was package.xml nennt.",
    },
    "launch-empty": {
        "en": "ros2 launch stops at a launch file without a launch description.",
        "de": "ros2 launch bricht bei einer Launch-Datei ohne Launch-Beschreibung ab.",
    },
    "launch-package": {
        "en": "ros2 launch stops with PackageNotFoundError before anything is started.",
        "de": "ros2 launch bricht mit PackageNotFoundError ab, bevor etwas startet.",
    },
    "launch-executable": {
        "en": "ros2 launch stops: the executable is not found in the package.",
        "de": "ros2 launch bricht ab: Das Programm findet sich nicht im Paket.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
