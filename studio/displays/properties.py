"""Properties: what of a display can be set, under RViz's names and with RViz's first values."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from studio.errors import DisplayPropertyError

if TYPE_CHECKING:
    from studio.displays.drawing import Rgb

Value: TypeAlias = bool | int | float | str
PropertyKind: TypeAlias = Literal["switch", "whole", "number", "colour", "choice", "text", "frame"]

_COLOUR: Final = re.compile(r"#[0-9a-f]{6}")
_TEXT_MAX: Final = 1000
_NUMBER_MAX: Final = 1e15


@dataclass(frozen=True, slots=True)
class Property:
    """One setting.

    Attributes:
        name: RViz's; parts of a group are named with slashes, as `Covariance/Position/Alpha`.
        kind: What it takes: a colour is written `#rrggbb`, a frame by its name on /tf.
        default: What it is at first.
        doc: One sentence for who looks at it.
        low: Least number.
        high: Greatest number.
        unit: Of a number: m, s, px, or empty.
        choices: What a choice may be.
        when: Another property and its values with which this one means something.
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
        """The value as the property takes it: numbers are held within their range.

        Raises:
            DisplayPropertyError: It is of another kind.
        """
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
        if abs(within) > _NUMBER_MAX:  # JSON has no infinity: what is kept could not be read again
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
"""Of displays that show where frames are."""


def rgb_of(colour: Value) -> Rgb:
    """The parts of a colour, 0 to 255."""
    text = str(colour)
    return int(text[1:3], 16), int(text[3:5], 16), int(text[5:7], 16)
