"""Messages as plain dicts, YAML, CSV and JSON, as `ros2 topic echo` writes and `pub` reads them."""

from __future__ import annotations

import csv
import io
import json
import math
from dataclasses import dataclass
from itertools import islice
from typing import Any, Final, cast

import numpy as np

from studio.errors import MessageValueError
from studio.ros.duration import NANOSECONDS
from studio.ros.types.classes import (
    MessageValue,
    attribute_name,
    check_scalar,
    class_of_field,
    definition_of,
    shown,
)
from studio.ros.types.definitions import FLOATS, STRINGS, Field, FieldType, Shape
from studio.ros.types.yaml_texts import read_yaml, write_yaml

# From here on Python turns whole numbers neither into floats nor into texts.
_HUGE = 2**1000
_ABBREVIATED = {"float32": "float", "float64": "double", "bool": "boolean", "byte": "octet"}
_HEADER = "std_msgs/msg/Header"
_TIME = "builtin_interfaces/msg/Time"
_EXACT_MAX: Final = 2**53
"""From here on JavaScript's numbers skip integers."""
_LENGTHS: Final = (10_000, 1_000, 100, 10)
"""Limits for arrays and texts, tried in turn."""


@dataclass(frozen=True, slots=True)
class Brevity:
    """What to leave out: arrays, texts, or of both what is beyond a length."""

    no_arrays: bool = False
    no_texts: bool = False
    length_max: int | None = None


WHOLE = Brevity()


def to_dict(message: MessageValue, brevity: Brevity = WHOLE) -> dict[str, Any]:
    """Make plain dicts, lists, numbers and texts of a message, by the names of its fields."""
    return {
        field.name: _plain(field.type, getattr(message, attribute_name(field.name)), brevity)
        for field in definition_of(message).fields
    }


def to_yaml(message: MessageValue, brevity: Brevity = WHOLE, *, flow: bool = False) -> str:
    """Write a message as `ros2 topic echo` does, less the line of `---`."""
    return write_yaml(to_dict(message, brevity), flow=flow)


def to_csv(message: MessageValue, brevity: Brevity = WHOLE) -> str:
    """Write a message as one line of values, as `ros2 topic echo --csv` does."""
    out = io.StringIO()
    csv.writer(out, lineterminator="").writerow(_leaves(to_dict(message, brevity)))
    return out.getvalue()


def from_dict(
    kind: type[MessageValue], values: object, *, now_ns: int | None = None
) -> MessageValue:
    """Make a message of plain values; what is not named keeps its default.

    With `now_ns`, nanoseconds since the epoch, `now` stands for that time and a header may be
    `auto`, as for `ros2 topic pub`.

    Raises:
        MessageValueError: A field does not exist or does not take its value; its path is named.
    """
    return _Reader(now_ns).message(kind, values, definition_of(kind).name)


def from_yaml(
    kind: type[MessageValue], text: str, *, now_ns: int | None = None, source: str = ""
) -> MessageValue:
    """Make a message of YAML, as a command line gives it; empty is all defaults.

    `source` names the text in errors; without one, it is quoted.

    Raises:
        MessageValueError: It is no YAML, or a field does not take its value.
    """
    name = definition_of(kind).name
    try:
        values = read_yaml(text, source)
    except ValueError as error:
        raise MessageValueError(name, str(error)) from None
    return from_dict(kind, {} if values is None else values, now_ns=now_ns)


@dataclass(frozen=True, slots=True)
class _Reader:
    now_ns: int | None

    def message(self, kind: type[MessageValue], values: object, where: str) -> MessageValue:
        """Make a message of a dict, or of a value that fits."""
        if isinstance(values, kind):
            return values
        definition = definition_of(kind)
        if definition.name == _TIME and values == "now" and self.now_ns is not None:
            return kind(
                **dict(zip(("sec", "nanosec"), divmod(self.now_ns, NANOSECONDS), strict=True))
            )
        if definition.name == _HEADER and values == "auto" and self.now_ns is not None:
            values = {"stamp": "now"}
        if not isinstance(values, dict):
            raise MessageValueError(where, f"{shown(values)} is no set of fields")
        fields = {field.name: field for field in definition.fields}
        given: dict[str, object] = {}
        for name, value in cast("dict[object, object]", values).items():
            field = fields.get(name) if isinstance(name, str) else None
            if field is None:
                known = ", ".join(fields) or "none"
                raise MessageValueError(
                    where, f"it has no field {shown(name)}, its fields: {known}"
                )
            given[attribute_name(field.name)] = self._value(
                kind, field, value, f"{where}.{field.name}"
            )
        return kind(**given)

    def _value(self, kind: type[MessageValue], field: Field, value: Any, where: str) -> object:  # noqa: ANN401
        if field.type.shape is Shape.SINGLE:
            return self._single(kind, field, value, where)
        if isinstance(value, (str, dict)) or not hasattr(value, "__iter__"):
            raise MessageValueError(where, f"{shown(value)} is no list of {field.type.base}")
        if field.type.numeric:
            return value
        items = cast("list[object]", value)
        return [
            self._single(kind, field, item, f"{where}[{number}]")
            for number, item in enumerate(items)
        ]

    def _single(self, kind: type[MessageValue], field: Field, value: object, where: str) -> object:
        if field.type.nested:
            return self.message(class_of_field(kind, field), value, where)
        fitting = _fitted(field.type, value)
        check_scalar(field.type, fitting, where)
        return fitting


