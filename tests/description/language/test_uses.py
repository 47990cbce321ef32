"""Names in expressions, finished or not."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.description.language.uses import chain_at, chains_of, string_at


def written(text: str) -> list[tuple[str, tuple[str | int, ...]]]:
    return [(chain.base, chain.keys) for chain in chains_of(text)]


@pytest.mark.parametrize(
    ("text", "chains"),
    [
        ("a + b*2", [("a", ()), ("b", ())]),
        ("cfg['joint']['limit'].upper", [("cfg", ("joint", "limit", "upper"))]),
        ('cfg["a"][0]', [("cfg", ("a", 0))]),
        ("cfg[&quot;a&quot;]", [("cfg", ("a",))]),
        ("a &lt; b", [("a", ()), ("b", ())]),
        ("radians(x)", [("radians", ()), ("x", ())]),
        ("f(x).y + 1e3", [("f", ()), ("x", ())]),
        ("cfg[key]['a']", [("cfg", ()), ("key", ())]),
        ("x if y else 'z'", [("x", ()), ("y", ())]),
        ("cfg['a'", [("cfg", ())]),
        ("größe / 2", [("größe", ())]),
        ("", []),
    ],
)
def test_the_names_of_an_expression_are_found_with_what_is_read_below_them(
    text: str, chains: list[tuple[str, tuple[str | int, ...]]]
):
    assert written(text) == chains


def test_the_name_of_a_loop_is_its_own():
    found = {chain.base: chain.is_local for chain in chains_of("[n * k for n in range(3)]")}
    assert found == {"n": True, "k": False, "range": False}


def test_a_cursor_is_in_the_chain_up_to_its_step():
    text = "1 + cfg['joint']['limit']"
    inside = chain_at(text, text.index("joint") + 2)
    assert inside is not None
    assert inside.keys == ("joint",)
    step = inside.steps[-1]
    assert text[step.start : step.end] == "joint"
    assert chain_at(text, 1) is None


def test_a_quoted_text_is_found_without_its_quotes():
    text = "xacro.load_yaml('config/a.yaml')"
    found = string_at(text, 20)
    assert found is not None
    assert (found.key, text[found.start : found.end]) == ("config/a.yaml", "config/a.yaml")
    assert string_at(text, 3) is None


@given(st.text(alphabet="ab.[]'\"&quot;() +1\u00fc", max_size=60))
def test_any_text_has_chains_whose_places_lie_in_it(text: str):
    for chain in chains_of(text):
        for step in chain.steps:
            assert 0 <= step.start <= step.end <= len(text)
            if isinstance(step.key, str):
                assert text[step.start : step.end] == step.key
