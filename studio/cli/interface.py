"""`studio interface`: which types there are, and what they are made of."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from studio.cli.interface_asking import library_with
from studio.cli.interface_types import known_types, say_faults
from studio.cli.pasted_types import PASTED, is_pasted
from studio.cli.verbs import Verbs
from studio.cli.wire import add_wire_options, profile_of
from studio.errors import SettingsError, UnknownTypeError
from studio.ros.names import full_type_name

if TYPE_CHECKING:
    import argparse

    from studio.ros.types.library import TypeLibrary

_NAME_CHARACTERS_MAX = 1_000
_TITLES = {"msg": "Messages", "srv": "Services", "action": "Actions"}


def add(parser: argparse.ArgumentParser) -> None:
    """Give the parser the verbs of `interface`."""
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
    if not options.interfaces:  # else said when they were read
        say_faults(library.faults().values())


def _packages(options: argparse.Namespace) -> None:
    kinds = options.kinds or list(_TITLES)
    names = (name.split("/") for name in _library(options).names())
    print(*sorted({package for package, kind, _ in names if kind in kinds}), sep="\n")


def _package(options: argparse.Namespace) -> int:
    wanted = f"{options.package_name}/"
    library = _library(options)
    names = [name for name in library.names() if name.startswith(wanted)]
    faults = [fault for name, fault in library.faults().items() if name.startswith(wanted)]
    if not options.interfaces:  # else said when they were read
        say_faults(faults)
    if not names and not faults:
        raise UnknownTypeError(options.package_name, f"no package {options.package_name} has types")
    print("".join(f"{name}\n" for name in names), end="")
    return 0


def _show(options: argparse.Namespace) -> None:
    from studio.cli.type_text import Comments, type_text

    comments = Comments.OWN
    if options.no_comments:
        comments = Comments.NONE
    elif options.all_comments:
        comments = Comments.ALL
    name = _type_name(options)
    print(type_text(library_with(options, name), name, comments), end="")


def _hash(options: argparse.Namespace) -> None:
    name = _type_name(options)
    print(library_with(options, name).hash_of(name))


def _type_name(options: argparse.Namespace) -> str:
    """Give the type that is meant: `topic type` may be piped into these verbs.

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
    library = library_with(options, name)
    asked = messages_of(library.interface(name))[0]
    text = to_yaml(library.message(asked.name)())
    print(text if options.no_quotes else f'"{text}"', end="" if options.no_quotes else "\n")
