"""Where names are defined."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.description.language.definitions import parameters_of
from studio.description.syntax.params import name_in_params, read_parameters


@pytest.mark.parametrize(
    ("text", "name", "at"),
    [
        ("a b", "b", 2),
        ("a:=b b", "b", 5),
        ("a:='x b' b:=1", "b", 9),
        ("  *o **p q:=^|2", "p", 7),
        ("a:=${b} b", "b", 8),
        ("ab a", "a", 3),
        ("a", "b", -1),
        ("", "a", -1),
        ("a " * 20_000, "b", -1),
    ],
)
def test_a_parameter_is_found_by_its_own_name_and_not_in_a_default(text: str, name: str, at: int):
    assert name_in_params(text, name) == at


@given(st.text(alphabet="ab*:=^|'\" ${}", max_size=30))
def test_every_parameter_is_found_where_it_is_written(text: str):
    for name in read_parameters(text)[0]:
        at = name_in_params(text, name.lstrip("*"))
        assert at >= 0
        assert text[at:].startswith(name.lstrip("*"))


def test_parameters_say_what_a_call_must_give():
    told = [
        (one.name, one.kind, one.default, one.is_required)
        for one in parameters_of("a b:=1 c:=^ d:=^|2 e:='' *f **g")
    ]
    assert told == [
        ("a", "value", None, True),
        ("b", "value", "1", False),
        ("c", "value", None, False),
        ("d", "value", "2", False),
        ("e", "value", "''", False),
        ("f", "block", None, True),
        ("g", "blocks", None, True),
    ]
