"""A verdict: how a check stands, and what is missing."""

from __future__ import annotations

import math
from typing import NamedTuple


class Verdict(NamedTuple):
    """How one check stands.

    Attributes:
        ok: Whether it holds.
        code: Names the sentence about what is missing; the page has it in both languages.
        found: Fills that sentence.
    """

    ok: bool
    code: str = ""
    found: dict[str, str] = {}  # noqa: RUF012 - never changed, as a tuple's parts are not


HOLDS = Verdict(ok=True)


def missing(code: str, **found: object) -> Verdict:
    """Return the verdict that something is missing."""
    return Verdict(ok=False, code=code, found={name: str(value) for name, value in found.items()})


def is_same(wanted: str, found: str) -> bool:
    """Whether two texts are one value: numbers by their size, all else letter by letter."""
    wanted, found = wanted.strip(), found.strip()
    if wanted == found:
        return True
    if {wanted.lower(), found.lower()} & {"true", "false"}:
        return wanted.lower() == found.lower()
    try:
        return int(wanted) == int(found)
    except ValueError:
        pass
    try:
        numbers = float(wanted), float(found)
    except ValueError:
        return False
    return math.isclose(*numbers, rel_tol=1e-6, abs_tol=0.0 if numbers[0] else 1e-9)
