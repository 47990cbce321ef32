"""Checks of names that must agree: of the folder, package.xml, setup.py, CMake and the marker."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, Final

from studio.packages.edits.setup_edits import list_items_added
from studio.packages.lint.checked import ERROR, INFO, edit, found
from studio.packages.skeleton import name_fault
from studio.problems import NewFile

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.lint.checked import CheckedPackage
    from studio.packages.sources.setup_py import SetupPy
    from studio.problems import Fix, Problem

_INDEX: Final = "share/ament_index/resource_index/packages"


def findings(checked: CheckedPackage) -> Iterator[Problem]:
    """Yield each name that is another one than that of package.xml."""
    source = checked.source
    manifest = source.manifest
    name = next(iter(manifest.of("name")), None)
    if name is None or not name.text:
        return
    if fault := name_fault(name.text):
        yield found(ERROR, "package-name", fault, manifest.source, name.start)
    if source.folder.name != name.text:
        sentence = (
            f'The folder is called "{source.folder.name}" and the package "{name.text}": they may '
            "differ, but people look for the package by its folder."
        )
        yield found(INFO, "folder-name", sentence, manifest.source, name.start)
    if source.is_python:
        yield from _of_setup(checked, name.text)
    elif source.cmake is not None:
        yield from _of_cmake(checked, name.text)


def _of_cmake(checked: CheckedPackage, name: str) -> Iterator[Problem]:
    lists = checked.source.cmake
    project = lists.project if lists else None
    if lists is None or project is None or "$" in project.value or project.value == name:
        return
    sentence = f'project() says "{project.value}", package.xml says "{name}": they must be equal.'
    mend = edit(f"Write {name}", lists.source.replaced(project.start, project.end, name))
    yield found(ERROR, "project-name", sentence, lists.source, project.start, mend)


def _of_setup(checked: CheckedPackage, name: str) -> Iterator[Problem]:
    source = checked.source
    setup = source.setup
    if setup is None or setup.fault:
        return
    given = setup.text("name")
    node = setup.keyword("name")
    if given is not None and node is not None and given.replace("-", "_") != name:
        sentence = f'setup.py says name="{given}", package.xml says "{name}": they must be equal.'
        at, mend = setup.python.span(node)[0], _renamed(setup, given, name)
        yield found(ERROR, "setup-name", sentence, setup.source, at, mend)
    yield from _of_marker(checked, setup, name)


def _renamed(setup: SetupPy, given: str, name: str) -> Fix | None:
    """Return the fix that writes the name where it is written as a text."""
    tree = setup.python.tree
    for node in tree.body if tree else ():
        match node:
            case ast.Assign(value=ast.Constant(value=value) as text) if value == given:
                start, end = setup.python.span(text)
                return edit(f"Write {name}", setup.source.replaced(start, end, repr(name)))
            case _:
                pass
    value = setup.keyword("name")
    if isinstance(value, ast.Constant):
        start, end = setup.python.span(value)
        return edit(f"Write {name}", setup.source.replaced(start, end, repr(name)))
    return None


def _of_marker(checked: CheckedPackage, setup: SetupPy, name: str) -> Iterator[Problem]:
    """The file in `resource` that ament's index gets, without which nobody finds the package."""
    source = checked.source
    rows = [one for one in setup.data_files if (one.destination or "").rstrip("/") == _INDEX]
    marker = f"resource/{name}"
    if not source.has(marker):
        mend = edit(f"Make {marker}", new_files=(NewFile(source.file(marker), ""),))
        sentence = f"The file {marker} is missing: ROS knows by it that the package is there."
        at = rows[0].start if rows else 0
        yield found(ERROR, "resource-marker", sentence, setup.source, at, mend)
    if rows or setup.computes_data_files or setup.call is None:
        return
    listed = setup.data_files_list
    sentence = f"data_files does not install {marker} into ament's index: ros2 finds no package."
    mend = None
    if listed is not None:
        item = f"('{_INDEX}', ['{marker}'])"
        mend = edit("Install it", list_items_added(setup, listed, [item]))
    at = setup.python.span(setup.call)[0]
    yield found(ERROR, "resource-index", sentence, setup.source, at, mend)


WHY: Final = {
    "package-name": {
        "en": "ROS refuses other names, or its tools warn of them (REP 144).",
        "de": "Andere Namen weist ROS ab, oder seine Werkzeuge warnen davor (REP 144).",
    },
    "folder-name": {
        "en": "Only the name in package.xml counts; a folder of another name misleads.",
        "de": "Nur der Name in package.xml zählt; ein anders benannter Ordner führt in die Irre.",
    },
    "project-name": {
        "en": "ament_package() stops the build where project() and package.xml disagree.",
        "de": "ament_package() bricht den Bau ab, wenn project() und package.xml sich "
        "widersprechen.",
    },
    "setup-name": {
        "en": "colcon installs by the name of setup.py, and ros2 looks by that of package.xml.",
        "de": "colcon installiert unter dem Namen aus setup.py, ros2 sucht nach dem aus "
        "package.xml.",
    },
    "resource-marker": {
        "en": "The build stops: a file that data_files names is not there.",
        "de": "Der Bau bricht ab: Eine Datei, die data_files nennt, ist nicht da.",
    },
    "resource-index": {
        "en": "A package that is not in ament's index is built, and ros2 run does not find it.",
        "de": "Ein Paket, das nicht im Index von ament steht, wird gebaut, aber ros2 run findet es "
        "nicht.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
