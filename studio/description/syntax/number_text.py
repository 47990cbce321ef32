"""Numbers as people write them in files."""

from __future__ import annotations

import math
import re

_NUMBER = re.compile(r"\s*[+-]?(\d*)(\.?)(\d*)(?:([eE])([+-]?)(\d+))?\s*")


def parse_number(text: str) -> float | None:
    """The finite number that a text is; None for anything else (also inf, nan and `1_000`)."""
    if "_" in text:
        return None
    try:
        number = float(text)
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def decimals_of(text: str) -> int:
    """Digits behind the decimal point of a number as written; an exponent shifts the point."""
    number = _NUMBER.fullmatch(text)
    if number is None:
        return 0
    exponent = int(f"{number[5]}{number[6]}") if number[4] else 0
    return max(0, len(number[3]) - exponent)
