"""How texts are typed and conditions judged: as stock xacro does."""

# pyright: reportUnknownMemberType=false, reportPrivateUsage=false
# pyright: reportUnknownArgumentType=false
from __future__ import annotations

import math

import pytest
import xacro
from hypothesis import given
from hypothesis import strategies as st

from studio.description.evaluator.texts import literal_value, truth_of
from studio.description.faults import Fault

texts = st.one_of(
    st.text(alphabet="0123456789.+-eE_' \"truefalsTF", max_size=10),
    st.sampled_from(["true", "True", "false", "False", "inf", "nan", "'1'", "''", "1_0", " 7 "]),
)


def same(left: object, right: object) -> bool:
    if isinstance(left, float) and math.isnan(left):
        return isinstance(right, float) and math.isnan(right)
    return type(left) is type(right) and left == right


@given(texts)
def test_a_text_is_typed_as_xacro_types_it(text: str):
    assert same(literal_value(text), xacro.Table._eval_literal(text))


@given(st.one_of(texts, st.integers(), st.floats(), st.booleans(), st.none(), st.just((1,))))
def test_a_condition_is_judged_as_xacro_judges_it(value: object):
    try:
        expected = xacro.get_boolean_value(value, "c")
    except xacro.XacroException:
        with pytest.raises(Fault, match="neither true nor false"):
            truth_of(value, "c")
    else:
        assert truth_of(value, "c") is expected
