"""Errors about displays of the 3D view."""

from __future__ import annotations

from studio.errors.root import StudioError


class DisplayError(StudioError):
    """A display cannot do what is asked of it."""


class DisplayMessageError(DisplayError):
    """A message that was read makes no sense, or cannot be drawn."""

    def __init__(self, kind: str, reason: str) -> None:
        super().__init__(f"The {kind} cannot be drawn: {reason}.")
        self.kind, self.reason = kind, reason


class DisplayPropertyError(DisplayError):
    """A property of a display is not there, or does not take a value."""

    def __init__(self, name: str, takes: str, value: object) -> None:
        said = "" if value is None else f", not {str(value)[:60]!r}"
        super().__init__(f"{name} {takes}{said}.")
        self.name, self.takes, self.value = name, takes, value
