"""Properties: what of a display can be set, under RViz's names and with RViz's first values."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

import numpy as np

from studio.errors import DisplayPropertyError

if TYPE_CHECKING:
    from typing import Any

    from studio.displays.drawing import Rgb

Value: TypeAlias = bool | int | float | str
PropertyKind: TypeAlias = Literal[
    "switch",
    "whole",
    "number",
    "colour",
    "choice",
    "text",
    "frame",
    "topic",
    "fact",
    "marker_server",
]

FIXED_FRAME: Final = "<Fixed Frame>"
"""Stands for the name of the fixed frame, whichever that is, as RViz writes it."""
_COLOUR: Final = re.compile(r"#[0-9a-f]{6}")
_TEXT_MAX: Final = 1000
_NUMBER_MAX: Final = 1e15
RVIZ_RED = "#ff1900"
RVIZ_GREEN: Final = "#19ff00"


@dataclass(frozen=True, slots=True)
class Property:
    """One setting.

    Attributes:
        name: RViz's; parts of a group are named with slashes, as `Covariance/Position/Alpha`.
        kind: Type of its value: a colour is written `#rrggbb`, a frame by its name on /tf, a server
            of interactive markers by the namespace of its topics; a fact is shown and cannot be
            set.
        default: The first value.
        doc: One sentence for the user.
        low: Least number.
        high: Greatest number.
        unit: Of a number: m, s, px, or empty.
        choices: Values of a choice; of a topic its message types.
        when: Another property, and those of its values with which this one has an effect.
    """

    name: str
    kind: PropertyKind
    default: Value
    doc: str
    low: float = float("-inf")
    high: float = float("inf")
    unit: str = ""
    choices: tuple[str, ...] = ()
    when: tuple[str, tuple[Value, ...]] | None = None

    def checked(self, value: object) -> Value:
        """Return the value as the property takes it: numbers are clipped to their range.

        Raises:
            DisplayPropertyError: It is of another kind.
        """
        if self.kind == "fact":
            raise DisplayPropertyError(self.name, "is shown and cannot be set", value)
        if self.kind == "switch":
            return self._switch(value)
        if self.kind in ("whole", "number"):
            return self._number(value)
        if not isinstance(value, str) or len(value) > _TEXT_MAX:
            raise DisplayPropertyError(self.name, "takes a short text", value)
        return self._text(value)

    def _switch(self, value: object) -> bool:
        if not isinstance(value, bool):
            raise DisplayPropertyError(self.name, "is on or off", value)
        return value

    def _number(self, value: object) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float) or value != value:  # noqa: PLR0124
            raise DisplayPropertyError(self.name, "is a number", value)
        within = min(max(value, self.low), self.high)
        if abs(within) > _NUMBER_MAX:  # JSON has no infinity
            within = float(self.default)
        return int(within) if self.kind == "whole" else float(within)

    def _text(self, value: str) -> str:
        if self.kind == "colour":
            if not _COLOUR.fullmatch(value.lower()):
                raise DisplayPropertyError(self.name, "is a colour as #ff8800", value)
            return value.lower()
        if self.kind == "choice" and value not in self.choices:
            raise DisplayPropertyError(self.name, f"is one of {', '.join(self.choices)}", value)
        return value


UPDATE_INTERVAL: Final = Property(
    "Update Interval",
    "number",
    0.0,
    "Time between two updates; 0 is as often as it can.",
    low=0.0,
    high=3600.0,
    unit="s",
)
"""Setting of displays that follow /tf."""


def rgb_of(colour: Value) -> Rgb:
    """Return red, green and blue of a colour, 0 to 255."""
    text = str(colour)
    return int(text[1:3], 16), int(text[3:5], 16), int(text[5:7], 16)


def colour_properties(
    colour: str, what: str, under: str = "", when: tuple[str, tuple[Value, ...]] | None = None
) -> tuple[Property, Property]:
    """Return the properties Color and Alpha of something."""
    return (
        Property(f"{under}Color", "colour", colour, f"Colour of the {what}.", when=when),
        Property(f"{under}Alpha", "number", 1.0, f"How opaque the {what} is.", 0.0, 1.0, when=when),
    )


def length(
    name: str, default: float, doc: str, when: tuple[str, tuple[Value, ...]] | None = None
) -> Property:
    """Return a property that is a length, m."""
    return Property(name, "number", default, doc, low=0.0, high=1000.0, unit="m", when=when)


def switch(
    name: str, doc: str, *, on: bool, when: tuple[str, tuple[Value, ...]] | None = None
) -> Property:
    """Return a property that is on or off."""
    return Property(name, "switch", on, doc, when=when)


def colour_of(rgb: Rgb) -> Any:  # noqa: ANN401 - NDArray[np.uint8] of shape (3,)
    """Return one colour for all points or bodies, as shapes take it."""
    return np.array(rgb, dtype=np.uint8)
