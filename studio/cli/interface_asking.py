"""Types that only other nodes know: `interface` asks those nodes where nobody else knows one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.cli.interface_types import known_types
from studio.cli.pasted_types import is_pasted
from studio.cli.wire import profile_of
from studio.errors import UnknownTypeError, WireError

if TYPE_CHECKING:
    import argparse

    from studio.ros.types.library import TypeLibrary


def library_with(options: argparse.Namespace, name: str) -> TypeLibrary:
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
    """Ask the nodes that use a type; None when there are none, or none says what it is."""
    from studio.cli.acting import acting
    from studio.cli.learning import learn_type
    from studio.ros.type_lookup import users_of

    if any(is_pasted(path) for path in options.interfaces):
        return None  # what was pasted is read, and cannot be again
    try:
        with acting(options) as actor:
            learn_type(actor, users_of(actor.graph, name))
            actor.types.hash_of(name)
            return actor.types
    except WireError:
        return None
