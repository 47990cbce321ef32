"""Changes of a CMakeLists.txt: packages found, interfaces generated, what is installed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.packages.sources.interfaces import ENDINGS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.packages.sources.cmake import Argument, Call, CMakeLists
    from studio.problems import Replacement

GENERATE: Final = "rosidl_generate_interfaces"
_GENERATE_KEYWORDS: Final = ("DEPENDENCIES", "LIBRARY_NAME", "SKIP_INSTALL", "ADD_LINTER_TESTS")


def check_whole(lists: CMakeLists) -> None:
    """Refuse a file that is broken.

    Raises:
        ValueError: It is.
    """
    if lists.fault or not lists.source.is_utf8:
        raise ValueError(lists.source.file)


def found_packages(lists: CMakeLists, names: Iterable[str]) -> tuple[Replacement, ...]:
    """Return the change that finds these packages, behind those that are found already.

    Raises:
        ValueError: The file is broken, or has nothing behind which it could stand.
    """
    check_whole(lists)
    missing = [one for one in dict.fromkeys(names) if one not in lists.found_packages]
    if not missing:
        return ()
    at = _behind_found(lists)
    source = lists.source
    lines = "".join(f"{source.line_break}find_package({one} REQUIRED)" for one in missing)
    return (source.put_in(at, lines),)


def _behind_found(lists: CMakeLists) -> int:
    """Return where a `find_package` belongs: behind the last one outside of any block."""
    depth, found = 0, None
    for call in lists.calls:
        depth += call.name in {"if", "foreach", "function", "macro", "while"}
        depth -= call.name in {"endif", "endforeach", "endfunction", "endmacro", "endwhile"}
        if depth == 0 and call.name == "find_package":
            found = call
    last = found or next(iter(lists.of("project")), None)
    if last is None:
        raise ValueError(lists.source.file)
    return last.end


def generated(lists: CMakeLists, name: str, packages: Iterable[str]) -> tuple[Replacement, ...]:
    """Return the changes that generate one more interface, which needs these packages.

    An existing call gets the name behind its other interfaces and the packages behind
    DEPENDENCIES; else a call is made, before `ament_package()`.

    Raises:
        ValueError: The file is broken, or has no place for it.
    """
    check_whole(lists)
    needed = list(dict.fromkeys(packages))
    changes = [*found_packages(lists, ["rosidl_default_generators", *needed])]
    calls = lists.of(GENERATE)
    if calls:
        return (*changes, *_listed(lists, calls[0], name, needed))
    source = lists.source
    eol = source.line_break
    lines = [f"{GENERATE}(${{PROJECT_NAME}}", f'  "{name}"']
    if needed:
        lines.append(f"  DEPENDENCIES {' '.join(needed)}")
    call = eol.join([*lines, ")", "", "ament_export_dependencies(rosidl_default_runtime)", "", ""])
    return (*changes, source.put_in(_before_package(lists), call))


def _listed(
    lists: CMakeLists, call: Call, name: str, packages: list[str]
) -> tuple[Replacement, ...]:
    source = lists.source
    changes: list[Replacement] = []
    if not call.arguments:
        raise ValueError(source.file)
    holder = _holder(lists, call)
    names = [one for one in holder.arguments if one.value.endswith(ENDINGS)]
    if name not in {one.value for one in names}:
        last = names[-1] if names else call.arguments[0]
        text = f'"{name}"' if last.is_quoted or not names else name
        changes.append(_behind(lists, last, holder if names else call, text))
    depends = call.after(
        "DEPENDENCIES", *(one for one in _GENERATE_KEYWORDS if one != "DEPENDENCIES")
    )
    known = {one.value for one in depends}
    missing = [one for one in packages if one not in known]
    if missing and depends:
        changes += [_behind(lists, depends[-1], call, one) for one in missing]
    elif missing:
        at = call.end - 1
        start = source.line_start(at)
        alone = not source.data[start:at].strip()
        text = f"  DEPENDENCIES {' '.join(missing)}"
        changes.append(
            source.put_in(start, f"{text}{source.line_break}")
            if alone
            else source.put_in(at, f"{source.line_break}{text}")
        )
    return tuple(changes)


def _holder(lists: CMakeLists, call: Call) -> Call:
    """Return the command in which interfaces are listed: the call, or `set` of its variable."""
    if any(one.value.endswith(ENDINGS) for one in call.arguments):
        return call
    variables = {one.value.strip("${}") for one in call.arguments[1:] if one.value[:1] == "$"}
    for one in lists.of("set"):
        listed = any(each.value.endswith(ENDINGS) for each in one.arguments)
        if listed and one.arguments[0].value in variables:
            return one
    return call


def _behind(lists: CMakeLists, argument: Argument, call: Call, text: str) -> Replacement:
    """Put an argument behind another one: on a line of its own where that one has its own."""
    source = lists.source
    start = source.line_start(argument.start)
    own_line = start > call.start and not source.data[start : argument.start].strip()
    if own_line or argument is call.arguments[0]:
        indent = source.indent_at(argument.start) if own_line else "  "
        return source.put_in(argument.end, f"{source.line_break}{indent}{text}")
    return source.put_in(argument.end, f" {text}")


def installed_folder(lists: CMakeLists, folder: str) -> tuple[Replacement, ...]:
    """Return the change that installs a folder of the package into its share folder.

    Raises:
        ValueError: The file is broken, or has no place for it.
    """
    check_whole(lists)
    share = ("share/${PROJECT_NAME}", "share/${PROJECT_NAME}/")
    others = ("DESTINATION", "PATTERN", "REGEX", "FILES_MATCHING", "USE_SOURCE_PERMISSIONS")
    for call in lists.of("install"):
        folders = call.after("DIRECTORY", *others)
        named = {one.value.rstrip("/") for one in folders}
        if folder in named:
            return ()
        destination = call.after("DESTINATION", "PATTERN", "REGEX", "FILES_MATCHING")
        is_share = bool(destination) and destination[0].value in share
        if folders and is_share and not any(one.value.endswith("/") for one in folders):
            return (_behind(lists, folders[-1], call, folder),)
    eol = lists.source.line_break
    text = eol.join(
        ["install(", f"  DIRECTORY {folder}", "  DESTINATION share/${PROJECT_NAME}", ")", "", ""]
    )
    return (lists.source.put_in(_before_package(lists), text),)


def installed_program(lists: CMakeLists, name: str) -> tuple[Replacement, ...]:
    """Return the change that installs a script of the package where `ros2 run` finds it.

    Raises:
        ValueError: The file is broken, or has no place for it.
    """
    check_whole(lists)
    for call in lists.of("install"):
        programs = call.after("PROGRAMS", "DESTINATION")
        if name in {one.value for one in programs}:
            return ()
        if programs and "lib/${PROJECT_NAME}" in call.values:
            return (_behind(lists, programs[-1], call, name),)
    eol = lists.source.line_break
    text = eol.join(
        ["install(", f"  PROGRAMS {name}", "  DESTINATION lib/${PROJECT_NAME}", ")", "", ""]
    )
    return (lists.source.put_in(_before_package(lists), text),)


def _before_package(lists: CMakeLists) -> int:
    """Return where a rule belongs: before the tests, else before `ament_package()`, else last."""
    source = lists.source
    for call in lists.calls:
        if call.name == "if" and "BUILD_TESTING" in call.values:
            return source.line_start(call.start)
        if call.name in {"ament_package", "ament_auto_package", "catkin_package"}:
            return source.line_start(call.start)
    if not lists.calls or not source.data.endswith(b"\n"):
        raise ValueError(source.file)
    return len(source.data)
