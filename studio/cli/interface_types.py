"""The types that a command knows: ROS's, the studio's, of opened packages, and pasted ones."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from studio.cli.packages import add_package_options, opened_packages
from studio.cli.terminal import harmless
from studio.errors import RosNameError, SettingsError, StudioError
from studio.ros.names import KINDS, full_type_name
from studio.ros.types.files import texts_of_package

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterable, Sequence

    from studio.errors import InterfaceTextError
    from studio.ros.types.library import TypeLibrary


PASTED = "-"
"""The argument of `--interfaces`."""
CHARACTERS_MAX = 10_000_000
# As recorded files write the types that a type is made of.
_HEAD = re.compile(r"(MSG|SRV|ACTION):[ \t]*(\S+)[ \t]*")
_RULE = re.compile(r"={3,}[ \t]*")


def is_pasted(path: Path) -> bool:
    """Whether a path of `--interfaces` means standard input."""
    return str(path).strip() == PASTED  # a lone dash is shielded by a blank


def pasted_texts(source: TextIO) -> dict[str, str]:
    """Read texts by the full names of their types, to the end of the input.

    Raises:
        SettingsError: A text has no line above it that names its type, or there is too much.
    """
    text = source.read(CHARACTERS_MAX + 1)
    if len(text) > CHARACTERS_MAX:
        raise SettingsError(f"--interfaces -: more than {CHARACTERS_MAX} characters came.")
    found = _parted(text.splitlines())
    if not found:
        raise SettingsError(_refusal("nothing came"))
    return found


def _parted(lines: Iterable[str]) -> dict[str, str]:
    found: dict[str, list[str]] = {}
    current: list[str] | None = None
    for line in lines:
        head = _HEAD.fullmatch(line)
        if head is not None:
            current = found.setdefault(_name(head[2], head[1].lower()), [])
        elif current is not None and not _RULE.fullmatch(line):
            current.append(f"{line}\n")
        elif current is None and line.strip():
            raise SettingsError(_refusal(f'"{line[:40]}" comes first'))
    return {name: "".join(text) for name, text in found.items()}


def _name(given: str, kind: str) -> str:
    try:
        return full_type_name(given, kind)
    except RosNameError as error:
        raise SettingsError(f"--interfaces -: {error}") from None


def _refusal(what: str) -> str:
    return (
        f"--interfaces -: {what}, where a line such as MSG: my_interfaces/Telemetry "
        "is to name what the text below it defines."
    )


def add_type_options(parser: argparse.ArgumentParser) -> None:
    """Options of every verb that needs types."""
    add_interfaces_option(
        parser,
        "take the types of a package's folder, a folder of packages, or of one "
        ".msg, .srv or .action file; - takes what is pasted, each text below a line such as "
        '"MSG: my_interfaces/Telemetry"; nothing is built; may be given again',
    )
    add_package_options(parser)


def add_interfaces_option(parser: argparse.ArgumentParser, text: str) -> None:
    """Add the option for types of one's own, with its text in the help."""
    parser.add_argument(
        "--interfaces", action="append", default=[], type=Path, metavar="PATH", help=text
    )


def known_types(options: argparse.Namespace, distro: str) -> TypeLibrary:
    """Make the library of a distribution with the user's own types.

    A text that breaks a rule is left out: the library reports it, and a warning is printed at once
    where `--interfaces` names it.

    Raises:
        UnreadableFileError: What `--interfaces` names does not exist, or has no types.
        SettingsError: A pasted text does not name the types it defines.
        WireSettingsError: What the environment names does not exist, or has no types.
    """
    from studio.ros.messages import add_own_types
    from studio.ros.types.files import InterfaceTexts, texts_at
    from studio.ros.types.library import TypeLibrary

    library = TypeLibrary(distro)
    index = opened_packages(options)
    for name in sorted(index.names):
        _take_package(library, index.best(name, Path.cwd()), name)
    add_own_types(library)
    for path in options.interfaces:
        found = (
            InterfaceTexts(pasted_texts(sys.stdin))
            if is_pasted(path)
            else texts_at(path.expanduser().absolute())
        )
        print_faults(library.add_sound_texts(found).values())
    return library


def print_faults(faults: Iterable[InterfaceTextError]) -> None:
    """Print on stderr which texts define no type, and why."""
    for fault in faults:
        print(f"WARNING: {harmless(str(fault))}", file=sys.stderr)


def environment_with(paths: Sequence[Path]) -> dict[str, str]:
    """Return an environment in which the nodes of other processes know the types at paths, too.

    Raises:
        UnreadableFileError: Nothing is there, or it holds no types.
    """
    from studio.ros.messages import INTERFACES_VARIABLE
    from studio.ros.types.files import texts_at

    absolute = [path.expanduser().absolute() for path in paths]
    for path in absolute:
        texts_at(path)
    before = os.environ.get(INTERFACES_VARIABLE, "")
    named = [*filter(None, before.split(os.pathsep)), *map(str, absolute)]
    added = {INTERFACES_VARIABLE: os.pathsep.join(named)} if named else {}
    return {**os.environ, **added}


def _take_package(library: TypeLibrary, folder: Path, name: str) -> None:
    """Take what an opened package defines; one that as a whole cannot be read is passed over."""
    if not any((folder / kind).is_dir() for kind in KINDS):
        return
    try:
        library.add_sound_texts(texts_of_package(folder, name))
    except StudioError:
        return
