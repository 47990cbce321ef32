"""The source tree: where everything stands in the bytes, and what is not read."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.syntax.source_tree import (
    DEPTH_LIMIT,
    SourceError,
    SourceText,
    parse_source,
)
from tests.support.corpus_files import xml_trees
from tests.support.descriptions import XMLNS

if TYPE_CHECKING:
    from pathlib import Path


def test_each_element_knows_its_line_column_and_byte():
    data = f'<robot {XMLNS}>\r\n <!-- ä -->\t<link name="ö"\n a="1"/> é<x/>\n</robot>'.encode()
    tree = parse_source("a.xacro", data)
    robot, link, x = tree.elements
    assert (robot.place.line, robot.place.column, robot.offset) == (1, 1, 0)
    assert (link.place.line, link.place.column) == (2, 13)
    assert (x.place.line, x.place.column) == (3, 11)
    for element in tree.elements:
        assert data[element.offset :].startswith(f"<{element.tag}".encode())
    assert [element.ordinal for element in tree.elements] == [0, 1, 2]
    assert link.parent is robot
    assert list(link.attributes.items()) == [("name", "ö"), ("a", "1")]


def test_references_are_resolved_and_comments_kept():
    tree = parse_source("a", b"<r a='&lt;&#65;&quot;'>t &amp; u<!--one-->v<![CDATA[<w>]]></r>")
    assert tree.root.attributes == {"a": '<A"'}
    texts = [child for child in tree.root.children if isinstance(child, SourceText)]
    assert [(text.text, text.literal) for text in texts] == [
        ("t & u", False),
        ("v", False),
        ("<w>", True),
    ]
    assert [comment.text for comment in tree.comments] == ["one"]


def test_a_long_text_is_one_text():
    tree = parse_source("a", b"<r>" + b"x" * 100_000 + b"</r>")
    (text,) = tree.root.children
    assert isinstance(text, SourceText)
    assert len(text.text) == 100_000


@pytest.mark.parametrize(
    ("data", "encoding", "value"),
    [
        ("<r a='ä'/>".encode(), "utf-8", "ä"),
        (b"\xef\xbb\xbf<r a='\xc3\xa4'/>", "utf-8", "ä"),
        (b"<?xml version='1.0' encoding='ISO-8859-1'?><r a='\xe4'/>", "ISO-8859-1", "ä"),
        (b"<?xml version='1.0' encoding='cp1252'?><r a='\x80'/>", "cp1252", "€"),
        # xacro opens files as UTF-8 whatever they declare
        ("<?xml version='1.0' encoding='ISO-8859-1'?><r a='ä'/>".encode(), "utf-8", "ä"),
    ],
)
def test_an_encoding_is_what_the_bytes_are_else_what_is_declared(
    data: bytes, encoding: str, value: str
):
    tree = parse_source("a", data)
    assert (tree.encoding, tree.root.attributes["a"]) == (encoding, value)
    assert data[tree.root.offset :].startswith(b"<r")


@pytest.mark.parametrize("uri", ["http://www.ros.org/wiki/xacro", "http://ros.org/wiki/xacro"])
def test_xacro_is_recognised_by_its_namespace_in_either_spelling(uri: str):
    assert parse_source("a.urdf", f'<r xmlns:xacro="{uri}"/>'.encode()).uses_xacro
    assert not parse_source("a.xacro", b'<r xmlns:xacro="http://else"/>').uses_xacro


@pytest.mark.parametrize(
    ("data", "code", "words", "line"),
    [
        (b"", "file-empty", "is empty", 1),
        (b"\0\1", "file-binary", "is binary", 1),
        (b"version https://git-lfs.github.com/spec/v1\n", "file-lfs-pointer", "git lfs pull", 1),
        ("<r/>".encode("utf-16-le"), "file-utf16", "save it as UTF-8", 1),
        (b"x <?xml version='1.0'?><r/>", "xml-not-first", "before <?xml", 1),
        (b"<!--c-->\n<?xml version='1.0'?><r/>", "xml-malformed", "very first", 2),
        (b"<r>\n<a></r>", "xml-malformed", "still open", 2),
        (b"<r>\n<a>", "xml-malformed", "close it", 2),
        (b"<r a=1/>", "xml-malformed", "needs quotes", 1),
        (b"<r><x:a/></r>", "xml-unbound-prefix", 'xmlns:x="..."', 1),
        (b"<r>\n<xacro:a/></r>", "xml-unbound-prefix", "xmlns:xacro=", 2),
        (b"<r a='\xff'/>", "file-encoding", "save it as UTF-8", 1),
        (b"<?xml version='1.0' encoding='klingon'?><r a='\xff'/>", "file-encoding", "KLINGON", 1),
        (
            b"<?xml version='1.0' encoding='shift_jis'?><r a='\x83\x5c'/>",
            "file-encoding",
            "shift_jis",
            1,
        ),
        (b"<!DOCTYPE r [<!ENTITY e 'v'>]><r>&e;</r>", "xml-entity", '"e"', 1),
        (b"<!DOCTYPE r [<!ENTITY % p 'v'>]><r/>", "xml-entity", '"p"', 1),
        (b"<a>" * (DEPTH_LIMIT + 1), "xml-too-deep", "nested deeper", 1),
    ],
)
def test_what_is_not_read_is_said_with_its_place(data: bytes, code: str, words: str, line: int):
    with pytest.raises(SourceError) as refused:
        parse_source("robot.xacro", data)
    assert refused.value.code == code
    assert words in refused.value.sentence
    assert (refused.value.place.file, refused.value.place.line) == ("robot.xacro", line)


@pytest.mark.corpus
def test_every_element_of_the_corpus_starts_at_its_byte(corpus: Path):
    count = 0
    for tree in xml_trees(corpus):
        for element in tree.elements:
            assert tree.data.startswith(f"<{element.tag}".encode(), element.offset), element
            count += 1
    assert count > 30_000
