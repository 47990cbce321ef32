from __future__ import annotations

import copy

import numpy as np
import pytest

from studio.errors import MessageValueError
from studio.ros.types.classes import MessageValue, attributes_of, definition_of, maker_of
from studio.ros.types.library import TypeLibrary

LIBRARY = TypeLibrary("jazzy")
LIBRARY.add_texts(
    {
        "class_pkg/msg/All": 'int8 a 5\nstring b "x"\nfloat64[3] c [1, 2, 3]\nuint8 ON=1\n'
        "std_msgs/Header d\nstring[2] e\nint8[] f [7]\nint8 class\nstd_msgs/Header[2] g",
        "class_pkg/msg/Few": "float64[<=2] numbers\nstring[] names\nint32 count\n",
    }
)


def made(name: str) -> type[MessageValue]:
    return LIBRARY.message(name)


ALL = made("class_pkg/msg/All")


def test_a_value_has_the_defaults_of_its_type():
    value = ALL()
    assert (value.a, value.b, value.ON, ALL.ON) == (5, "x", 1, 1)
    assert value.c.tolist() == [1, 2, 3]
    assert value.e == ["", ""]
    assert value.f.tolist() == [7]
    assert value.class_ == 0
    assert value.d == value.g[1] == made("std_msgs/msg/Header")()


def test_two_values_share_nothing():
    one, other = ALL(), ALL()
    one.c[0] = 9
    one.e[0] = "y"
    one.d.frame_id = "map"
    assert other == ALL()
    assert one != other


def test_fields_are_given_by_keyword_and_no_others_exist():
    assert made("geometry_msgs/msg/Point")(x=1.0, z=2.0).z == 2.0
    with pytest.raises(TypeError):
        made("geometry_msgs/msg/Point")(w=1.0)
    with pytest.raises(AttributeError):
        made("geometry_msgs/msg/Point")().w = 1.0
    with pytest.raises(AttributeError, match="no attribute 'w'"):
        _ = made("geometry_msgs/msg/Point")().w


def test_a_value_is_shown_as_rclpy_does():
    time = made("builtin_interfaces/msg/Time")(sec=1)
    assert repr(time) == "builtin_interfaces.msg.Time(sec=1, nanosec=0)"
    assert repr(made("std_msgs/msg/Float32MultiArray")(data=[0.5])).endswith("data=[0.5])")


def test_values_are_equal_by_type_and_fields():
    state = made("sensor_msgs/msg/JointState")
    assert state(position=[1]) == state(position=np.array([1.0]))
    assert state(position=[1]) != state(position=[1, 2])
    assert made("geometry_msgs/msg/Point")() != made("geometry_msgs/msg/Vector3")()
    with pytest.raises(TypeError):
        hash(state())


def test_a_copy_is_deep_where_it_is_asked_for():
    value = made("sensor_msgs/msg/JointState")(position=[1.0])
    twin = copy.deepcopy(value)
    twin.position[0] = 2.0
    twin.header.frame_id = "x"
    assert value == made("sensor_msgs/msg/JointState")(position=[1.0])


def test_arrays_are_checked_where_they_are_set():
    value = ALL()
    with pytest.raises(MessageValueError, match="3 values are needed, 2 were given"):
        value.c = [1, 2]
    with pytest.raises(MessageValueError, match="is no list of string"):
        value.e = "ab"
    setattr(value, "f", (1, 2))  # noqa: B010  # else checkers take the tuple for what is read
    assert value.f.dtype == np.int8


def test_names_of_python_get_an_underscore():
    assert "class_" in attributes_of(ALL)
    assert ALL(class_=3).class_ == 3
    assert "class" in [field.name for field in definition_of(ALL).fields]


def test_no_name_of_a_field_meets_those_of_the_class_or_its_code():
    names = ["self", "make_0", "keep_0", "definition", "attributes", "parts", "value", "known"]
    LIBRARY.add_texts({"class_pkg/msg/Odd": "\n".join(f"int8[] {name}" for name in names)})
    odd = made("class_pkg/msg/Odd")
    value = odd(**{name: [number] for number, name in enumerate(names)})
    assert [getattr(value, name).tolist() for name in names] == [[n] for n in range(len(names))]
    assert attributes_of(odd) == tuple(names)


def test_what_was_decoded_is_made_as_it_is_but_a_bounded_sequence_is_counted():
    few, empty = made("class_pkg/msg/Few"), made("std_msgs/msg/Empty")
    make, numbers, names = maker_of(few), np.array([1.0, 2.0]), ["a"]
    value = make(numbers, names, 3)
    assert type(value) is few
    assert value.numbers is numbers
    assert value == few(numbers=numbers, names=names, count=3)
    with pytest.raises(MessageValueError, match="at most 2 values"):
        make(np.zeros(3), names, 3)
    assert maker_of(empty)(0) == empty()
