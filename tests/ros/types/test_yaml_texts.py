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


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{data: [", "'{data: [' is no YAML (line 1, column 9: expected the node content, but "),
        (
            "a: 1\nb: c: d",
            "'a: 1' is no YAML (line 2, column 5: mapping values are not allowed here)",
        ),
        ("x\x01", "is no YAML (the letter at place 2 is none that YAML allows)"),
        ("x" * 70 + ": [", f"'{'x' * 60}...' is no YAML"),
        ("!!python/none x", "could not determine a constructor"),
        ("[" * 5000, "(it is nested too deeply)"),
    ],
)
def test_what_was_read_is_quoted_with_line_column_and_reason(text: str, said: str):
    with pytest.raises(ValueError, match="is no YAML") as caught:
        read_yaml(text)
    assert said in str(caught.value)
    assert "string>" not in str(caught.value)
    with pytest.raises(ValueError, match=r"^/ws/p\.yaml is no YAML \("):
        read_yaml(text, "/ws/p.yaml")