def _fitted(kind: FieldType, value: object) -> object:
    """Convert what YAML makes of a bare text or number to the type of the field."""
    if isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < _HUGE:
        if kind.base in STRINGS:
            return str(value)
        return float(value) if kind.base in FLOATS else value
    if kind.base in FLOATS and isinstance(value, str):
        return _float_of(value)
    return _byte(value) if kind.base == "byte" else value


def _byte(value: object) -> object:
    """Read what `ros2 topic echo` writes for a byte, one letter, or what YAML calls binary."""
    if isinstance(value, str) and len(value) == 1:
        return ord(value)
    return value[0] if isinstance(value, bytes) and len(value) == 1 else value


def _float_of(text: str) -> object:
    """Read `1e-3`, `nan` and `-inf`, which YAML takes for texts."""
    try:
        return float(text)
    except ValueError:
        return text


def _plain(kind: FieldType, value: Any, brevity: Brevity) -> Any:  # noqa: ANN401
    if kind.shape is Shape.SINGLE:
        return _plain_single(kind, value, brevity)
    if brevity.no_arrays:
        return _abbreviated(kind, len(value))
    shown = value if brevity.length_max is None else islice(value, brevity.length_max)
    items = [_plain_single(kind, item, brevity) for item in shown]
    return [*items, "..."] if len(items) < len(value) else items


def _plain_single(kind: FieldType, value: Any, brevity: Brevity) -> Any:  # noqa: ANN401
    if kind.nested:
        return to_dict(value, brevity)
    if kind.base in STRINGS:
        return _plain_text(value, brevity)
    return cast("Any", value).item() if isinstance(value, np.generic) else value


def _plain_text(value: str, brevity: Brevity) -> str:
    if brevity.no_texts:
        return f"<string length: <{len(value)}>>"
    length_max = brevity.length_max
    return value if length_max is None or len(value) <= length_max else f"{value[:length_max]}..."


def _abbreviated(kind: FieldType, count: int) -> str:
    base = _ABBREVIATED.get(kind.base, kind.base)
    match kind.shape:
        case Shape.ARRAY:
            return f"<array type: {base}[{kind.count}]>"
        case Shape.BOUNDED:
            return f"<sequence type: {base}<{kind.count}>, length: {count}>"
        case _:
            return f"<sequence type: {base}, length: {count}>"


def _leaves(value: object) -> list[object]:
    if isinstance(value, dict):
        return [leaf for one in cast("dict[str, object]", value).values() for leaf in _leaves(one)]
    if isinstance(value, list):
        return [leaf for one in cast("list[object]", value) for leaf in _leaves(one)]
    return [value]


def to_json(message: MessageValue, characters_max: int) -> str:
    """Write a message in about so many characters at most; long arrays and texts end with `...`."""
    written = ""
    # Two letters are the least that an item takes: what cannot fit is not even tried.
    for length in [one for one in _LENGTHS if 2 * one <= characters_max] or _LENGTHS[-1:]:
        written = plain_json(to_dict(message, Brevity(length_max=length)))
        if len(written) <= characters_max:
            break
    return written


def plain_json(value: object) -> str:
    """Write plain values; large whole numbers, nan, infinities and bytes become texts."""
    return json.dumps(_readable(value), allow_nan=False, separators=(",", ":"))


def _readable(value: object) -> object:
    if isinstance(value, dict):
        items = cast("dict[object, object]", value).items()
        return {str(key): _readable(one) for key, one in items}
    if isinstance(value, (list, tuple)):
        return [_readable(one) for one in cast("list[object]", value)]
    if isinstance(value, bool) or value is None or isinstance(value, str):
        return value
    return _number(value)


def _number(value: Any) -> object:  # noqa: ANN401 - what YAML makes of a text
    if isinstance(value, int):
        return value if abs(value) <= _EXACT_MAX else str(value)
    if isinstance(value, float):
        return value if math.isfinite(value) else str(value)
    if isinstance(value, bytes):
        return value.decode("latin-1")
    return str(value)
