"""Values of any message type, drawn field by field."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from hypothesis import strategies as st

from studio.ros.types.classes import (
    MessageValue,
    attribute_name,
    class_of_field,
    definition_of,
    dtype_of,
)
from studio.ros.types.definitions import INTEGERS, Field, FieldType, Shape


@cache  # made anew for each example, it would take longer than all that is done with the value
def values_of(kind: type[MessageValue]) -> st.SearchStrategy[MessageValue]:
    """Draw values of a message class, lists short and texts of any letters."""
    fields = {
        attribute_name(field.name): _field(kind, field) for field in definition_of(kind).fields
    }
    return st.builds(kind, **fields)


def _field(kind: type[MessageValue], field: Field) -> st.SearchStrategy[Any]:
    one = values_of(class_of_field(kind, field)) if field.type.nested else _scalar(field.type)
    match field.type.shape:
        case Shape.SINGLE:
            return one
        case Shape.ARRAY:
            many = st.lists(one, min_size=field.type.count, max_size=field.type.count)
        case Shape.BOUNDED:
            many = st.lists(one, max_size=min(field.type.count, 3))
        case Shape.SEQUENCE:
            many = st.lists(one, max_size=3)
    if not field.type.numeric:
        return many
    return many.map(lambda items: np.array(items, dtype=dtype_of(field.type.base)))


def _scalar(kind: FieldType) -> st.SearchStrategy[Any]:
    if kind.base in INTEGERS:
        return st.integers(*INTEGERS[kind.base])
    if kind.base == "bool":
        return st.booleans()
    if kind.base.startswith("float"):
        width = 32 if kind.base == "float32" else 64
        return st.floats(allow_nan=False, width=width)
    return st.text(max_size=min(kind.string_bound or 6, 6))
