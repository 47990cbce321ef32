from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.cli.filter_expression import filter_of
from studio.errors import MessageValueError, SettingsError
from studio.ros.messages import message
from studio.ros.types.convert import from_yaml

STATE = from_yaml(
    message("sensor_msgs/msg/JointState"),
    "{header: {frame_id: base}, name: [a, b], position: [1.0, -2.5]}",
)


@pytest.mark.parametrize(
    ("expression", "is_taken"),
    [
        ("m.position[0] > 0.5", True),
        ("m.position[1] > 0 or m.header.frame_id == 'map'", False),
        ("'b' in m.name and not len(m.effort)", True),
        ("any(abs(p) > 2 for p in m.position)", True),
        ("m.header.frame_id.startswith('ba')", True),
        ("m.position[0] ** 2 + m.position[1] ** 2 < 4", False),
        ("m.header.stamp.sec", False),
    ],
)
def test_fields_are_compared_as_python_does(expression: str, is_taken: bool):
    assert filter_of(expression)(STATE) is is_taken


@pytest.mark.parametrize(
    "expression",
    [
        "",
        "m.x >",
        "m.__class__",
        "m._definition",
        "'{0.__class__}'.format(m)",
        "().__class__.__base__.__subclasses__()",
        "[x := 1]",
        "lambda: 1",
        "f'{m}'",
        "__import__('os')",
        "(" * 500 + "1" + ")" * 500,
        "m" + ".x" * 5_000,
    ],
)
def test_what_is_more_than_a_comparison_is_refused(expression: str):
    with pytest.raises(SettingsError, match="--filter"):
        filter_of(expression)


@pytest.mark.parametrize(
    "expression",
    ["m.no_such > 1", "open('x')", "m.position > 0", "m.name[7]", "1 / m.header.stamp.sec"],
)
def test_what_has_no_answer_is_one_sentence(expression: str):
    with pytest.raises(MessageValueError, match=r"^--filter: .*\.$"):
        filter_of(expression)(STATE)


@given(
    st.text() | st.from_regex(r"(m|\.data|\.x|\[0\]|\(|\)|[ +<]|1|'a'|not |len)*", fullmatch=True)
)
def test_any_text_chooses_messages_or_is_one_sentence(text: str):
    said = ""
    try:
        assert filter_of(text)(STATE) in {True, False}
    except (SettingsError, MessageValueError) as error:
        said = str(error)
    assert said == "" or said.startswith("--filter")
