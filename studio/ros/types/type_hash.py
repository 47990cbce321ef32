"""RIHS01, the hash of a type that is part of keys since Iron, as REP-2016 defines it."""

from __future__ import annotations

import hashlib
import json
from typing import TYPE_CHECKING

from studio.ros.types.definitions import DUMMY_FIELD, Field, FieldType, Message, Shape

if TYPE_CHECKING:
    from collections.abc import Callable

# `char` of a .msg is an unsigned byte by the time that it is described.
TYPE_IDS = {
    "int8": 2, "uint8": 3, "char": 3, "int16": 4, "uint16": 5, "int32": 6, "uint32": 7,
    "int64": 8, "uint64": 9, "float32": 10, "float64": 11, "bool": 15, "byte": 16,
    "string": 17, "wstring": 18,
}  # fmt: skip
_NESTED = 1
_BOUNDED_STRING_MORE = 4
_SHAPE_MORE = {Shape.SINGLE: 0, Shape.ARRAY: 48, Shape.BOUNDED: 96, Shape.SEQUENCE: 144}
_DUMMY = Field(DUMMY_FIELD, FieldType("uint8"))

Described = dict[str, object]


def type_hash(message: Message, find: Callable[[str], Message]) -> str:
    """Hash a message; `find` returns the messages that it is made of by their full names.

    Raises:
        UnknownTypeError: What `find` raises for a part that is missing.
    """
    described = json.dumps(type_description(message, find))
    return "RIHS01_" + hashlib.sha256(described.encode()).hexdigest()


def type_description(message: Message, find: Callable[[str], Message]) -> dict[str, object]:
    """Describe a message and all it is made of, the order of keys as it is hashed."""
    parts = closure(message, find)
    return {
        "type_description": _described(message),
        "referenced_type_descriptions": [
            _described(parts[name]) for name in sorted(parts) if name != message.name
        ],
    }


def closure(message: Message, find: Callable[[str], Message]) -> dict[str, Message]:
    """Collect the messages that one is made of, itself included, however deep."""
    found = {message.name: message}
    waiting = [message]
    while waiting:
        for name in waiting.pop().needs() - found.keys():
            found[name] = find(name)
            waiting.append(found[name])
    return found


def _described(message: Message) -> Described:
    fields = message.fields or (_DUMMY,)
    return {"type_name": message.name, "fields": [_described_field(field) for field in fields]}


def _described_field(field: Field) -> Described:
    kind = field.type
    base = _NESTED if kind.nested else TYPE_IDS[kind.base]
    if kind.string_bound:
        base += _BOUNDED_STRING_MORE
    described = {
        "type_id": base + _SHAPE_MORE[kind.shape],
        "capacity": kind.count,
        "string_capacity": kind.string_bound,
        "nested_type_name": kind.base if kind.nested else "",
    }
    return {"name": field.name, "type": described}
