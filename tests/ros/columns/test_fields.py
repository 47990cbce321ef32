from __future__ import annotations

import math
import struct
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.errors import CdrError, FieldPathError
from studio.ros.cdr import codec_of
from studio.ros.columns.field_paths import number_at, steps_of
from studio.ros.columns.fields import FieldReader
from studio.ros.types.library import TypeLibrary
from tests.support.ros_values import values_of

LIBRARY = TypeLibrary("jazzy")
LIBRARY.add_texts(
    {
        "made/msg/Nothing": "",
        "made/msg/Word": "uint8 kind\nstring text\nfloat64[] numbers",
        "made/msg/Mixed": (
            "string[] names\nNothing[] nothings\nWord[2] words\nWord[] more\nbool[3] flags\n"
            "uint16[] shorts\ngeometry_msgs/Vector3[] vectors\nint64 large\nbyte raw\n"
            "builtin_interfaces/Duration lasted\nfloat32[4] turn\nstring<=5 bounded\n"
            "int8[<=3] few\nfloat32 last\n"
        ),
    }
)
PATHS = {
    "std_msgs/msg/Float64": [".data"],
    "std_msgs/msg/Bool": ["data"],
    "nav_msgs/msg/Odometry": [
        ".header.stamp",
        ".header.stamp.nanosec",
        "pose.pose.position.x",
        ".pose.covariance[35]",
        ".pose.covariance[-2]",
        ".pose.covariance.@norm",
        ".pose.pose.orientation.@yaw.@deg",
        ".pose.pose.orientation.@roll",
        ".pose.pose.orientation.@pitch",
        ".twist.twist.linear.@norm",
        ".twist.twist.angular.z.@deg.@rad",
    ],
    "sensor_msgs/msg/JointState": [
        ".name.@length",
        ".name[1].@length",
        ".position[1]",
        ".velocity[-1]",
        ".effort[0]",
        ".effort.@length",
    ],
    "sensor_msgs/msg/LaserScan": [".ranges[2]", ".intensities[0].@rad", ".ranges.@norm"],
    "tf2_msgs/msg/TFMessage": [
        ".transforms[0].transform.translation.y",
        ".transforms[-1].transform.rotation.@yaw",
        ".transforms[2].header.stamp",
        ".transforms.@length",
    ],
    "diagnostic_msgs/msg/DiagnosticArray": [".status[1].level", ".status[0].values.@length"],
    "made/msg/Mixed": [
        ".words[1].numbers[0]",
        ".more[1].kind",
        ".more[-1].numbers[-1]",
        ".flags[1]",
        ".shorts[-1]",
        ".vectors[1].z",
        ".vectors[0].@norm",
        ".nothings[0].@norm",
        ".large",
        ".raw",
        ".lasted",
        ".lasted.@norm",
        ".turn.@norm",
        ".few[1]",
        ".bounded.@length",
        ".last",
    ],
}
CASES = [(name, path) for name, paths in PATHS.items() for path in paths]


def reader_of(name: str, path: str) -> FieldReader:
    kind = LIBRARY.message(name)
    return FieldReader(kind, path, codec_of(kind).decode)


