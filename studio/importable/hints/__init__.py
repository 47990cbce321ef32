"""Hints for beginners: what a program does that its author cannot have meant, each said once."""

from __future__ import annotations

from typing import Final

HINTS_VARIABLE: Final = "STUDIO_HINTS"
"""`0` says none."""
