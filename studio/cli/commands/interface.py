"""`studio interface`: list and show message, service and action types."""

from __future__ import annotations

import re
import sys
from enum import Enum, auto
from typing import TYPE_CHECKING

from studio.cli.interface_types import PASTED, is_pasted, known_types, print_faults
from studio.cli.verbs import Verbs
from studio.cli.wire import add_wire_options, profile_of
from studio.errors import SettingsError, UnknownTypeError, WireError
from studio.ros.names import full_type_name
from studio.ros.types.definitions import messages_of
from studio.ros.types.interface_text import text_of

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    from studio.ros.types.definitions import Interface
    from studio.ros.types.library import TypeLibrary


_NAME_CHARACTERS_MAX = 1_000
_TITLES = {"msg": "Messages", "srv": "Services", "action": "Actions"}


def add(parser: argparse.ArgumentParser) -> None:
    """Add the verbs of `interface` to the parser."""
    verbs = Verbs(parser)
    for name, run, summary in (
        ("list", _list, "name every type that is known"),
        ("packages", _packages, "name the packages that define types"),
    ):
        verb = verbs.add(name, run, summary)
        _add_kinds(verb)
        add_wire_options(verb)
    package = verbs.add("package", _package, "name the types of one package")
    package.add_argument("package_name", metavar="PACKAGE")
    add_wire_options(package)
    show = verbs.add("show", _show, "print a type with the fields of all that it is made of")
    show.add_argument(
        "type", metavar="TYPE",
        help="for example geometry_msgs/msg/Pose; - reads it from standard input",
    )  # fmt: skip
    show.add_argument("--no-comments", action="store_true", help="leave all comments out")
    show.add_argument("--all-comments", action="store_true", help="those of nested types, too")
    add_wire_options(show)
    type_hash = verbs.add("hash", _hash, "print the hash by which nodes know a type from another")
    type_hash.add_argument("type", metavar="TYPE", help="as for show")
    add_wire_options(type_hash)
    proto = verbs.add("proto", _proto, "print a value of a type as YAML, to fill in")
    proto.add_argument("type", metavar="TYPE", help="as for show")
    proto.add_argument("--no-quotes", action="store_true", help="leave the outer quotes out")
    add_wire_options(proto)


