"""Which field of a message holds what it may not, in one sentence."""

from __future__ import annotations

import math
from numbers import Real
from operator import index

from studio.errors import MessageValueError
from studio.ros.types.arrays import check_count, said
from studio.ros.types.classes import (
    MessageValue,
    attribute_name,
    class_of_field,
    definition_of,
)
from studio.ros.types.definitions import FLOATS, INTEGERS, STRINGS, Field, FieldType, Shape

_FLOAT32_MAX = 3.4028235677973366e38


def check_message(message: MessageValue, where: str = "") -> None:
    """Walk through a message, however deep.

    Raises:
        MessageValueError: A field holds what its type does not take; its path is named.
    """
    definition = definition_of(message)
    for field in definition.fields:
        path = f"{where}.{field.name}" if where else f"{definition.name} {field.name}"
        value = getattr(message, attribute_name(field.name))
        if field.type.shape is Shape.SINGLE:
            _check_value(message, field, value, path)
            continue
        check_count(path, field.type, len(value))
        if not field.type.numeric:
            for number, item in enumerate(value):
                _check_value(message, field, item, f"{path}[{number}]")


def check_scalar(kind: FieldType, value: object, where: str) -> None:
    """Check one number, truth value or text.

    Raises:
        MessageValueError: The type does not take it.
    """
    if kind.base in STRINGS:
        _check_string(kind, value, where)
    elif kind.base in FLOATS:
        _check_float(kind, value, where)
    elif kind.base in INTEGERS:
        _check_integer(kind, value, where)
    elif not isinstance(value, bool) and type(value).__name__ not in {"bool", "bool_"}:
        raise MessageValueError(where, f"{said(value)} is neither true nor false")


def _check_value(message: MessageValue, field: Field, value: object, where: str) -> None:
    if not field.type.nested:
        check_scalar(field.type, value, where)
        return
    wanted = class_of_field(message, field)
    if not isinstance(value, MessageValue) or definition_of(value) != definition_of(wanted):
        raise MessageValueError(where, f"{said(value)} is no {field.type.base}")
    check_message(value, where)


def _check_string(kind: FieldType, value: object, where: str) -> None:
    if not isinstance(value, str):
        raise MessageValueError(where, f"{said(value)} is no text")
    if kind.string_bound and len(value) > kind.string_bound:
        raise MessageValueError(where, f"the text is longer than {kind.string_bound} characters")
    try:
        value.encode()
    except UnicodeEncodeError:
        raise MessageValueError(where, "the text holds half a letter, no UTF-8") from None


def _check_float(kind: FieldType, value: object, where: str) -> None:
    if not isinstance(value, Real):
        raise MessageValueError(where, f"{said(value)} is no number")
    try:
        number = float(value)
    except OverflowError:
        raise MessageValueError(where, f"{said(value)} is too large for {kind.base}") from None
    if kind.base == "float32" and math.isfinite(number) and abs(number) > _FLOAT32_MAX:
        raise MessageValueError(where, f"{said(value)} is too large for float32")


def _check_integer(kind: FieldType, value: object, where: str) -> None:
    try:
        number = index(value)  # pyright: ignore[reportArgumentType]
    except TypeError:
        raise MessageValueError(where, f"{said(value)} is no whole number") from None
    low, high = INTEGERS[kind.base]
    if not low <= number <= high:
        raise MessageValueError(
            where, f"{said(value)} does not fit {kind.base}, which goes from {low} to {high}"
        )
