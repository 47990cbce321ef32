"""The studio's own part of a config file: what a page tells comes back, and stays readable."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import RvizConfigError
from studio.rviz.config_page import page_entry, page_of, page_text
from studio.rviz.config_text import read_tree, write_tree
from studio.rviz.config_values import Entry, entry_at

JSON = st.recursive(
    st.one_of(
        st.none(),
        st.booleans(),
        st.integers(-(2**53), 2**53),
        st.floats(allow_nan=False, allow_infinity=False),
        st.text(st.characters(exclude_categories=["Cs"]), max_size=10),
    ),
    lambda below: st.one_of(
        st.lists(below, max_size=4),
        st.dictionaries(
            st.text(st.characters(exclude_categories=["Cs"]), max_size=6), below, max_size=4
        ),
    ),
    max_leaves=15,
)


@given(JSON)
def test_what_a_page_tells_comes_back_from_the_file(told: object):
    entry = page_entry(json.dumps({"Panels": told}), {})
    written = read_tree(write_tree({"Studio": entry}))
    assert json.loads(page_text(entry_at(written, "Studio")))["Panels"] == told


def test_what_a_page_does_not_name_stays_and_so_does_what_a_newer_studio_wrote():
    before: Entry = {"Version": "1", "Later": {"a": "1"}, "Panels": "~"}
    entry = page_entry('{"Panels": {"parts": []}}', before)
    assert entry == {"Version": "1", "Later": {"a": "1"}, "Panels": {"parts": []}}
    assert page_text({**entry, "Version": "2"}) == ""
    assert page_text({"Panels": {}}) == ""
    assert page_text({}) == ""


@pytest.mark.parametrize("text", ["", "[", "[]", "5", "[" * 100_000, json.dumps([[0] * 60_000])])
def test_what_is_no_object_is_refused(text: str):
    with pytest.raises(RvizConfigError):
        page_entry(text, {})


def test_what_is_too_much_is_refused():
    with pytest.raises(RvizConfigError, match="too much"):
        page_entry(json.dumps({"a": [0] * 60_000}), {})
    with pytest.raises(RvizConfigError, match="too much"):
        page_entry('{"a": ' + "[" * 60 + "]" * 60 + "}", {})


def test_a_file_without_such_a_part_opens_the_panels_that_rviz_has():
    panels = """Panels:
  - {Class: rviz_common/Displays}
  - {Class: rviz/Tool Properties}
  - {Class: rviz_common/Help}
  - {Class: other/Views}
  - {Class: rviz_common/Displays}
"""
    tree = read_tree(panels)
    assert isinstance(tree, dict)
    assert json.loads(page_of(tree)) == {"Open": ["displays", "tools"]}
    own: Entry = {**tree, "Studio": page_entry('{"Plots": []}', {})}
    assert json.loads(page_of(own)) == {"Plots": [], "Version": 1}
    assert page_of({}) == page_of({"Panels": []}) == ""


def test_half_a_letter_is_written_as_its_number():
    """JSON may name one; a file in UTF-8 holds none."""
    entry = page_entry(r'{"Plots": [{"topic": "a\ud800"}]}', {})
    assert rb'"a\ud800"' in write_tree({"Studio": entry}).encode()
