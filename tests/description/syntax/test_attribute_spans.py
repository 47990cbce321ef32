"""The bytes of attribute values, against expat's own reading of the same tags."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING
from xml.parsers import expat

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.description.syntax.attribute_spans import (
    attribute_bytes,
    attribute_spans,
    attribute_text,
    character_offsets,
    text_encoding,
    writing_encoding,
)
from studio.description.syntax.source_tree import parse_source
from studio.errors import EditError

if TYPE_CHECKING:
    from pathlib import Path

XML_TEXTS = st.text(
    st.characters(exclude_categories=("Cs", "Cc"), exclude_characters="\ufffe\uffff")
    | st.sampled_from("\t\n\r<>&'\""),
    max_size=40,
)
TAGS = {
    "both quotes": b"""<p name="a" value='b'/>""",
    "a greater sign in a value": b"""<p value="a > b" other='x>y'/>""",
    "several lines with CRLF and tabs": b'<p\r\n\tname="a"\r\n\tvalue = "1\r\n2\t3"\r\n/>',
    "the other quote inside": b"""<p a="it's" b='say "x"'/>""",
    "entities": b"""<p a="&lt;1 &amp; &#50;&#x33;&quot;&apos;" b="&#10;"/>""",
    "letters beyond ASCII": '<p ключ="значение" b="é"/>'.encode(),
    "prefixes": b"""<xacro:p xmlns:xacro="u" xacro:name="n"></xacro:p>""",
    "empty values": b"""<p a="" b=''/>""",
}


def read_by_expat(data: bytes) -> dict[str, str]:
    read: dict[str, str] = {}
    parser = expat.ParserCreate()
    parser.StartElementHandler = lambda _tag, attributes: read.update(attributes)
    parser.Parse(data, True)
    return read


@pytest.mark.parametrize("tag", TAGS.values(), ids=TAGS)
def test_every_span_decodes_to_what_expat_reads(tag: bytes):
    data = tag if b"</" in tag or tag.endswith(b"/>") else tag + b"</p>"
    spans = attribute_spans(data, 0)
    texts = {name: attribute_text(data[one.start : one.end]) for name, one in spans.items()}
    assert texts == read_by_expat(data)


@pytest.mark.parametrize("tag", TAGS.values(), ids=TAGS)
def test_the_quotes_stand_right_outside_the_span(tag: bytes):
    for span in attribute_spans(tag, 0).values():
        assert tag[span.start - 1 : span.start].decode() == span.syntax
        assert tag[span.end : span.end + 1].decode() == span.syntax


@given(XML_TEXTS, st.sampled_from("\"'"))
def test_a_text_written_into_a_tag_is_read_back_by_expat(text: str, quote: str):
    data = b"<p a=" + quote.encode() + attribute_bytes(text, quote) + quote.encode() + b"/>"
    assert read_by_expat(data) == {"a": text}
    span = attribute_spans(data, 0)["a"]
    assert attribute_text(data[span.start : span.end]) == text


@given(XML_TEXTS)
def test_character_offsets_cut_a_value_into_its_characters(text: str):
    raw = attribute_bytes(text, '"')
    read, offsets = character_offsets(raw)
    assert read == text
    pieces = [raw[a:b] for a, b in pairwise(offsets)]
    assert "".join(attribute_text(piece) for piece in pieces) == text
    assert offsets[-1] == len(raw)


def test_a_letter_that_an_encoding_lacks_is_written_as_a_reference():
    assert attribute_bytes("π é", '"', "ascii") == b"&#960; &#233;"


@pytest.mark.parametrize("forbidden", ["\0", "\x1f", "\ud800", "\uffff"])
def test_a_character_that_xml_cannot_hold_is_refused_in_a_sentence(forbidden: str):
    with pytest.raises(EditError, match="cannot stand in XML"):
        attribute_bytes(f"a{forbidden}", '"')


def test_bytes_of_another_encoding_are_refused_in_a_sentence():
    with pytest.raises(EditError, match="is not utf-8 text"):
        attribute_text(b"\xe9")


def test_an_offset_with_no_element_is_refused():
    with pytest.raises(EditError, match="No element starts at byte 3"):
        attribute_spans(b'<p name="a"/>', 3)


def test_a_file_that_declares_latin_1_is_read_so_and_written_in_references():
    data = '<?xml version="1.0" encoding="ISO-8859-1"?><p a="é"/>'.encode("latin-1")
    assert (text_encoding(data), writing_encoding(data)) == ("iso8859-1", "ascii")
    span = attribute_spans(data, data.index(b"<p"))["a"]
    assert attribute_text(data[span.start : span.end], text_encoding(data)) == "é"


def test_ascii_bytes_that_declare_latin_1_are_written_in_references_too():
    data = b'<?xml version="1.0" encoding="ISO-8859-1"?><p a="e"/>'
    assert (text_encoding(data), writing_encoding(data)) == ("utf-8", "ascii")


def test_an_unknown_encoding_counts_as_utf_8():
    assert writing_encoding(b'<?xml version="1.0" encoding="klingon"?><p/>') == "utf-8"


@pytest.mark.corpus
def test_every_attribute_of_the_corpus_decodes_to_what_the_parser_read(corpus: Path):
    """And so does its position: a byte off would show in the text."""
    from tests.support.corpus_files import xml_trees

    wrong: list[str] = []
    count = 0
    for tree in xml_trees(corpus):
        for element in tree.elements:
            spans = attribute_spans(tree.data, element.offset)
            texts = {
                name: attribute_text(tree.data[one.start : one.end], tree.encoding)
                for name, one in spans.items()
            }
            count += len(texts)
            if texts != element.attributes:
                wrong.append(str(element.place))
    assert wrong == []
    assert count > 10_000


def test_a_byte_order_mark_moves_every_span_with_it():
    tree = parse_source("f", b'\xef\xbb\xbf<robot name="r"><p value="1"/></robot>')
    span = attribute_spans(tree.data, tree.elements[1].offset)["value"]
    assert tree.data[span.start : span.end] == b"1"


def test_the_encoding_of_a_large_file_is_looked_up_once():
    """Quick, as the time limit of each test is: every site of a file asks for it."""
    data = b"<robot>" + b" " * 4_000_000 + b"</robot>"
    assert {text_encoding(data) for _ in range(40_000)} == {"utf-8"}
