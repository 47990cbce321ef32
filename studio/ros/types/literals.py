"""Default values and constants as interface texts write them."""

from __future__ import annotations

import math
import re

from studio.ros.types.definitions import (
    FLOATS,
    INTEGERS,
    STRINGS,
    FieldType,
    Literal,
    Scalar,
    Shape,
)

_INTEGER = re.compile(r"[+-]?(0[xX][0-9a-fA-F]+|0[oO]?[0-7]+|0[bB][01]+|[0-9]+)", re.ASCII)
_INTEGER_DIGITS_MAX = 70
_TRUTH = {"true": True, "1": True, "false": False, "0": False}
# Possessive throughout: nothing is tried twice, however long a hostile text is.
_QUOTED = re.compile(r'"(?:[^"\\]|\\.)*+"|\'(?:[^\'\\]|\\.)*+\'')
_ITEM = re.compile(rf"\s*+((?:{_QUOTED.pattern})|[^,\"'\[\]]++)\s*+(,|$)")
_ESCAPE = re.compile(r"\\(.)")
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r"}


def parse_literal(text: str, kind: FieldType) -> Literal:
    """Read the default of a field, or one value of a constant.

    Raises:
        ValueError: It is no value of that type; the message is half a sentence.
    """
    if kind.shape is Shape.SINGLE:
        return parse_scalar(text, kind)
    items = tuple(parse_scalar(item, kind) for item in _items(text))
    if kind.shape is Shape.ARRAY and len(items) != kind.count:
        raise ValueError(f"its default has {len(items)} values instead of {kind.count}")
    if kind.shape is Shape.BOUNDED and len(items) > kind.count:
        raise ValueError(f"its default has {len(items)} values, at most {kind.count} fit")
    return items


def parse_scalar(text: str, kind: FieldType) -> Scalar:
    """Read one value.

    Raises:
        ValueError: It is no value of that type; the message is half a sentence.
    """
    if kind.base in STRINGS:
        return _string(text, kind)
    if kind.base == "bool":
        if text.lower() not in _TRUTH:
            raise ValueError(f'"{text[:40]}" is neither true nor false')
        return _TRUTH[text.lower()]
    if kind.base in FLOATS:
        return _float(text)
    if kind.base in INTEGERS:
        return _integer(text, kind.base)
    raise ValueError(f"a {kind.base} has no default value")


def _string(text: str, kind: FieldType) -> str:
    if text[:1] in {'"', "'"}:
        if not _QUOTED.fullmatch(text):
            raise ValueError(f"the quotes of {text[:40]} do not close")
        text = _ESCAPE.sub(lambda found: _ESCAPES.get(found[1], found[1]), text[1:-1])
    if kind.string_bound and len(text) > kind.string_bound:
        raise ValueError(f'"{text[:40]}" is longer than {kind.string_bound} characters')
    return text


def _float(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise ValueError(f'"{text[:40]}" is no number') from None
    if not math.isfinite(value) or "_" in text:
        raise ValueError(f'"{text[:40]}" is no number that a text may hold')
    return value


def _integer(text: str, base: str) -> int:
    found = _INTEGER.fullmatch(text)
    if not found or len(text) > _INTEGER_DIGITS_MAX:
        raise ValueError(f'"{text[:40]}" is no whole number')
    digits = found[1].lower()
    radix = {"0x": 16, "0b": 2, "0o": 8}.get(digits[:2], 10)
    value = int(digits[2:] if radix != 10 else digits, radix)
    value = -value if text.startswith("-") else value
    low, high = INTEGERS[base]
    if not low <= value <= high:
        raise ValueError(f"{text} does not fit {base}, which goes from {low} to {high}")
    return value


def _items(text: str) -> list[str]:
    if not (text.startswith("[") and text.endswith("]")):
        raise ValueError("the default of an array stands in brackets")
    body, items, place = text[1:-1].strip(), list[str](), 0
    while place < len(body):
        found = _ITEM.match(body, place)
        if not found:
            raise ValueError(f"{body[place : place + 40]} is no list of values")
        items.append(found[1].strip())
        place = found.end()
    return items
