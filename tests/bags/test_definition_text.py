"""The text of a type with all that it is made of, as a library of others reads it."""

from __future__ import annotations

import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from studio.bags.blocks import Definition
from studio.bags.definition_text import definition_text
from studio.bags.schemas import types_of
from studio.ros.types.library import TypeLibrary

TYPES = TypeLibrary("jazzy")


@pytest.mark.parametrize(
    "name",
    [
        "std_msgs/msg/String",
        "geometry_msgs/msg/PoseWithCovarianceStamped",
        "sensor_msgs/msg/PointCloud2",
        "nav_msgs/msg/Path",
        "tf2_msgs/msg/TFMessage",
        "visualization_msgs/msg/MarkerArray",
    ],
)
def test_rosbags_reads_the_fields_that_it_knows_itself(name: str):
    store = get_typestore(Stores.ROS2_JAZZY)
    found = get_types_from_msg(definition_text(TYPES, name), name)
    assert found
    for part, (constants, fields) in found.items():
        known = store.fielddefs[part]
        assert (fields, sorted(constants)) == (known[1], sorted(known[0]))


def test_each_part_stands_once_and_is_read_again_by_ourselves():
    text = definition_text(TYPES, "nav_msgs/msg/Path")
    assert text.count("MSG: std_msgs/Header\n") == 1
    again = types_of([Definition("nav_msgs/msg/Path", "ros2msg", text)], "jazzy")
    assert again.trouble("nav_msgs/msg/Path") == ""
    assert again.library.hash_of("nav_msgs/msg/Path") == TYPES.hash_of("nav_msgs/msg/Path")


def test_of_an_unknown_type_or_another_form_of_it_there_is_none():
    known = TYPES.hash_of("std_msgs/msg/String")
    assert definition_text(TYPES, "nobody_msgs/msg/Nobody") == ""
    assert definition_text(TYPES, "std_msgs/msg/String", known)
    assert definition_text(TYPES, "std_msgs/msg/String", "RIHS01_" + "1" * 64) == ""
