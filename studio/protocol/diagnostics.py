"""Messages about diagnostics: the states that the parts of a robot report."""

from __future__ import annotations

from typing import Literal

from studio.protocol.message import Command, Event, Message


class GetDiagnostics(Command):
    """Ask for the states of all parts; the topic is subscribed from the first such request on."""

    type: Literal["get_diagnostics"] = "get_diagnostics"


class DiagnosticValue(Message):
    """One value that a part reports."""

    key: str
    value: str


class DiagnosticView(Message):
    """The state that a part reported last."""

    name: str
    hardware: str
    level: int
    """0 fine, 1 warning, 2 error, 3 stale."""
    message: str
    values: tuple[DiagnosticValue, ...]
    age_s: float
    """Since the report."""


class DiagnosticsAnswer(Event):
    """Answer to `get_diagnostics`."""

    type: Literal["diagnostics"] = "diagnostics"
    request: int
    connected: bool
    parts: tuple[DiagnosticView, ...]
    """Sorted by name."""
    more: int
    """Parts for which there was no room."""
