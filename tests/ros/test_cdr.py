from __future__ import annotations

import contextlib
import signal
import struct
import subprocess
import sys
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosbags.typesys import Stores, get_typestore

from studio.errors import CdrError, MessageValueError, UnknownTypeError
from studio.ros.cdr import Codec
from studio.ros.types.library import TypeLibrary
from tests.support.ros_values import values_of
from tests.support.sweep import some_of

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue

LIBRARY = TypeLibrary("jazzy")
LIBRARY.add_texts(
    {
        "cdr_pkg/msg/Mixed": "uint8 a\nfloat64 b\nbool c\nstring d\nint64[] e\nInner[2] f\n"
        "Inner[<=3] g\nstring<=4[<=2] h\nbyte i\nchar[3] j\nbool[] k\nstring[2] l\nuint16 m",
        "cdr_pkg/msg/Inner": "int8 x\nfloat64 y\nint16[<=2] z",
        "cdr_pkg/msg/Words": "int8 class\nint8 from\nint8 self\nint8 val",
        "cdr_pkg/msg/Wide": "wstring text",
    }
)
WIDE = {"cdr_pkg/msg/Wide", "example_interfaces/msg/WString"}
TYPES = [
    *(name for name in LIBRARY.names() if "/msg/" in name and name not in WIDE),
    "example_interfaces/srv/AddTwoInts_Request",
    "example_interfaces/srv/AddTwoInts_Event",
    "std_srvs/srv/Empty_Request",
    "example_interfaces/action/Fibonacci_FeedbackMessage",
]


def message(name: str) -> type[MessageValue]:
    return LIBRARY.message(name)


def test_a_text_is_written_byte_for_byte():
    string = message("std_msgs/msg/String")
    written = Codec(string).encode(string(data="hi é"))
    assert bytes(written) == b"\0\1\0\0" + b"\x06\0\0\0" + "hi é".encode() + b"\0"


def test_numbers_are_aligned_from_behind_the_header_in_both_orders():
    mixed = message("cdr_pkg/msg/Inner")
    value = mixed(x=1, y=2.0, z=[3, 4])
    little = struct.pack("<b7xdI2h", 1, 2.0, 2, 3, 4)
    big = struct.pack(">b7xdI2h", 1, 2.0, 2, 3, 4)
    assert bytes(Codec(mixed).encode(value)) == b"\0\1\0\0" + little
    assert bytes(Codec(mixed).encode(value, little_endian=False)) == b"\0\0\0\0" + big


@pytest.mark.parametrize("name", ["std_msgs/msg/Empty", "std_srvs/srv/Trigger_Request"])
def test_a_message_without_fields_is_one_byte(name: str):
    empty = message(name)
    written = Codec(empty).encode(empty())
    assert bytes(written) == b"\0\1\0\0\0"
    assert Codec(empty).decode(written) == empty()


@pytest.mark.parametrize("name", some_of(TYPES))
def test_the_defaults_of_every_type_survive(name: str):
    kind = message(name)
    codec = Codec(kind)
    assert codec.decode(codec.encode(kind())) == kind()


@settings(max_examples=60)
@given(st.data())
def test_any_message_of_any_type_survives_in_both_orders(data: st.DataObject):
    kind = message(data.draw(st.sampled_from(TYPES)))
    value = data.draw(values_of(kind))
    codec = Codec(kind)
    assert codec.decode(codec.encode(value)) == value
    assert codec.decode(codec.encode(value, little_endian=False)) == value


@pytest.mark.parametrize(
    "name", ["sensor_msgs/msg/JointState", "tf2_msgs/msg/TFMessage", "sensor_msgs/msg/PointCloud2"]
)
@settings(max_examples=15)
@given(data=st.data())
def test_bytes_are_those_that_rosbags_writes_by_itself(name: str, data: st.DataObject):
    value = data.draw(values_of(message(name)))
    store = get_typestore(Stores.ROS2_JAZZY)
    written = Codec(message(name)).encode(value)
    assert bytes(store.serialize_cdr(store.deserialize_cdr(bytes(written), name), name)) == written


CODECS = [
    Codec(message(name))
    for name in ("cdr_pkg/msg/Mixed", "sensor_msgs/msg/JointState", "tf2_msgs/msg/TFMessage",
                 "diagnostic_msgs/msg/DiagnosticArray", "std_msgs/msg/Empty")
]  # fmt: skip


