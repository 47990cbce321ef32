"""Numbers written the way their file writes them: decimals kept, no noise of binary fractions."""

from __future__ import annotations

import math
import re
from decimal import Decimal

_NUMBER = re.compile(r"\s*[+-]?(\d*)(\.?)(\d*)(?:([eE])([+-]?)(\d+))?\s*")
_SIGNIFICANT_DIGITS = 12
_SHOWN_MAGNITUDES = range(-15, 17)
"""Powers of ten that are written out; beyond them an exponent is shorter and clearer."""


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


def format_number(value: float, like: str, step: float | None = None) -> str:
    """Write `value` in the style of `like`: `0.10` -> `0.12`, `3` -> `4`, `1e-3` -> `2e-3`.

    With a `step` the value is rounded to the decimals of the finer of step and `like`; without one
    all digits that are not noise stay.

    Raises:
        ValueError: `value` is inf or nan.
    """
    if not math.isfinite(value):
        raise ValueError(f"{value} is no number that a file can hold")
    exact = _without_noise(value)
    style = _NUMBER.fullmatch(like)
    if style is not None and style[4] and parse_number(like) is not None:
        return _with_exponent(exact, len(style[3]), style[4], len(style[6]))
    least = decimals_of(like) if style is not None else 0
    if step is not None:
        finest = max(least, decimals_of(format(_without_noise(step), "f")))
        exact = round(exact, finest).normalize() + 0
    if exact and exact.adjusted() not in _SHOWN_MAGNITUDES:
        return _with_exponent(exact, 0, "e", 1)
    return _like(_plain(exact, least), like)


def _without_noise(value: float) -> Decimal:
    exact = Decimal(repr(float(value)))
    digits = Decimal(format(value, f".{_SIGNIFICANT_DIGITS}g"))
    # More than 15 digits is what sums of binary fractions leave (0.30000000000000004).
    noisy = len(exact.as_tuple().digits) > 15
    return (digits if noisy else exact).normalize() + 0


def _plain(exact: Decimal, least: int) -> str:
    needed = max(0, -int(exact.as_tuple().exponent))
    return format(exact, f".{max(least, needed)}f")


def _like(written: str, like: str) -> str:
    """Take over a missing zero before the point (`.5`) and a bare point behind (`3.`)."""
    bare = like.strip().lstrip("+-")
    if bare.startswith(".") and written.lstrip("-").startswith("0."):
        written = written.replace("0.", ".", 1)
    if bare.endswith(".") and bare[:-1].isdigit() and "." not in written:
        written += "."
    return written


def _with_exponent(exact: Decimal, least: int, letter: str, width: int) -> str:
    needed = max(0, len(exact.normalize().as_tuple().digits) - 1)
    mantissa, _, exponent = format(exact, f".{max(least, needed)}e").partition("e")
    sign = "-" if exponent.startswith("-") else ""
    return f"{mantissa}{letter}{sign}{exponent.lstrip('+-').lstrip('0').rjust(width, '0') or '0'}"
