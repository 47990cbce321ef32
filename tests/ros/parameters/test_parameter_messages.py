from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import InvalidParameterTypeError
from studio.ros.cdr import Codec
from studio.ros.parameters.parameter import Parameter, ParameterMessages, usual_messages, value_of
from studio.ros.types.library import TypeLibrary
from tests.support.ros_values import values_of

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue

CODEC = Codec(usual_messages().Parameter)
INTEGERS = st.integers(-(2**63), 2**63 - 1)
DOUBLES = st.floats(allow_nan=False)
TEXTS = st.text(max_size=8)
VALUES = st.one_of(
    st.none(),
    st.booleans(),
    INTEGERS,
    DOUBLES,
    TEXTS,
    st.binary(min_size=1, max_size=5),
    st.lists(st.booleans(), min_size=1, max_size=4),
    st.lists(INTEGERS, min_size=1, max_size=4),
    st.lists(DOUBLES, min_size=1, max_size=4),
    st.lists(TEXTS, min_size=1, max_size=4),
)


@given(VALUES)
def test_a_parameter_survives_the_wire(value: object):
    parameter = Parameter("a.b", value=value)
    read = Parameter.from_parameter_msg(CODEC.decode(CODEC.encode(parameter.to_parameter_msg())))
    assert read == parameter


def test_a_value_of_no_known_type_is_refused_by_name():
    value = usual_messages().ParameterValue(type=77)
    with pytest.raises(InvalidParameterTypeError, match=r'"gain".*77'):
        value_of("gain", value)


def test_each_distribution_has_the_messages():
    for distro in ("humble", "jazzy", "kilted"):
        messages = ParameterMessages.of(TypeLibrary(distro))
        made = Parameter("x", value=1.5).to_parameter_msg(messages)
        assert Codec(messages.Parameter).encode(made) == CODEC.encode(
            Parameter("x", value=1.5).to_parameter_msg()
        )


@given(values_of(usual_messages().Parameter))
def test_any_message_is_a_parameter_or_one_named_error(message: MessageValue):
    try:
        parameter = Parameter.from_parameter_msg(message)
    except InvalidParameterTypeError:
        return
    assert parameter.type_.check(parameter.value)
