from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.errors import TypeDescriptionError
from studio.ros.cdr import Codec
from studio.ros.types.library import TypeLibrary
from studio.ros.types.type_descriptions import read_description, write_description
from tests.support.ros_values import values_of
from tests.support.sweep import some_of

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue

LIBRARY = TypeLibrary("jazzy")
KIND = LIBRARY.message("type_description_interfaces/msg/TypeDescription")
CODEC = Codec(KIND)
STRING = "std_msgs/msg/String"


def written(name: str) -> MessageValue:
    return write_description(KIND, LIBRARY.find(name), LIBRARY.find)


@pytest.mark.parametrize("name", some_of(LIBRARY.names()))
def test_a_description_is_read_as_it_was_written(name: str):
    over_the_wire = CODEC.decode(CODEC.encode(written(name)))
    parts = read_description(over_the_wire, name, LIBRARY.hash_of(name))
    for part, message in parts.items():
        told = [(field.name, str(field.type).replace("char", "uint8")) for field in message.fields]
        known = LIBRARY.find(part)
        assert told == [
            (field.name, str(field.type).replace("char", "uint8")) for field in known.fields
        ]


def test_a_description_tells_defaults():
    library = TypeLibrary("jazzy")
    library.add_texts({"p/msg/A": 'int32 x 5\nbool b true\nstring s "hey"\nstring t\n'})
    described = write_description(KIND, library.find("p/msg/A"), library.find)
    fields = described.type_description.fields
    assert [field.default_value for field in fields] == ["5", "True", "hey", ""]


def refused(description: MessageValue, reason: str, name: str = STRING) -> None:
    with pytest.raises(TypeDescriptionError, match=reason):
        read_description(description, name, LIBRARY.hash_of(STRING))


def test_a_hash_that_is_not_the_one_of_the_node_is_refused():
    description = written(STRING)
    description.type_description.fields[0].name = "date"
    refused(description, "its hash is RIHS01_.*the node says RIHS01_df668")


def test_a_description_of_another_type_is_refused():
    refused(written("std_msgs/msg/Bool"), "it is one of std_msgs/msg/Bool")


def test_a_type_that_stands_in_it_twice_is_refused():
    description = written("std_msgs/msg/Header")
    description.referenced_type_descriptions *= 2
    refused(description, "stands in it twice", "std_msgs/msg/Header")


def test_a_part_that_is_missing_is_named():
    description = written("std_msgs/msg/Header")
    description.referenced_type_descriptions = []
    refused(description, "builtin_interfaces/msg/Time", "std_msgs/msg/Header")


def test_too_many_parts_or_fields_are_refused():
    description = written("std_msgs/msg/Header")
    description.referenced_type_descriptions *= 1_001
    refused(description, "more than 1000 types", "std_msgs/msg/Header")
    description = written(STRING)
    description.type_description.fields *= 2_001
    refused(description, "more than 2000 fields")


@pytest.mark.parametrize("number", [0, 12, 14, 19, 20, 23, 48, 60, 255])
def test_a_type_that_texts_do_not_have_is_refused(number: int):
    description = written(STRING)
    kind = description.type_description.fields[0].type
    kind.type_id, kind.nested_type_name = number, "std_msgs/msg/Bool"
    refused(description, "data is of a type that .msg texts do not have")


def test_names_and_sizes_are_checked():
    description = written(STRING)
    description.type_description.type_name = "../../etc"
    refused(description, "cannot be used in ROS 2")
    description = written(STRING)
    description.type_description.fields[0].type.capacity = 2**40
    refused(description, "holds more than")


def test_a_type_that_is_part_of_itself_is_refused():
    description = written("std_msgs/msg/Header")
    inner = description.referenced_type_descriptions[0].fields[0].type
    inner.type_id, inner.nested_type_name = 1, "std_msgs/msg/Header"
    refused(description, "part of itself", "std_msgs/msg/Header")


@given(values_of(KIND))
def test_any_description_is_read_or_refused(description: MessageValue):
    with pytest.raises(TypeDescriptionError):
        read_description(description, STRING, LIBRARY.hash_of(STRING))


@given(st.data())
@settings(max_examples=300)
def test_a_description_with_one_number_or_name_changed_is_refused(data: st.DataObject):
    description = written("geometry_msgs/msg/PoseWithCovariance")
    parts = [description.type_description, *description.referenced_type_descriptions]
    part = data.draw(st.sampled_from(parts))
    field = data.draw(st.sampled_from(part.fields))
    place, value = data.draw(
        st.one_of(
            st.tuples(st.just("type_id"), st.integers(0, 255)),
            st.tuples(st.just("capacity"), st.integers(0, 2**64 - 1)),
            st.tuples(st.just("nested_type_name"), st.sampled_from(LIBRARY.names())),
        )
    )
    before = getattr(field.type, place)
    setattr(field.type, place, value)
    name = "geometry_msgs/msg/PoseWithCovariance"
    if value == before or (place == "capacity" and field.type.type_id < 48):
        return
    if place == "nested_type_name" and field.type.type_id != 1:
        return
    with pytest.raises(TypeDescriptionError):
        read_description(description, name, LIBRARY.hash_of(name))
