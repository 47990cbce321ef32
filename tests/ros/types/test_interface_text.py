from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import InterfaceTextError, RosNameError
from studio.interfaces import carried_texts
from studio.ros.types.definitions import (
    Action,
    Constant,
    Field,
    FieldType,
    Message,
    Service,
    Shape,
    messages_of,
)
from studio.ros.types.interface_text import TEXT_BYTES_MAX, parse_interface


def message(text: str) -> Message:
    parsed = parse_interface("my_pkg/msg/Thing", text)
    assert isinstance(parsed, Message)
    return parsed


def field_type(text: str) -> FieldType:
    (field,) = message(f"{text} x").fields
    return field.type


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("int32", FieldType("int32")),
        ("string<=5", FieldType("string", string_bound=5)),
        ("float64[36]", FieldType("float64", Shape.ARRAY, 36)),
        ("byte[]", FieldType("byte", Shape.SEQUENCE)),
        ("uint8[<=9]", FieldType("uint8", Shape.BOUNDED, 9)),
        ("string<=5[<=9]", FieldType("string", Shape.BOUNDED, 9, 5)),
        ("wstring", FieldType("wstring")),
        ("Header", FieldType("std_msgs/msg/Header")),
        ("Other[]", FieldType("my_pkg/msg/Other", Shape.SEQUENCE)),
        ("geometry_msgs/Point", FieldType("geometry_msgs/msg/Point")),
        ("geometry_msgs/msg/Point", FieldType("geometry_msgs/msg/Point")),
    ],
)
def test_every_form_of_a_type_is_read(text: str, kind: FieldType):
    assert field_type(text) == kind


@pytest.mark.parametrize(
    "text",
    ["int32", "string<=5[<=9]", "my_pkg/Other[]", "float64[36]", "geometry_msgs/Point[2]"],
)
def test_a_type_is_written_as_it_was_read(text: str):
    assert str(field_type(text)) == text


def test_constants_and_defaults_have_the_values_that_they_say():
    read = message(
        "uint8 ON=1\nstring WORD = it's # quoted \nfloat32 HALF=0.5\nbool YES=true\n"
        'int32 a -3\nstring b "x # y"\nint16[3] c [1, 2, 0x10]\nstring[] d ["p, q", \'r\']'
    )
    assert [(one.name, one.value) for one in read.constants] == [
        ("ON", 1), ("WORD", "it's"), ("HALF", 0.5), ("YES", True),
    ]  # fmt: skip
    assert [one.default for one in read.fields] == [-3, "x # y", (1, 2, 16), ("p, q", "r")]


def test_comments_are_kept_with_what_they_are_about():
    read = message(
        "# A thing\n# of mine.\n\n# how far\nfloat64 x # metres\n\n# lost\n\n"
        "float64 y\nuint8 A=1 # one"
    )
    assert read.comment == "A thing\nof mine."
    assert [field.comment for field in read.fields] == ["how far\nmetres", ""]
    assert read.constants == (Constant("A", "uint8", 1, "one"),)


def test_a_service_has_two_parts_and_an_action_three():
    service = parse_interface("p/srv/Ask", "---\r\nint32 x\r\n")
    assert isinstance(service, Service)
    assert service.request == Message("p/srv/Ask_Request")
    assert service.response.fields == (Field("x", FieldType("int32")),)
    action = parse_interface("p/action/Do", "int8 a\n---\nint8 b\n---\nint8 c")
    assert isinstance(action, Action)
    assert [part.name for part in messages_of(action)] == [
        "p/action/Do_Goal", "p/action/Do_Result", "p/action/Do_Feedback",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("int32", "is no type and name"),
        ("int32 2x", "is no type and name"),
        ("int32 X", "no name of a field"),
        ("int32 a__b", "no name of a field"),
        ("int32 a_", "no name of a field"),
        ("int32 a\nint8 a", "2: a stands there twice"),
        ("int32 a=1", "no name of a constant"),
        ("int32 A=x", "no whole number"),
        ("int32 A=", "no value"),
        ("int32[] A=1", "constants are single"),
        ("uint8 a 256", "does not fit uint8"),
        ("int8 a -129", "does not fit int8"),
        ("bool a maybe", "neither true nor false"),
        ("float32 a inf", "no number that"),
        ('string a "x', "do not close"),
        ("string<=2 a abc", "longer than 2"),
        ("int8[2] a [1]", "1 values instead of 2"),
        ("int8[<=1] a [1,2]", "at most 1 fit"),
        ("int8[] a 1", "in brackets"),
        ("Point a 1", "has no default"),
        ("int32[0] a", "one place at least"),
        ("int32[99999999999] a", "no length"),
        ("int32[-1] a", "is no type"),
        ("int32<=3 a", "only strings have a bound"),
        ("string<=0 a", "only strings have a bound"),
        ("int a", '"int" is no type: write int32 or int64'),
        ("a/b/c/D a", "only those are fields"),
        ("a/srv/D a", "only those are fields"),
        ("Std/Thing a", "lower case"),
        ("int32 a\n---\nint32 b", "a .msg has no line of ---, and here 1"),
    ],
)
def test_a_text_that_rosidl_would_refuse_is_refused_with_its_line(text: str, sentence: str):
    with pytest.raises(InterfaceTextError) as caught:
        message(text)
    assert sentence in str(caught.value)
    assert str(caught.value).startswith("my_pkg/msg/Thing")


def test_huge_texts_are_refused():
    with pytest.raises(InterfaceTextError, match="longer than"):
        message("#" * (TEXT_BYTES_MAX + 1))
    with pytest.raises(InterfaceTextError, match="at most 2000"):
        message("\n".join(f"int8 a{number}" for number in range(2001)))


@pytest.mark.parametrize(
    "text",
    [
        f"int8 {'A' * 5000}a=1",
        f"int8 {'A_' * 2000}=1",
        "int8[] a [" + "1" + " " * 9000 + "[]",
        'string a "' + "\\" * 9000,
        "string a " + '"' * 1_000_000,
    ],
)
def test_no_text_takes_long(text: str):
    with pytest.raises(InterfaceTextError):
        message(text)


@pytest.mark.parametrize("name", ["Thing", "p/msg/thing", "p/msg/A_Request", "../x/msg/T"])
def test_a_bad_name_of_a_type_is_refused(name: str):
    with pytest.raises(RosNameError):
        parse_interface(name, "")


@pytest.mark.parametrize("name", carried_texts())
def test_every_carried_text_says_what_it_is_for(name: str):
    first = messages_of(parse_interface(name, carried_texts()[name]))[0]
    assert first.comment or not first.fields


def test_the_carried_texts_lie_in_folders_of_their_packages():
    import studio.interfaces

    folder = Path(studio.interfaces.__file__).parent
    files = [path for path in folder.rglob("*") if path.suffix in {".msg", ".srv", ".action"}]
    assert len(files) == len(carried_texts()) > 90


LINES = st.lists(
    st.text(alphabet="abX1_ =#\"'[],<-./\\\t", max_size=24)
    | st.sampled_from(["---", "int32 a", "string A=x", "Header h", "uint8[] d [1]", "# c", ""]),
    max_size=8,
).map("\n".join)


@given(st.sampled_from(["p/msg/T", "p/srv/T", "p/action/T"]), LINES | st.text(max_size=60))
def test_any_text_is_read_or_refused_by_name(name: str, text: str):
    try:
        parsed = parse_interface(name, text)
    except InterfaceTextError:
        return
    assert parsed.name == name
