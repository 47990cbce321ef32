"""Texts are cut where stock xacro's lexer cuts them."""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportAttributeAccessIssue=false
from __future__ import annotations

from typing import cast

import pytest
import xacro
from hypothesis import given
from hypothesis import strategies as st

from studio.description.faults import Fault
from studio.description.syntax.templates import Cut, Segment, segments_of

texts = st.text(alphabet="$${}(){}ab \n", max_size=16)


def cut_by_stock(text: str) -> list[Segment]:
    lexer = xacro.QuickLexer(xacro.LEXER)
    lexer.lex(text)
    found: list[Segment] = []
    while lexer.peek():
        kind, token = cast("tuple[int, str]", lexer.next())
        if kind == lexer.EXPR:
            found.append((Cut.EXPRESSION, token[2:-1]))
        elif kind == lexer.EXTENSION:
            found.append((Cut.SUBSTITUTION, token[2:-1]))
        else:
            found.append((Cut.TEXT, token if kind == lexer.TEXT else token[1:]))
    return found


@given(texts)
def test_a_text_is_cut_as_xacro_cuts_it(text: str):
    try:
        expected = cut_by_stock(text)
    except xacro.XacroException:
        with pytest.raises(Fault):
            segments_of(text)
    else:
        assert list(segments_of(text)) == expected


@pytest.mark.parametrize(
    ("text", "words"),
    [("a ${b", 'not closed by "}"'), ("$(find x", 'not closed by ")"'), ("$$a", "begins nothing")],
)
def test_what_is_not_closed_is_said(text: str, words: str):
    with pytest.raises(Fault, match=words.replace("(", r"\(").replace(")", r"\)")):
        segments_of(text)
