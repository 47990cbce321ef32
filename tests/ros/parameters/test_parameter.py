from __future__ import annotations

import pytest

from studio.errors import InvalidParameterTypeError
from studio.ros.parameters.parameter import Parameter


def test_a_parameter_knows_its_type_from_its_value():
    assert Parameter("a", value=1.5).type_ is Parameter.Type.DOUBLE
    assert Parameter("a").type_ is Parameter.Type.NOT_SET


def test_a_parameter_is_read_as_the_tutorials_do():
    assert Parameter("a", Parameter.Type.STRING, "x").get_parameter_value().string_value == "x"
    assert list(Parameter("a", value=[1, 2]).get_parameter_value().integer_array_value) == [1, 2]


def test_a_value_of_another_type_than_the_one_named_is_refused():
    with pytest.raises(InvalidParameterTypeError, match="1 is no double"):
        Parameter("a", Parameter.Type.DOUBLE, 1)


def test_parameters_are_equal_by_name_type_and_value():
    assert Parameter("a", value=1) == Parameter("a", value=1)
    assert Parameter("a", value=1) != Parameter("a", value=True)
    assert Parameter("a", value=1) != Parameter("b", value=1)
    assert repr(Parameter("a", value=1)) == "Parameter('a', INTEGER, 1)"
