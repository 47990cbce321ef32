"""Hints for a line that breaks a rule of interface texts: what it was probably meant to be."""

from __future__ import annotations

import re
from difflib import get_close_matches
from typing import Final

from studio.ros.types.definitions import PRIMITIVES

_OTHER_NAMES: Final = {
    "float": "float32 or float64",
    "double": "float64",
    "real": "float32 or float64",
    "int": "int32 or int64",
    "integer": "int32 or int64",
    "short": "int16",
    "long": "int64",
    "unsigned": "uint32 or uint64",
    "uint": "uint32 or uint64",
    "str": "string",
    "text": "string",
    "boolean": "bool",
    "time": "builtin_interfaces/Time",
    "duration": "builtin_interfaces/Duration",
    **{f"{base}_t": base for base in PRIMITIVES if "int" in base},
    **{base.capitalize(): base for base in PRIMITIVES},
    **{base.upper(): base for base in PRIMITIVES},
}
"""Names of types in other languages, and in definitions."""
_MEMBER: Final = re.compile(r"(?P<type>[\w./]+)(?P<array>\[[^\]]*\])?\s+(?P<name>\w+)(?P<rest>.*)")
_CAPITAL: Final = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")
_CHARACTERS_MAX: Final = 200
"""A longer line is not guessed at."""


def is_separator(line: str) -> bool:
    """Whether a line was meant to part a text: dashes, but not three of them."""
    dashes = line.strip()
    return len(dashes) > 1 and set(dashes) <= set("-\u2013\u2014") and dashes != "---"


def hint_for(code: str) -> str:
    """Return what to write instead of a line without its comment, half a sentence; empty: unknown.

    The line is one that was refused; a valid one is not checked for.
    """
    if len(code) > _CHARACTERS_MAX:
        return ""
    if is_separator(code):
        return "a line of three dashes, ---, parts a text"
    if "//" in code or code.startswith("/*"):
        return "a comment begins with #"
    if ";" in code:
        return "leave the ; out" if code.endswith(";") else "leave the ; out, one field a line"
    found = _MEMBER.fullmatch(code)
    return _hint_for_member(found) if found else _hint_for_order(code)


def _hint_for_member(found: re.Match[str]) -> str:
    kind, array, name = found["type"], found["array"] or "", found["name"]
    rest = found["rest"].strip()
    if name in PRIMITIVES:
        return f"the type comes first: {name}{array} {_field_name(kind)}"
    return _hint_for_type(kind) or _hint_for_rest(f"{kind}{array}", name, rest)


def _hint_for_type(kind: str) -> str:
    if kind in _OTHER_NAMES:
        return f"write {_OTHER_NAMES[kind]}"
    if "." in kind:
        return f"write {kind.replace('.msg', '').replace('.', '/')}"
    near = get_close_matches(kind, PRIMITIVES, n=1, cutoff=0.8) if kind not in PRIMITIVES else []
    return f"write {near[0]}" if near else ""


def _hint_for_rest(kind: str, name: str, rest: str) -> str:
    if rest.startswith(","):
        return "one field a line"
    if re.fullmatch(r"\[[^\]]*\]", rest):
        return f"write {kind}{rest} {name}"
    if rest.startswith("="):
        value = rest[1:].strip()
        constant = f"{kind} {_field_name(name).upper()}={value}"
        default = f"a default stands without =, {kind} {name} {value}"
        return "" if name.isupper() else f"{default}, and a constant is in capitals, {constant}"
    return f"write {_field_name(name)}" if _field_name(name) != name else ""


def _hint_for_order(code: str) -> str:
    """Return how a line such as `speed: float32` or `float32` alone is written."""
    name, colon, kind = (part.strip() for part in code.partition(":"))
    if colon and kind in PRIMITIVES:
        return f"write {kind} {_field_name(name)}"
    return "a line holds a type and a name, such as float32 speed" if " " not in code else ""


def _field_name(name: str) -> str:
    """Write a name as fields are named: `batteryLevel` as `battery_level`."""
    snake = re.sub(r"__+", "_", _CAPITAL.sub("_", name).lower()).strip("_")
    return snake or name
