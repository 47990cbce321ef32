from __future__ import annotations

import pytest

from studio.errors import OtherTypeError, UnknownTypeError
from studio.ros.messages import message, types_of
from studio.ros.node.node import Node
from studio.ros.types.library import TypeLibrary, check_same_type
from tests.support.node_pair import context_at
from tests.support.wire import running_router

RANGE = "sensor_msgs/msg/Range"  # has one field more since Jazzy


@pytest.mark.parametrize("name", ["std_msgs/msg/String", "tf2_msgs/msg/TFMessage"])
def test_a_class_of_another_distribution_with_the_same_fields_is_taken(name: str):
    assert check_same_type(types_of("humble"), message(name)) == name


def test_a_class_of_another_distribution_with_other_fields_is_refused():
    with pytest.raises(OtherTypeError, match="not that of humble"):
        check_same_type(types_of("humble"), types_of("jazzy").message(RANGE))


def test_a_class_from_before_its_text_changed_is_refused():
    types = TypeLibrary("jazzy")
    types.add_texts(
        {"inner_msgs/msg/Inner": "int32 a", "outer_msgs/msg/Outer": "inner_msgs/Inner i"}
    )
    before = types.message("outer_msgs/msg/Outer")
    types.add_texts({"inner_msgs/msg/Inner": "int64 a"})
    with pytest.raises(OtherTypeError, match="outer_msgs/msg/Outer"):
        check_same_type(types, before)


def test_a_class_that_a_library_does_not_know_is_named():
    own = TypeLibrary("jazzy")
    own.add_texts({"own_msgs/msg/Own": "int32 a"})
    with pytest.raises(UnknownTypeError, match="own_msgs/msg/Own"):
        check_same_type(types_of("jazzy"), own.message("own_msgs/msg/Own"))


def test_a_node_of_humble_publishes_no_range_of_jazzy():
    with running_router() as endpoint, context_at(endpoint, "humble") as context:
        node = Node("old", context=context)
        with pytest.raises(OtherTypeError):
            node.create_publisher(types_of("jazzy").message(RANGE), "range", 10)
        node.create_publisher(context.wire.types.message(RANGE), "range", 10)
