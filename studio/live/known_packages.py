"""What ROS and the studio have, for looking at packages: types, and what the text of one may be."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.errors import InterfaceTextError, RosNameError
from studio.packages.known import Known, TypeFault

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.ros.types.library import TypeLibrary


def known_packages(library: TypeLibrary, installed: Iterable[str] = ()) -> Known:
    """Return what is known by a library of types.

    Args:
        library: Of the distribution.
        installed: Names of packages of a ROS that was sourced, or opened beside these.
    """
    return Known(
        types=frozenset(library.names()), installed=frozenset(installed), type_fault=type_fault
    )


def type_fault(name: str, text: str) -> TypeFault | None:
    """Return why a text does not define the type of that name; None if it does."""
    from studio.ros.types.interface_text import parse_interface  # noqa: PLC0415 - takes its time

    try:
        parse_interface(name, text)
    except InterfaceTextError as error:
        return TypeFault(f"{error.reason.rstrip('.')}.", error.line or 0)
    except RosNameError as error:
        return TypeFault(f"{error.reason.rstrip('.')}.")
    return None
