"""Zenoh's version, as routers, nodes and bridges tell it."""

from __future__ import annotations

from typing import Final

_LETTERS_MAX: Final = 20


def version_number(text: str) -> str:
    """Return `1.8.0` of `v1.8.0-2687c51 built with rustc 1.95.0`; empty if there is none."""
    number = text.removeprefix("v").partition(" ")[0].partition("-")[0]
    is_short = number.isascii() and len(number) <= _LETTERS_MAX
    return number if is_short and number.replace(".", "").isalnum() else ""
