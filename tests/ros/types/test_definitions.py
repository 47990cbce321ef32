from __future__ import annotations

import pytest

from studio.errors import InterfaceTextError
from studio.ros.types.definitions import DEPTH_MAX, Field, FieldType, Message, check_sizes


def chain(levels: int) -> dict[str, Message]:
    made = {
        f"p/msg/A{i}": Message(f"p/msg/A{i}", (Field("a", FieldType(f"p/msg/A{i + 1}")),))
        for i in range(levels - 1)
    }
    return {**made, f"p/msg/A{levels - 1}": Message(f"p/msg/A{levels - 1}")}


def test_levels_are_counted_to_the_last_one_that_is_allowed():
    parts = chain(DEPTH_MAX)
    check_sizes(parts["p/msg/A0"], parts.__getitem__)
    parts = chain(DEPTH_MAX + 1)
    with pytest.raises(InterfaceTextError, match="deeper"):
        check_sizes(parts["p/msg/A0"], parts.__getitem__)


def test_levels_count_although_a_part_was_measured_before():
    parts = chain(DEPTH_MAX)
    field = Field("first", FieldType("p/msg/A0"))
    low = Message("p/msg/Low", (field,))
    top = Message("p/msg/Top", (Field("x", FieldType("p/msg/A1")), Field("y", FieldType(low.name))))
    with pytest.raises(InterfaceTextError, match="deeper"):
        check_sizes(top, {**parts, low.name: low}.__getitem__)


def test_many_fields_of_one_large_type_are_measured_once():
    parts = {
        "p/msg/B": Message("p/msg/B", tuple(Field(f"x{i}", FieldType("int8")) for i in range(2000)))
    }
    for level in "CDE":
        below = f"p/msg/{chr(ord(level) - 1)}"
        fields = tuple(Field(f"x{i}", FieldType(below)) for i in range(20))
        parts[f"p/msg/{level}"] = Message(f"p/msg/{level}", fields)
    with pytest.raises(InterfaceTextError, match="more than"):
        check_sizes(parts["p/msg/E"], parts.__getitem__)
