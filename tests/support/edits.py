"""Edits of files by the text that they replace."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.values import Edit

if TYPE_CHECKING:
    from pathlib import Path


def replacement(file: Path, old: str, new: str, data: bytes | None = None) -> Edit:
    """Replace the first place of a text in a file, or in what became of its bytes."""
    start = (data or file.read_bytes()).index(old.encode())
    return Edit(str(file), start, start + len(old.encode()), new.encode())
