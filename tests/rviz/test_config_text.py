"""Texts of `.rviz` files as trees: what is kept, and what is refused before it costs anything."""

from __future__ import annotations

import time

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import RvizConfigError
from studio.rviz.config_text import (
    DEPTH_MAX,
    NODES_MAX,
    SIZE_LIMIT_BYTES,
    Tree,
    quoted,
    read_tree,
    scalar_of,
    text_of,
    write_tree,
)
from tests.support.corpus import corpus

SCALARS = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(allow_nan=False), st.text(max_size=20)
)
KEYS = st.text(st.characters(exclude_categories=["Cs"]), min_size=1, max_size=10)
TREES = st.recursive(
    SCALARS,
    lambda below: st.one_of(st.lists(below, max_size=4), st.dictionaries(KEYS, below, max_size=4)),
    max_leaves=20,
)


@pytest.mark.corpus
def test_every_file_of_the_corpus_is_written_as_it_was_to_the_byte():
    files = sorted(corpus().rglob("*.rviz"))
    assert len(files) == 57
    for file in files:
        text = file.read_text()
        assert write_tree(read_tree(text)) == text, file


@given(TREES)
def test_any_tree_is_the_same_after_reading_and_writing(tree: object):
    written = yaml.safe_dump(tree, allow_unicode=True)
    assert yaml.safe_load(write_tree(read_tree(written))) == yaml.safe_load(written)


@given(st.text(max_size=300))
def test_any_text_is_a_tree_or_refused(text: str):
    try:
        tree = read_tree(text)
    except RvizConfigError:
        return
    assert read_tree(write_tree(tree)) == tree


@given(st.text(st.characters(exclude_categories=["Cs"]), max_size=30))
def test_a_text_is_what_its_scalar_says(text: str):
    assert text_of(scalar_of(text)) == (text if text else "")
    assert text_of(quoted(text)) == text
    assert yaml.safe_load(f"a: {scalar_of(text)}") == {"a": text}


@pytest.mark.parametrize(
    ("text", "tree"),
    [
        ("a: 0.50", {"a": "0.50"}),
        ("a: '0.50'", {"a": '"0.50"'}),
        ("a: ~", {"a": "~"}),
        ("a: |\n  two\n  lines\n", {"a": '"two\\nlines\\n"'}),
        ("a: &x {b: 1}\nc: *x\n", {"a": {"b": "1"}, "c": {"b": "1"}}),
        ("'a b': 1\n\"1\": 2", {"a b": "1", '"1"': "2"}),
        ("# nothing", {}),
        ("a: !!str 5", {"a": '"5"'}),
    ],
)
def test_scalars_stay_as_they_are_written(text: str, tree: Tree):
    assert read_tree(text) == tree


def bomb() -> str:
    """Nine lists of nine aliases each: 9 to the 9th values."""
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]" for n in range(1, 10)]
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (bomb(), "more than 50,000 values"),
        ("a: &a [*a]", "stands for itself"),
        ("[" * 200_000, "nested deeper"),
        ("- " * 200_000, "nested deeper"),
        ("x: {" * 100_000, "nested deeper"),
        (f"a: {'x' * SIZE_LIMIT_BYTES}", "more than 1 MB"),
        ("- x\n" * (NODES_MAX + 1), "values"),
        ("? [a, b]\n: 1", "a key is no text"),
        (f"? {'k' * 2000}\n: 1", "a key is no text"),
        ("a: 1\n---\nb: 2", "more than one document"),
        ("a: [1, 2", "line"),
        ("a: \x01", "not allowed"),
        ("*a", "alias"),
        ("\t- x", "cannot start any token"),
    ],
)
def test_what_is_no_such_file_is_refused_at_once(text: str, reason: str):
    began_s = time.monotonic()
    with pytest.raises(RvizConfigError, match=reason):
        read_tree(text)
    assert time.monotonic() - began_s < 5.0


def test_as_deep_as_allowed_is_read():
    assert read_tree("[" * DEPTH_MAX + "]" * DEPTH_MAX)
