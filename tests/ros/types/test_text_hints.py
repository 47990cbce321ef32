import pytest

from studio.errors import InterfaceTextError
from studio.ros.types.interface_text import parse_interface


@pytest.mark.parametrize(
    ("text", "line", "mend"),
    [
        ("float x", 1, '"float" is no type: write float32 or float64'),
        ("int32 a\nfloat[] x # m", 2, "write float32 or float64"),
        ("double x", 1, "write float64"),
        ("flaot32 x", 1, "write float32"),
        ("uint8_t x", 1, "write uint8"),
        ("time stamp", 1, "write builtin_interfaces/Time"),
        ("int32 Speed", 1, "single underscores: write speed"),
        ("int32 batteryLevel", 1, "write battery_level"),
        ("int32 a__b", 1, "write a_b"),
        ("int32 x;", 1, "leave the ; out"),
        ("int32 x; int32 y;", 1, "leave the ; out"),
        ("int32 x // metres", 1, "a comment begins with #"),
        ("int32 x\n\nint32 x", 3, "x stands there twice, first in line 1: rename one of them"),
        ("int32 x, y", 1, "one field a line"),
        ("int32 x[3]", 1, "write int32[3] x"),
        ("speed: float32", 1, "write float32 speed"),
        ("speed float32", 1, "the type comes first: float32 speed"),
        ("geometry_msgs.msg.Point p", 1, "write geometry_msgs/Point"),
        ("int32 speed=5", 1, "int32 speed 5, and a constant is in capitals, int32 SPEED=5"),
        ("int32", 1, "such as float32 speed"),
        ("--", 1, "three dashes"),
    ],
)
def test_a_line_that_is_refused_says_what_to_write(text: str, line: int, mend: str):
    with pytest.raises(InterfaceTextError) as caught:
        parse_interface("p/msg/T", text)
    assert caught.value.line == line
    assert mend in str(caught.value)


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("p/srv/T", "int32 a\n--\nint32 b", 'p/srv/T:2: "--" parts nothing: write three dashes'),
        ("p/action/T", "---\n\n----\n", 'p/action/T:3: "----" parts nothing'),
        ("p/srv/T", "int32 a", "one line of --- between request and response, and here 0."),
        ("p/action/T", "---", "two lines of --- between goal, result and feedback, and here 1."),
    ],
)
def test_a_text_with_too_few_parts_says_where_it_was_to_be_parted(name: str, text: str, said: str):
    with pytest.raises(InterfaceTextError) as caught:
        parse_interface(name, text)
    assert said in str(caught.value)


def test_a_fault_that_nothing_is_known_about_is_said_alone():
    with pytest.raises(InterfaceTextError, match=r"uint8, which goes from 0 to 255\.$"):
        parse_interface("p/msg/T", "uint8 a 256")
