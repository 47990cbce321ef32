from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.ros.types.yaml_texts import read_yaml, write_yaml


@given(st.dictionaries(st.text(max_size=5), st.text(max_size=8) | st.integers() | st.booleans()))
def test_plain_values_read_back(values: dict[str, object]):
    assert read_yaml(write_yaml(values)) == values


def test_keys_keep_their_order():
    assert write_yaml({"b": 1, "a": [2]}) == "b: 1\na:\n- 2\n"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("a: [", "no YAML"),
        ("a: &x 1\nb: *x", "references"),
        ("!!python/object/apply:os.getcwd []", "no YAML"),
        ("[" * 100_000, "no YAML"),
        (" " * 10_000_001, "more than"),
    ],
)
def test_a_text_that_is_no_plain_yaml_is_refused(text: str, reason: str):
    with pytest.raises(ValueError, match=reason):
        read_yaml(text)
