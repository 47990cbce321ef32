from __future__ import annotations

import pytest

from studio.errors import LaunchError
from studio.launch.frontends.texts import parse_text
from studio.launch.vocabulary.texts import described


@pytest.mark.parametrize(
    ("text", "as_described"),
    [
        ("plain text", "plain text"),
        ("$(var a)/b", "$(var a)/b"),
        ("$(find-pkg-share $(var pkg))/x", "$(find-pkg-share $(var pkg))/x"),
        ("\\$(var a)", "$(var a)"),
        ("$(eval '1 + $(var n)')", "$(eval 1 + $(var n))"),
        ("$(env HOME 'a b')", "$(env HOME)"),
        ("a $(dirname) b $(filename)", "a $(dirname) b $(filename)"),
    ],
)
def test_texts_part_into_their_substitutions(text: str, as_described: str):
    assert described(parse_text(text)) == as_described


def test_substitutions_that_nest_without_end_are_refused():
    with pytest.raises(LaunchError, match="deep in each other"):
        parse_text("$(var " * 2_000)


def test_too_few_arguments_are_a_sentence():
    with pytest.raises(LaunchError, match="has 0 arguments: var takes 1 to 2"):
        parse_text("$(var)")
