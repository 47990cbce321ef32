from __future__ import annotations

import importlib

import pytest

from studio.ros.types.definitions import Constant, Field, FieldType, Shape
from studio.ros.types.rosbags import MessageStore


def test_a_message_comes_with_its_fields_bounds_and_constants():
    store = MessageStore("jazzy")
    parameter = store.find("rcl_interfaces/msg/ParameterDescriptor")
    assert parameter is not None
    assert parameter.fields[-1] == Field(
        "integer_range", FieldType("rcl_interfaces/msg/IntegerRange", Shape.BOUNDED, 1)
    )
    status = store.find("sensor_msgs/msg/NavSatFix")
    assert status is not None
    assert Constant("COVARIANCE_TYPE_KNOWN", "uint8", 3) in status.constants
    assert status.fields[5].type == FieldType("float64", Shape.ARRAY, 9)


def test_empty_messages_have_no_fields_and_unknown_ones_are_none():
    store = MessageStore("humble")
    empty = store.find("std_msgs/msg/Empty")
    assert empty is not None
    assert empty.fields == ()
    assert store.find("no_pkg/msg/Thing") is None


def test_distributions_have_stores_of_their_own():
    assert set(MessageStore("kilted").names()) > set(MessageStore("jazzy").names())


@pytest.mark.parametrize("distro", ["humble", "jazzy", "kilted"])
def test_tables_are_those_of_rosbags(distro: str):
    table = importlib.import_module(f"rosbags.typesys.stores.ros2_{distro}").FIELDDEFS
    store = MessageStore(distro)
    assert store.names() == list(table)
    point = store.find("geometry_msgs/msg/Point")
    assert point is not None
    assert [field.name for field in point.fields] == [name for name, _ in table[point.name][1]]
