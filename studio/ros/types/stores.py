"""The messages of each distribution, from the stores that rosbags carries."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any, cast

from rosbags.interfaces import Nodetype

from studio.ros.types.definitions import (
    DUMMY_FIELD,
    PRIMITIVES,
    Constant,
    Field,
    FieldType,
    Message,
    Scalar,
    Shape,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

# Constants and fields as rosbags writes them: plain tuples, made to be read by its own code.
_Described = tuple[list[tuple[str, str, Scalar]], list[tuple[str, Any]]]


class MessageStore:
    """The messages of one distribution, each made when it is first asked for."""

    def __init__(self, distro: str) -> None:
        module = importlib.import_module(f"rosbags.typesys.stores.ros2_{distro}")
        self._described = cast("Mapping[str, _Described]", module.FIELDDEFS)

    def names(self) -> list[str]:
        """Name every message of the store."""
        return list(self._described)

    def find(self, name: str) -> Message | None:
        """Give a message by its full name, None when the store has none such."""
        described = self._described.get(name)
        if described is None:
            return None
        constants, fields = described
        return Message(
            name,
            tuple(_field(*field) for field in fields if field[0] != DUMMY_FIELD),
            tuple(_constant(*constant) for constant in constants),
        )


def _constant(name: str, base: str, value: Scalar) -> Constant:
    return Constant(name, base, bool(value) if base == "bool" else value)


def _field(name: str, described: tuple[Nodetype, Any]) -> Field:
    node, inner = described
    if node is Nodetype.ARRAY:
        base, bound = _base(inner[0])
        return Field(name, FieldType(base, Shape.ARRAY, inner[1], bound))
    if node is Nodetype.SEQUENCE:
        base, bound = _base(inner[0])
        shape = Shape.BOUNDED if inner[1] else Shape.SEQUENCE
        return Field(name, FieldType(base, shape, inner[1], bound))
    base, bound = _base(described)
    return Field(name, FieldType(base, string_bound=bound))


def _base(described: tuple[Nodetype, Any]) -> tuple[str, int]:
    """Give the name and the bound of a string, 0 without."""
    node, inner = described
    if node is Nodetype.NAME:
        return inner, 0
    base, bound = inner
    if base not in PRIMITIVES:
        raise NotImplementedError(base)
    return base, bound
