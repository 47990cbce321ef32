"""Checks of a CMakeLists.txt: is it whole, is what it names there, is what is there named."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from studio.packages.edits import cmake_edits
from studio.packages.inspection.inspecting import generated_names
from studio.packages.lint.checked import ERROR, WARNING, edit, found, meant, safely
from studio.packages.lint.installed_files import FOLDERS
from studio.packages.sources.interfaces import ENDINGS, interface_files, packages_of_interface

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.lint.checked import CheckedPackage
    from studio.packages.sources.cmake import Call, CMakeLists
    from studio.problems import Problem

_ESCAPED: Final = re.compile(rb"\\\$\{[A-Za-z_]+\}")
_PLACEHOLDER: Final = re.compile(rb"<[a-z]+(?:[_ -][a-z]+)+>")
_LIBRARY_FOLDERS: Final = frozenset({"lib", "bin", "share", "include"})


def findings(checked: CheckedPackage) -> Iterator[Problem]:
    """Yield faults of the text, then of its commands."""
    lists = checked.source.cmake
    if lists is None or checked.source.is_python:
        return
    yield from _text(lists)
    if lists.fault:
        yield _unclosed(lists)
    if checked.source.build_type == "ament_cmake":
        yield from _ament(checked, lists)
    yield from _interfaces(checked, lists)
    yield from _installs(checked, lists)


def _text(lists: CMakeLists) -> Iterator[Problem]:
    source = lists.source
    for one in _ESCAPED.finditer(source.data):
        right = one[0].decode()[1:]
        mend = edit(f"Write {right}", source.replaced(one.start(), one.end(), right))
        sentence = f'The backslash before "{right}" keeps CMake from putting the name there.'
        yield found(ERROR, "cmake-escaped-variable", sentence, source, one.start(), mend)
    for one in _PLACEHOLDER.finditer(source.data):
        line = source.data[source.line_start(one.start()) : one.start()]
        if b"#" in line or b"$<" in line:
            continue
        text = one[0].decode()
        sentence = f"{text} is a placeholder: write what is meant in its place."
        yield found(ERROR, "cmake-placeholder", sentence, source, one.start())


def _unclosed(lists: CMakeLists) -> Problem:
    source = lists.source
    at = lists.fault_call[1] if lists.fault_call else source.offset(lists.fault_line)
    mend = None
    if lists.fault_call is not None:
        # The parenthesis belongs before the next line that begins a command, or a blank one.
        pattern = re.compile(rb"(\r?\n)(?=[ \t]*\r?\n|[a-z_]+[ \t]*\()")
        ended = pattern.search(source.data, at)
        end = ended.start() if ended else len(source.data.rstrip())
        many = b"\n" in source.data[at:end]
        closing = f"{source.line_break})" if many else ")"
        mend = edit("Close it", source.put_in(end, closing))
    sentence = f"{lists.fault}: every command ends with a parenthesis."
    return found(ERROR, "cmake-unclosed", sentence, source, at, mend)


def _ament(checked: CheckedPackage, lists: CMakeLists) -> Iterator[Problem]:
    source = lists.source
    if lists.project is None and not lists.fault:
        sentence = "There is no project(): CMake does not know what is built."
        yield found(ERROR, "cmake-project-missing", sentence, source)
    needed = {
        "ament_cmake": ("ament_package", "ament_lint_auto_find_test_dependencies"),
        "rosidl_default_generators": (cmake_edits.GENERATE,),
    }
    found_by_auto = lists.found_packages.keys() & {"ament_cmake_auto", "ament_cmake_ros"}
    for package, commands in needed.items():
        calls = lists.of(*commands)
        if not calls or package in lists.found_packages:
            continue
        if package == "ament_cmake" and found_by_auto:
            continue
        yield _not_found(lists, package, calls[0], f"{calls[0].name}() comes of {package}")
    if not lists.fault and not lists.of("ament_package", "ament_auto_package"):
        eol = source.line_break
        lead = "" if source.data.endswith(b"\n") else eol
        mend = None
        if source.data:
            mend = edit(
                "Add ament_package()",
                source.put_in(len(source.data), f"{lead}{eol}ament_package(){eol}"),
            )
        sentence = "ament_package() is missing, which comes last: ROS does not find the package."
        yield found(ERROR, "ament-package-missing", sentence, source, 0, mend)
    yield from _linked(checked, lists)


def _linked(checked: CheckedPackage, lists: CMakeLists) -> Iterator[Problem]:
    said: set[str] = set()
    own = {
        checked.source.name,
        *(one.values[0] for one in lists.of("add_library") if one.arguments),
    }
    for call in lists.of("ament_target_dependencies"):
        for one in call.arguments[1:]:
            name = one.value
            if name in {"PUBLIC", "INTERFACE", "PRIVATE", "SYSTEM"} or "$" in name:
                continue
            if name in lists.found_packages or name in said or name in own:
                continue
            said.add(name)
            yield _not_found(lists, name, call, f"ament_target_dependencies() names {name}")


def _not_found(lists: CMakeLists, package: str, call: Call, why: str) -> Problem:
    mend = safely(
        f"Add find_package({package} REQUIRED)",
        lambda: cmake_edits.found_packages(lists, [package]),
    )
    sentence = f"{why}, and there is no find_package({package} REQUIRED)."
    return found(ERROR, "find-package-missing", sentence, lists.source, call.start, mend)


def _interfaces(checked: CheckedPackage, lists: CMakeLists) -> Iterator[Problem]:
    source = checked.source
    files = interface_files(source)
    calls = lists.of(cmake_edits.GENERATE)
    early = [one for one in calls if len(one.arguments) < 2]
    for one in early:
        yield _closed_early(lists, one)
    if early:
        return
    listed = generated_names(source)
    for kind, name in files:
        if name in listed or (lists.fault and not calls):
            continue
        text = source.text(name)
        packages = packages_of_interface(text.text, kind, source.name) if text else ()
        mend = safely(
            f"List {name}",
            lambda name=name, packages=packages: cmake_edits.generated(lists, name, packages),
        )
        sentence = f"{name} is not listed in rosidl_generate_interfaces(): no code is made of it."
        at = calls[0].start if calls else 0
        yield found(ERROR, "interface-not-listed", sentence, lists.source, at, mend)
    for call in calls:
        depends = {one.value for one in call.after("DEPENDENCIES", "LIBRARY_NAME")}
        for one in call.arguments[1:]:
            if one.value.endswith(ENDINGS) and "$" not in one.value:
                if source.has(one.value):
                    continue
                right = meant(one.value, [name for _, name in files], 0.6)
                mend = None
                if right and right not in listed:
                    text = f'"{right}"' if one.is_quoted else right
                    mend = edit(f"Write {right}", lists.source.replaced(one.start, one.end, text))
                sentence = f"{one.value} is listed, and there is no such file."
                at = one.start
                yield found(ERROR, "interface-file-missing", sentence, lists.source, at, mend)
        yield from _needed(checked, lists, call, depends, files)


def _closed_early(lists: CMakeLists, call: Call) -> Problem:
    """`rosidl_generate_interfaces(${PROJECT_NAME})` with its files behind the parenthesis."""
    source = lists.source
    behind = re.compile(
        rb'\)\s*(?P<files>(?:"?(?:msg|srv|action)/[\w<>.]+"?\s*)+)(?P<rest>(?:DEPENDENCIES[^()]*)?)\)?'
    )
    match = behind.match(source.data, call.end - 1)
    mend = None
    if match is not None:
        # What is left may close the command itself, or not at all.
        rest = match["rest"].rstrip()
        eol = source.line_break.encode()
        body = eol.join(b"  " + one for one in match["files"].split())
        text = eol + body + (eol + b"  " + b" ".join(rest.split()) if rest else b"") + eol + b")"
        tail = b"" if source.data[match.end() : match.end() + 1] in (b"", b"\n", b"\r") else eol
        mend = edit(
            "Put the files inside",
            source.replaced(call.end - 1, match.end(), (text + tail).decode("utf-8", "replace")),
        )
    sentence = (
        "rosidl_generate_interfaces() lists no file: its files stand inside the parenthesis, "
        'behind ${PROJECT_NAME}: "srv/GetNowPlaying.srv".'
    )
    return found(ERROR, "interfaces-closed-early", sentence, source, call.start, mend)


def _needed(
    checked: CheckedPackage,
    lists: CMakeLists,
    call: Call,
    depends: set[str],
    files: list[tuple[str, str]],
) -> Iterator[Problem]:
    source = checked.source
    listed = {one.value for one in call.arguments}
    said: set[str] = set()
    for kind, name in files:
        text = source.text(name) if name in listed else None
        for package in packages_of_interface(text.text, kind, source.name) if text else ():
            if package in depends or package in said or package == "action_msgs":
                continue
            said.add(package)
            mend = safely(
                f"Add {package}",
                lambda name=name, package=package: cmake_edits.generated(lists, name, [package]),
            )
            sentence = f"{name} uses types of {package}, which DEPENDENCIES does not name."
            code = "interface-dependency"
            yield found(ERROR, code, sentence, lists.source, call.start, mend)


def _installs(checked: CheckedPackage, lists: CMakeLists) -> Iterator[Problem]:
    for call in lists.of("install"):
        yield from _installed_folders(checked, lists, call)
        yield from _destination(lists, call)


def _installed_folders(checked: CheckedPackage, lists: CMakeLists, call: Call) -> Iterator[Problem]:
    source = checked.source
    for one in call.after("DIRECTORY", "DESTINATION", "PATTERN", "FILES_MATCHING", "REGEX"):
        folder = one.value.rstrip("/")
        is_there = source.has_folder(folder) or source.path(folder).is_dir()
        if folder and "$" not in folder and not is_there:
            sentence = f"install(DIRECTORY) names {folder}, which is not there: the build stops."
            yield found(ERROR, "install-folder-missing", sentence, lists.source, one.start)


def _destination(lists: CMakeLists, call: Call) -> Iterator[Problem]:
    keywords = ("DIRECTORY", "FILES", "PROGRAMS", "TARGETS", "PATTERN")
    destination = next(iter(call.after("DESTINATION", *keywords)), None)
    if destination is None:
        return
    at = destination.start
    parts = destination.value.strip("/").split("/")
    if parts[0] == "share" and len(parts) > 2 and len(parts[2]) <= 3:
        folders = [one for one in FOLDERS if one.startswith(parts[2]) and one != parts[2]]
        if len(folders) == 1:
            right = "/".join([*parts[:2], folders[0], *parts[3:]])
            mend = edit(f"Write {right}", lists.source.replaced(at, destination.end, right))
            sentence = f"DESTINATION {destination.value} breaks off: {right} is meant."
            yield found(ERROR, "install-destination", sentence, lists.source, at, mend)
    elif parts[0] not in _LIBRARY_FOLDERS and "$" not in parts[0]:
        sentence = (
            f"DESTINATION {destination.value} is no folder in which ROS looks: "
            "share/${PROJECT_NAME}, say."
        )
        yield found(WARNING, "install-destination", sentence, lists.source, at)


_STOPS: Final = {
    "en": "CMake stops there, and nothing is built.",
    "de": "CMake bricht dort ab, und nichts wird gebaut.",
}
WHY: Final = {
    "cmake-escaped-variable": {
        "en": "The folder is called ${PROJECT_NAME} then, letter by letter.",
        "de": "Der Ordner heißt dann buchstäblich ${PROJECT_NAME}.",
    },
    "cmake-placeholder": _STOPS,
    "cmake-unclosed": _STOPS,
    "cmake-project-missing": _STOPS,
    "ament-package-missing": {
        "en": "ament_package() makes the entry by which ROS finds the package.",
        "de": "ament_package() legt den Eintrag an, über den ROS das Paket findet.",
    },
    "find-package-missing": {
        "en": "A command or package is only known once find_package() has loaded it.",
        "de": "Ein Befehl oder Paket ist erst bekannt, wenn find_package() es geladen hat.",
    },
    "interface-not-listed": {
        "en": "Nodes cannot import a type of which no code was made.",
        "de": "Nodes können keinen Typ importieren, für den kein Code erzeugt wurde.",
    },
    "interface-file-missing": _STOPS,
    "interfaces-closed-early": _STOPS,
    "interface-dependency": {
        "en": "The code of an interface is made with the types that it is made of.",
        "de": "Der Code eines Interfaces entsteht aus den Typen, aus denen es besteht.",
    },
    "install-folder-missing": _STOPS,
    "install-destination": {
        "en": "ROS looks in share/<package> and lib/<package>; elsewhere nothing is found.",
        "de": "ROS sucht in share/<Paket> und lib/<Paket>; anderswo wird nichts gefunden.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
