"""Messages about diagnostics: how the parts of a robot say that they are."""

from __future__ import annotations

from typing import Literal

from studio.protocol.message import Command, Event, Message


class GetDiagnostics(Command):
    """Ask how all parts are; they are heard from the first such question on."""

    type: Literal["get_diagnostics"] = "get_diagnostics"


class DiagnosticValue(Message):
    """One thing that a part tells of itself."""

    key: str
    value: str


class DiagnosticView(Message):
    """How a part said it was when it said so last."""

    name: str
    hardware: str
    level: int
    """0 fine, 1 warning, 2 error, 3 stale."""
    message: str
    values: tuple[DiagnosticValue, ...]
    age_s: float
    """Since it said so."""


class DiagnosticsAnswer(Event):
    """Answer to `get_diagnostics`."""

    type: Literal["diagnostics"] = "diagnostics"
    request: int
    connected: bool
    parts: tuple[DiagnosticView, ...]
    """In the order of their names."""
    more: int
    """Parts for which there was no room."""