def joined(
    payloads: list[bytes], between: bytes = b""
) -> tuple[bytes, np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """One piece of memory with all of them, and where each begins, and its length."""
    sizes = np.array([len(one) for one in payloads], np.int64)
    offsets = len(between) + np.cumsum(sizes + len(between)) - sizes - len(between)
    return between + between.join(payloads), offsets, sizes


def read_all(name: str, path: str, payloads: list[bytes], between: bytes = b"") -> list[float]:
    return reader_of(name, path).read(*joined(payloads, between)).tolist()


def decoded(name: str, path: str, payload: bytes) -> float:
    return number_at(codec_of(LIBRARY.message(name)).decode(payload), steps_of(path))


@pytest.mark.parametrize("name", PATHS)
@settings(max_examples=20)
@given(data=st.data())
def test_numbers_of_many_messages_are_those_of_the_decoder(name: str, data: Any):  # noqa: ANN401
    codec = codec_of(LIBRARY.message(name))
    values = data.draw(st.lists(values_of(LIBRARY.message(name)), min_size=1, max_size=6))
    orders = data.draw(st.lists(st.booleans(), min_size=len(values), max_size=len(values)))
    between = data.draw(st.binary(max_size=9))
    payloads = [
        bytes(codec.encode(value, little_endian=little))
        for value, little in zip(values, orders, strict=True)
    ]
    for path in PATHS[name]:
        found = read_all(name, path, payloads, between)
        wanted = [decoded(name, path, one) for one in payloads]
        np.testing.assert_allclose(found, wanted, rtol=4e-16, err_msg=path)


@given(cut=st.integers(0, 700), name_path=st.sampled_from(CASES), filling=st.binary(max_size=60))
def test_what_is_cut_off_or_rubbish_has_no_number_and_harms_no_other(
    cut: int, name_path: tuple[str, str], filling: bytes
):
    name, path = name_path
    whole = bytes(codec_of(LIBRARY.message(name)).encode(LIBRARY.message(name)()))
    hostile = [whole[:cut], b"\0\1\0\0" + filling, filling, b"", b"\0\1\0\0" + b"\xff" * 90]
    found = read_all(name, path, [whole, *hostile, whole])
    wanted = decoded(name, path, whole)
    np.testing.assert_equal([found[0], found[-1]], [wanted, wanted])
    for payload, number in zip(hostile, found[1:-1], strict=True):
        try:
            whole_number = decoded(name, path, payload)
        except CdrError:
            continue  # the number may lie before what is wrong
        np.testing.assert_allclose(number, whole_number, rtol=4e-16)


def test_a_long_list_of_a_few_messages_is_read_as_one_of_many():
    kind = LIBRARY.message("tf2_msgs/msg/TFMessage")
    transform = LIBRARY.message("geometry_msgs/msg/TransformStamped")
    value = kind(transforms=[transform(child_frame_id="a" * (n % 7)) for n in range(200)])
    value.transforms[150].transform.translation.x = 4.5
    payload = bytes(codec_of(kind).encode(value))
    path = ".transforms[150].transform.translation.x"
    assert read_all("tf2_msgs/msg/TFMessage", path, [payload] * 2) == [4.5] * 2
    assert read_all("tf2_msgs/msg/TFMessage", path, [payload] * 40) == [4.5] * 40


def test_a_count_that_lies_costs_nothing():
    lying = struct.pack("<BBHI", 0, 1, 0, 2**32 - 1) + bytes(1000)
    for path in (".name[4000000000]", ".position[3]", ".effort[0]"):
        if path.startswith(".name"):
            with pytest.raises(FieldPathError):
                reader_of("sensor_msgs/msg/JointState", path)
            continue
        assert math.isnan(read_all("sensor_msgs/msg/JointState", path, [lying] * 50)[0])


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        ("", "looks like"),
        (".pose..x", "looks like"),
        (".pose.@size", "looks like"),
        (".nobody", "no field nobody"),
        (".header", "a std_msgs/msg/Header lies there"),
        (".header.frame_id", "a text lies there"),
        (".pose.covariance", "a list lies there"),
        (".pose.covariance[36]", "has 36 items"),
        (".header.stamp[0]", "lies before [0]"),
        (".header.@yaw", "not worked out"),
        (".pose.pose.position.x.@norm", "not worked out"),
        (".pose.pose.position.@norm.x", "within a number"),
        (".pose.pose.position.@norm.@yaw", "not worked out"),
    ],
)
def test_a_path_without_a_number_is_refused_in_a_sentence(path: str, reason: str):
    with pytest.raises(FieldPathError) as refused:
        reader_of("nav_msgs/msg/Odometry", path)
    assert reason in str(refused.value)
    assert str(refused.value).endswith(".")
