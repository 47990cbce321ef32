"""Where in the markup a cursor is, in whole texts and in broken ones."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.description.language.token_at import (
    Segment,
    Where,
    open_tags,
    read_tag,
    segment_at,
    segments_in,
    token_at,
)


def where(marked: str):
    text = marked.replace("|", "", 1)
    return token_at(text, marked.index("|")), text


@pytest.mark.parametrize(
    ("marked", "expected"),
    [
        ("<a>te|xt</a>", Where.CONTENT),
        ("|<a/>", Where.CONTENT),
        ("<a/>|", Where.CONTENT),
        ("<|a/>", Where.TAG_NAME),
        ("<xacro:if| value='1'>", Where.TAG_NAME),
        ("<a |b='1'/>", Where.ATTRIBUTE_NAME),
        ("<a b|='1'/>", Where.ATTRIBUTE_NAME),
        ("<a | />", Where.ATTRIBUTE_NAME),
        ("<a b='1|'/>", Where.VALUE),
        ("<a b='|'/>", Where.VALUE),
        ("<a b='x > |y'/>", Where.VALUE),
        ("<a></|a>", Where.CLOSING),
        ("<a></a>|", Where.CONTENT),
        ("<!-- <a b='|'/> -->", Where.SILENT),
        ("<!-- a --|>", Where.SILENT),
        ("<![CDATA[ <a |> ]]>", Where.SILENT),
        ("<?xml ver|sion='1.0'?>", Where.SILENT),
        ("<!-- never closed <a |", Where.SILENT),
    ],
)
def test_the_markup_says_where_a_cursor_is(marked: str, expected: Where):
    assert where(marked)[0].where is expected


@pytest.mark.parametrize(
    ("marked", "expected"),
    [
        ('<a b="x|\n<c d="e"/>', Where.VALUE),
        ('<a b="x"\n<c |d="e"/>', Where.ATTRIBUTE_NAME),
        ("<a b= |<c/>", Where.ATTRIBUTE_NAME),
        ("<a <b <c|", Where.TAG_NAME),
        ("</|", Where.CLOSING),
        ("<|", Where.TAG_NAME),
        ('<a b="1" "" c="|"/>', Where.VALUE),
    ],
)
def test_a_broken_tag_further_up_does_not_mislead(marked: str, expected: Where):
    assert where(marked)[0].where is expected


def test_a_value_is_known_with_its_attribute_and_its_tag():
    token, text = where('<joint name="a" type="rev|olute"/>')
    assert token.tag is not None
    assert token.attribute is not None
    assert (token.tag.name, token.attribute.name) == ("joint", "type")
    assert text[token.start : token.end] == "revolute"
    assert [one.name for one in token.tag.attributes] == ["name", "type"]


def test_a_value_that_is_never_closed_ends_with_its_line():
    tag = read_tag('<a b="x y\n  c="1"', 0)
    assert (tag.attributes[0].start, tag.attributes[0].end) == (6, 14)
    alone = read_tag('<a b="x y\n', 0)
    assert (alone.attributes[0].start, alone.attributes[0].end) == (6, 9)


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("<a><b><c/>", ["a", "b"]),
        ("<a><b></b>", ["a"]),
        ("<a><!-- <b> --><c>", ["a", "c"]),
        ("<a><b></a><c>", ["c"]),
        ("<a></z><b x='>'>", ["a", "b"]),
        ("<?xml version='1.0'?><a>", ["a"]),
        ("<a><!-- <b>", ["a"]),
    ],
)
def test_the_tags_that_are_open_are_those_not_closed_before_the_cursor(text: str, names: list[str]):
    assert [one.name for one in open_tags(text, len(text))] == names


def test_segments_are_cut_as_xacro_cuts_them_and_may_be_unclosed():
    text = "a ${b + '}'} $(find c)/d $${e} ${f"
    found = list(segments_in(text, 0, len(text)))
    assert [text[one.start : one.end] for one in found] == ["b + '", "find c", "f"]
    assert [one.is_closed for one in found] == [True, True, False]


def test_a_substitution_inside_of_an_expression_is_found_first():
    token, text = where('<a b="${1 + $(arg |n)}"/>')
    segment = segment_at(text, token, text.index("n)"))
    assert segment == Segment(False, text.index("arg"), text.index(")}"))


@given(
    st.text(alphabet="<>/=\"'$\u007b\u007d()! -?[]CDATAab\n\u00e4\U0001f916", max_size=120),
    st.data(),
)
def test_no_text_and_no_place_is_too_odd(text: str, data: st.DataObject):
    index = data.draw(st.integers(0, len(text)))
    token = token_at(text, index)
    assert 0 <= token.start <= token.end <= len(text)
    if token.where is Where.VALUE:
        assert token.start <= index <= token.end
        segment_at(text, token, index)
    open_tags(text, index)