@given(st.sampled_from(CODECS), st.sampled_from([b"", b"\0\1\0\0", b"\0\0\0\0"]), st.binary())
def test_any_bytes_are_a_message_or_refused_by_name(codec: Codec, header: bytes, body: bytes):
    with contextlib.suppress(CdrError):
        codec.decode(header + body)


@pytest.mark.parametrize("name", ["tf2_msgs/msg/TFMessage", "sensor_msgs/msg/JointState"])
def test_a_count_that_no_bytes_follow_costs_nothing(name: str):
    with pytest.raises(CdrError):
        Codec(message(name)).decode(b"\0\1\0\0" + b"\xff" * 40)


def test_every_cut_of_a_message_is_refused_or_read():
    transforms = [message("geometry_msgs/msg/TransformStamped")(child_frame_id="a")] * 2
    kind = message("tf2_msgs/msg/TFMessage")
    whole = bytes(Codec(kind).encode(kind(transforms=transforms)))
    for end in range(len(whole)):
        with pytest.raises(CdrError):
            Codec(kind).decode(whole[:end])


@pytest.mark.parametrize("more", [1, 3, 4, 1000])
def test_bytes_behind_a_message_are_passed_over(more: int):
    string = message("std_msgs/msg/String")
    written = Codec(string).encode(string(data="x"))
    assert Codec(string).decode(bytes(written) + bytes(more)).data == "x"


@pytest.mark.parametrize("header", [b"\0\7\0\0", b"\0\x0b\0\0", b"\1\1\0\0", b"\0", b""])
def test_other_encodings_than_plain_cdr_are_refused(header: bytes):
    with pytest.raises(CdrError, match="header"):
        Codec(message("std_msgs/msg/String")).decode(header)


def test_arrays_that_were_read_are_views_that_nobody_can_write():
    image = message("sensor_msgs/msg/Image")
    written = bytes(Codec(image).encode(image(data=bytes(range(100)))))
    pixels = Codec(image).decode(written).data
    assert pixels.base is not None
    assert not pixels.flags.writeable
    assert np.shares_memory(pixels, np.frombuffer(written, dtype=np.uint8))


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ({"a": 256}, "a: 256 does not fit uint8"),
        ({"a": 1.5}, "a: 1.5 is no whole number"),
        ({"b": "x"}, "b: 'x' is no number"),
        ({"d": 5}, "d: 5 is no text"),
        ({"d": "\ud800"}, "d: the text holds half a letter"),
        ({"h": ["12345"]}, "longer than 4"),
        ({"h": ["a", 5]}, "h[1]: 5 is no text"),
        ({"f": [1, 2]}, "f[0]: 1 is no cdr_pkg/msg/Inner"),
    ],
)
def test_a_value_that_does_not_fit_is_named(fields: dict[str, object], sentence: str):
    mixed = message("cdr_pkg/msg/Mixed")
    with pytest.raises(MessageValueError) as caught:
        Codec(mixed).encode(mixed(**fields))
    assert sentence in str(caught.value)


def test_a_list_that_grew_beyond_its_bound_is_not_sent():
    mixed = message("cdr_pkg/msg/Mixed")
    value = mixed(h=["a", "b"])
    value.h.append("c")
    with pytest.raises(MessageValueError, match="at most 2"):
        Codec(mixed).encode(value)


def test_texts_of_wide_letters_are_refused_with_the_reason():
    wide = message("cdr_pkg/msg/Wide")
    with pytest.raises(UnknownTypeError, match="wstring"):
        Codec(wide)


@pytest.mark.parametrize("caught", [True, False])
@pytest.mark.parametrize("moment", range(3))
def test_ctrl_c_while_code_is_generated_ends_the_process_only_where_nobody_catches_it(
    moment: int, caught: bool
):
    program = f"""
import signal, sys
from studio.ros.cdr import Codec
from studio.ros.types.library import TypeLibrary

def interrupt(frame, event, _):
    code = frame.f_code
    if code.co_filename in ("<string>", "<generated>") and code.co_name == "<module>":
        moments.append(code)
    if len(moments) > {moment}:
        sys.settrace(None)
        signal.raise_signal(signal.SIGINT)

kind = TypeLibrary("jazzy").message("std_msgs/msg/String")
moments = []
sys.settrace(interrupt)
try:
    Codec(kind).encode(kind(data="x"))
except KeyboardInterrupt:
    print("interrupted")
    if not {caught}:
        raise
"""
    ended = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert ended.stdout == "interrupted\n"
    assert ended.returncode == (0 if caught else -signal.SIGINT)
