"""What is known beside the packages that are looked at: types, packages, and what a type may be."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

from studio.packages.ros_packages import PACKAGES


@dataclass(frozen=True, slots=True)
class TypeFault:
    """Why a text defines no message, service or action: a sentence; `line` is 0 if not known."""

    sentence: str
    line: int = 0


TypeCheck: TypeAlias = Callable[[str, str], TypeFault | None]
"""Called with the full name of a type and its text; None: it is valid."""


def _no_fault(_name: str, _text: str) -> TypeFault | None:
    return None


@dataclass(frozen=True)
class Known:
    """What ROS and the studio have.

    Attributes:
        types: Full names of message, service and action types: `std_msgs/msg/String`.
        packages: Names of packages of ROS.
        installed: Names of packages that are opened beside these, or in a ROS that was sourced.
        type_fault: Says what is wrong with the text of a type.
    """

    types: frozenset[str] = frozenset()
    packages: frozenset[str] = PACKAGES
    installed: frozenset[str] = frozenset()
    type_fault: TypeCheck = _no_fault

    @cached_property
    def types_by_package(self) -> dict[str, frozenset[str]]:
        """The names of types, in full, by their package."""
        found: dict[str, set[str]] = defaultdict(set)
        for one in self.types:
            found[one.partition("/")[0]].add(one)
        return {name: frozenset(types) for name, types in found.items()}

    def has_package(self, name: str) -> bool:
        """Whether a package of that name is known."""
        return name in self.packages or name in self.installed or name in self.types_by_package