def _add_kinds(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("-m", "--only-msgs", action="append_const", dest="kinds", const="msg")
    parser.add_argument("-s", "--only-srvs", action="append_const", dest="kinds", const="srv")
    parser.add_argument("-a", "--only-actions", action="append_const", dest="kinds", const="action")


def _library(options: argparse.Namespace) -> TypeLibrary:
    return known_types(options, profile_of(options).distro)


def _list(options: argparse.Namespace) -> None:
    library = _library(options)
    names = library.names()
    for kind in options.kinds or _TITLES:
        print(f"{_TITLES[kind]}:")
        for name in names:
            if f"/{kind}/" in name:
                print(f"    {name}")
    if not options.interfaces:  # else printed when they were read
        print_faults(library.faults().values())


def _packages(options: argparse.Namespace) -> None:
    kinds = options.kinds or list(_TITLES)
    names = (name.split("/") for name in _library(options).names())
    print(*sorted({package for package, kind, _ in names if kind in kinds}), sep="\n")


def _package(options: argparse.Namespace) -> int:
    wanted = f"{options.package_name}/"
    library = _library(options)
    names = [name for name in library.names() if name.startswith(wanted)]
    faults = [fault for name, fault in library.faults().items() if name.startswith(wanted)]
    if not options.interfaces:  # else printed when they were read
        print_faults(faults)
    if not names and not faults:
        raise UnknownTypeError(options.package_name, f"no package {options.package_name} has types")
    print("".join(f"{name}\n" for name in names), end="")
    return 0


def _show(options: argparse.Namespace) -> None:

    comments = _Comments.OWN
    if options.no_comments:
        comments = _Comments.NONE
    elif options.all_comments:
        comments = _Comments.ALL
    name = _type_name(options)
    print(_type_text(_library_with(options, name), name, comments), end="")


def _hash(options: argparse.Namespace) -> None:
    name = _type_name(options)
    print(_library_with(options, name).hash_of(name))


def _type_name(options: argparse.Namespace) -> str:
    """Return the type that is meant: `topic type` may be piped into these verbs.

    Raises:
        RosNameError: It names no type.
        SettingsError: Standard input holds texts of types already.
    """
    if options.type.strip() != PASTED:
        return full_type_name(options.type)
    if any(is_pasted(path) for path in options.interfaces):
        raise SettingsError("Standard input is read once: as TYPE or for --interfaces, not both.")
    return full_type_name(sys.stdin.readline(_NAME_CHARACTERS_MAX).strip())


def _proto(options: argparse.Namespace) -> None:
    from studio.ros.types.convert import to_yaml
    from studio.ros.types.definitions import messages_of

    name = _type_name(options)
    library = _library_with(options, name)
    asked = messages_of(library.interface(name))[0]
    text = to_yaml(library.message(asked.name)())
    print(text if options.no_quotes else f'"{text}"', end="" if options.no_quotes else "\n")


_FIELD = re.compile(r"\s*([A-Za-z][\w/]*)\S*\s+([A-Za-z]\w*)\s*(?!\s*=)")


class _Comments(Enum):
    """Which comments of the definitions are printed."""

    NONE = auto()
    OWN = auto()
    """Those of the type that was asked for."""
    ALL = auto()


def _type_text(library: TypeLibrary, name: str, comments: _Comments) -> str:
    """Write a type by its full name, each line with its end.

    Raises:
        UnknownTypeError: It, or what it is made of, is not known.
    """
    interface = library.interface(name)
    text = library.text_of(name) or _written(interface)
    nested = [
        {field.name: field.type.base for field in part.fields if field.type.nested}
        for part in messages_of(interface)
    ]
    return "".join(f"{line}\n" for line in _Writer(library, comments).lines(text, nested, 0))


class _Writer:
    def __init__(self, library: TypeLibrary, comments: _Comments) -> None:
        self._library, self._comments = library, comments

    def lines(self, text: str, nested: list[dict[str, str]], level: int) -> Iterator[str]:
        """Yield the lines of a text; below each field of a message, those of that message."""
        part = 0
        keeps = self._comments is _Comments.ALL or (self._comments is _Comments.OWN and not level)
        for line in text.strip("\n").split("\n"):
            code = _without_comment(line)
            if keeps or code.strip():
                yield "\t" * level + (line if keeps else code).rstrip()
            if code.strip() == "---":
                part += 1
                continue
            field = _FIELD.match(code)
            if field and field[2] in nested[part]:
                yield from self._inner(nested[part][field[2]], level + 1)

    def _inner(self, name: str, level: int) -> Iterator[str]:
        message = self._library.find(name)
        fields = {field.name: field.type.base for field in message.fields if field.type.nested}
        text = self._library.text_of(name) or _written(message)
        yield from self.lines(text, [fields], level)


def _written(interface: Interface) -> str:
    """Write a type that came without a text, its package's own types without the package."""
    package = interface.name.partition("/")[0]
    return re.sub(rf"^{package}/", "", text_of(interface), flags=re.MULTILINE)


def _without_comment(line: str) -> str:
    """Cut a comment off; a `#` within quotes is none."""
    quote = ""
    for at, letter in enumerate(line):
        if quote:
            quote = "" if letter == quote and line[at - 1] != "\\" else quote
        elif letter in "\"'":
            quote = letter
        elif letter == "#":
            return line[:at]
    return line


def _library_with(options: argparse.Namespace, name: str) -> TypeLibrary:
    """Make the library of a line that is about one type.

    Raises:
        UnknownTypeError: It is not known, nor to any node that can be asked.
    """
    library = known_types(options, profile_of(options).distro)
    try:
        library.hash_of(name)
    except UnknownTypeError:
        asked = _asked(options, name)
        if asked is None:
            raise
        return asked
    return library


def _asked(options: argparse.Namespace, name: str) -> TypeLibrary | None:
    """Ask the nodes that use a type; None if there are none, or none describes it."""
    from studio.cli.own_node import learn_type, own_node
    from studio.ros.type_lookup import users_of

    if any(is_pasted(path) for path in options.interfaces):
        return None  # what was pasted is read, and cannot be again
    try:
        with own_node(options) as own:
            learn_type(own, users_of(own.graph, name))
            own.types.hash_of(name)
            return own.types
    except WireError:
        return None
