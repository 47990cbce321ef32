from __future__ import annotations

from studio.live.known_packages import known_packages, type_fault
from studio.ros.types.library import TypeLibrary


def test_types_and_packages_of_ros_are_known():
    known = known_packages(TypeLibrary("jazzy"), ["mine"])
    assert "std_msgs/msg/String" in known.types_by_package["std_msgs"]
    assert known.has_package("radio_station_interfaces")
    assert known.has_package("robot_state_publisher")
    assert known.has_package("mine")
    assert not known.has_package("quux_of_mine")


def test_a_text_that_defines_no_type_is_a_sentence_with_its_line():
    assert type_fault("a_msgs/msg/A", "int32 a\n") is None
    fault = type_fault("a_msgs/msg/A", "int32 a\nnothing b\n")
    assert fault is not None
    assert fault.line == 2
    assert fault.sentence.endswith(".")
    assert type_fault("a_msgs/msg/a b", "int32 a\n") is not None
