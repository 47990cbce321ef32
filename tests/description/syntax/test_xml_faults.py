from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.description.syntax.source_tree import SourceError, parse_source

WHOLE = b"<robot name='r'><link name=\"a\"><mass value='1'/><!-- m --></link></robot>"


def fault_of(data: bytes) -> SourceError:
    with pytest.raises(SourceError) as refused:
        parse_source("robot.xacro", data)
    return refused.value


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (b"<r a=1/>", 'The value of a needs quotes: write a="...".'),
        (b"<r><a b/></r>", 'b has no value: write b="...".'),
        (b"<r><a b = 'c' d e='1'/></r>", 'd has no value: write d="...".'),
        (b"<r>\n<a></r>", "</r> closes nothing here: <a> of line 2 is still open."),
        (b"<r>\n<a>", "The file ends while <a> of line 2 is open: close it."),
        (b"<r><a b='1'\n<c/></r>", "The tag <a> has no > yet."),
    ],
)
def test_a_fault_is_told_with_the_names_of_the_file(data: bytes, sentence: str):
    assert fault_of(data).sentence == sentence


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"<r a='1'b='2'/>", "space is missing"),
        (b"<r a='1' a='2'/>", "stands twice"),
        (b"<r a='x<y'/>", "closing quote missing"),
        (b"<r><a b='1>\n<c d='2'/></r>", "closing quote missing"),
        (b"<r>a & b</r>", "&amp;"),
        (b"<r a='&&'/>", "&amp;"),
        (b"<r>&foo;</r>", "&amp;"),
        (b"<r><!-- a -- b --></r>", '"--"'),
        (b"<r/><s/>", "closed above"),
        (b"<r>< a/></r>", "&lt;"),
        (b"<r></ r>", "&lt;"),
        (b"<r><a", "to the end of the file"),
        (b"<r><![CDATA[ x</r>", "]]>"),
        (b"<r><a 5='1'/></r>", '"5" cannot stand here'),
    ],
)
def test_a_fault_comes_with_what_to_do(data: bytes, words: str):
    assert words in fault_of(data).sentence


@pytest.mark.parametrize(
    ("data", "line", "column"),
    [
        (b"<r>\n  <xacro:\n\n</r>", 2, 3),
        (b"<r>\r\n\xc3\xbc <a b='1'\r\n<c/></r>", 2, 3),
        (b"<r>\n<a b='1><c/>\n<d e='2'/></r>", 2, 9),
        (b"<r>\n<a b='1>\n<c d='2'/></r>", 2, 1),
        (b"<r>\n<a b='x<y'/></r>", 2, 8),
        (b"<r><a>\n</r>", 2, 3),
    ],
)
def test_a_tag_without_its_end_is_told_where_it_begins(data: bytes, line: int, column: int):
    place = fault_of(data).place
    assert (place.line, place.column) == (line, column)


@given(st.integers(0, len(WHOLE) - 1), st.sampled_from([b"", b"<", b">", b"&", b"'", b'"', b"-"]))
def test_whatever_is_broken_is_told_in_one_short_sentence(at: int, instead: bytes):
    try:
        parse_source("robot.xacro", WHOLE[:at] + instead + WHOLE[at + 1 :])
    except SourceError as error:
        sentence = error.sentence
        assert sentence.endswith((".", "?", ")"))
        assert "\n" not in sentence
        assert len(sentence) < 200
