"""How deep and how large a type may be, so that no text makes one that cannot be held."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.errors import InterfaceTextError, UnknownTypeError
from studio.ros.types.definitions import Field, Message, Shape

if TYPE_CHECKING:
    from collections.abc import Callable

DEPTH_MAX = 32
# Values that one message holds at least: the fixed arrays of it, multiplied.
VALUES_MAX = 16_000_000
# Fixed arrays of messages and texts: each place becomes code of its own in the codec.
PLACES_MAX = 4_096


def check_sizes(message: Message, find: Callable[[str], Message]) -> None:
    """Refuse a type that is part of itself, too deep, or large before a value is in it.

    Raises:
        InterfaceTextError: It is; the path is told.
        UnknownTypeError: What it is made of is not known.
    """
    _Walk(find).measure(message, ())


class _Walk:
    """One look through a type; what was measured once is not walked again."""

    def __init__(self, find: Callable[[str], Message]) -> None:
        self._find = find
        self._measured: dict[str, tuple[int, int]] = {}

    def measure(self, message: Message, above: tuple[str, ...]) -> tuple[int, int]:
        """Count the values that a message holds at least, and its levels."""
        if message.name in above:
            raise InterfaceTextError(
                message.name, None, f"it is part of itself: {' > '.join([*above, message.name])}"
            )
        if len(above) < DEPTH_MAX and message.name not in self._measured:
            below = (*above, message.name)
            fields = [self._field(message, field, below) for field in message.fields]
            values = 1 + sum(values for values, _ in fields)
            levels = 1 + max((levels for _, levels in fields), default=0)
            self._measured[message.name] = (values, levels)
        values, levels = self._measured.get(message.name, (0, 1))
        if len(above) + levels > DEPTH_MAX:
            raise InterfaceTextError(
                message.name, None, f"messages lie deeper than {DEPTH_MAX} levels"
            )
        if values > VALUES_MAX:
            raise InterfaceTextError(
                message.name, None, f"its arrays hold more than {VALUES_MAX} values"
            )
        return values, levels

    def _field(self, message: Message, field: Field, below: tuple[str, ...]) -> tuple[int, int]:
        kind = field.type
        each, levels = self.measure(self._part(message, field), below) if kind.nested else (1, 0)
        if kind.shape is not Shape.ARRAY:
            return (each if kind.shape is Shape.SINGLE else 1), levels
        if not kind.numeric and kind.count > PLACES_MAX:
            raise InterfaceTextError(
                message.name,
                None,
                f"{field.name} has {kind.count} places, at most {PLACES_MAX} of {kind.base} fit: "
                "use a sequence",
            )
        return each * kind.count, levels

    def _part(self, message: Message, field: Field) -> Message:
        try:
            return self._find(field.type.base)
        except UnknownTypeError as error:
            why = f"cannot be used ({error.reason})" if error.reason else "no known package defines"
            raise UnknownTypeError(
                message.name, f'its field {field.name} is a "{field.type.base}", which {why}'
            ) from None
