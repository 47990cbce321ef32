"""Checks of setup.py: how a Python package is built, and what it installs beside its modules."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.packages.edits import manifest_edits
from studio.packages.lint.checked import ERROR, WARNING, edit, found, safely

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.lint.checked import CheckedPackage
    from studio.packages.sources.setup_py import SetupPy
    from studio.problems import Problem


def findings(checked: CheckedPackage) -> Iterator[Problem]:
    """Yield faults of the build type, then of what is installed."""
    yield from _build_type(checked)
    source = checked.source
    setup = source.setup
    if setup is None or not source.is_python:
        return
    if setup.call is not None:  # else a finding of `entries`
        yield from _data_files(checked, setup)


def _build_type(checked: CheckedPackage) -> Iterator[Problem]:
    source = checked.source
    manifest = source.manifest
    if not manifest.source.data or manifest.fault:
        return
    kind, element = source.build_type, manifest.build_type_element
    has_setup, has_cmake = source.has("setup.py"), source.has("CMakeLists.txt")
    at = element.start if element else 0
    tools = [one for one in manifest.of("buildtool_depend") if one.text.startswith("ament_cmake")]
    if kind == "ament_python" and tools and has_setup:
        one = tools[0]
        sentence = (
            f"The build type is ament_python, and <buildtool_depend>{one.text}</buildtool_depend> "
            "is of a package that CMake builds: take it out."
        )
        mend = edit("Remove it", manifest.source.without_lines(one.start, one.end))
        yield found(WARNING, "buildtool-of-cmake", sentence, manifest.source, one.start, mend)
    wanted = ""
    if kind == "ament_python" and not has_setup and has_cmake:
        wanted, has = "ament_cmake", "a CMakeLists.txt and no setup.py"
    elif kind != "ament_python" and has_setup and not has_cmake:
        wanted, has = "ament_python", "a setup.py and no CMakeLists.txt"
    elif not has_setup and not has_cmake:
        file = "setup.py" if kind == "ament_python" else "CMakeLists.txt"
        sentence = f"The build type is {kind}, and there is no {file}: the package is not built."
        yield found(ERROR, "build-file-missing", sentence, manifest.source, at)
        return
    else:
        return
    if element is not None:
        change = manifest.source.replaced(element.inner_start, element.inner_end, wanted)
        mend = edit(f"Write {wanted}", change)
    else:
        mend = safely(f"Export {wanted}", lambda: _exported(checked, wanted))
    sentence = f"The build type is {kind}, but the package has {has}: {wanted} is meant."
    yield found(ERROR, "build-type", sentence, manifest.source, at, mend)


def _exported(checked: CheckedPackage, kind: str):  # noqa: ANN202 - replacements
    manifest = checked.source.manifest
    exports = manifest.of("export")
    element = f"<build_type>{kind}</build_type>"
    if exports and exports[0].inner_end > exports[0].inner_start:
        eol = manifest.source.line_break
        return [manifest.source.put_in(exports[0].inner_start, f"{eol}    {element}")]
    return [manifest_edits.put_element(manifest, "export", f"<export>{element}</export>")]


def _data_files(checked: CheckedPackage, setup: SetupPy) -> Iterator[Problem]:
    source = checked.source
    for row in setup.data_files:
        for one in row.sources:
            if not any(letter in one for letter in "*?[") and not source.has(one):
                if one.startswith("resource/"):
                    continue  # the marker: a check of its own
                sentence = f"data_files names {one}, which is not there: the build stops."
                yield found(ERROR, "data-file-missing", sentence, setup.source, row.start)
    at = setup.python.span(setup.call)[0] if setup.call else 0
    is_there = any("package.xml" in row.sources for row in setup.data_files)
    if not is_there and not setup.computes_data_files:
        sentence = "data_files does not install package.xml: ros2 knows nothing of the package."
        yield found(WARNING, "manifest-not-installed", sentence, setup.source, at)


WHY: Final = {
    "buildtool-of-cmake": {
        "en": "A package is built by CMake or by setuptools, never by both.",
        "de": "Ein Paket wird von CMake oder von setuptools gebaut, nie von beiden.",
    },
    "build-type": {
        "en": "colcon chooses how it builds by this word, and then misses the file for it.",
        "de": "colcon wählt danach, wie es baut, und vermisst dann die Datei dafür.",
    },
    "build-file-missing": {
        "en": "Without the file of its build type a package cannot be built.",
        "de": "Ohne die Datei seines Bautyps lässt sich ein Paket nicht bauen.",
    },
    "data-file-missing": {
        "en": "setuptools stops where a file that is to be installed is not there.",
        "de": "setuptools bricht ab, wenn eine zu installierende Datei fehlt.",
    },
    "manifest-not-installed": {
        "en": "ros2 pkg xml, and tools that look for dependencies, do not find the package.xml.",
        "de": "ros2 pkg xml und Werkzeuge, die Abhängigkeiten suchen, finden package.xml nicht.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
