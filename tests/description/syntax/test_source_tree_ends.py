from __future__ import annotations

import pytest

from studio.description.syntax.recovery import recover
from studio.description.syntax.source_tree import parse_source
from studio.errors import EditError


def written(data: bytes, tag: str) -> tuple[bytes, bytes]:
    """An element as a whole, and what stands inside it."""
    (element,) = [one for one in parse_source("x", data).elements if one.tag == tag]
    return data[element.offset : element.end], data[element.inside : element.end_tag]


@pytest.mark.parametrize(
    ("inside", "whole", "content"),
    [
        (b"<a/>", b"<a/>", b""),
        (b'<a x=">" y=\'"/>\' />', b'<a x=">" y=\'"/>\' />', b""),
        (b"<a></a>", b"<a></a>", b""),
        (b"<a>t</a  >", b"<a>t</a  >", b"t"),
        (b"<a><b/><c>/></c></a><d/>", b"<a><b/><c>/></c></a>", b"<b/><c>/></c>"),
        (b"<a><!-- </a> --><![CDATA[</a>]]></a>", b"<a><!-- </a> --><![CDATA[</a>]]></a>", None),
        (b"<a/></r><!-- behind -->", b"<a/>", b""),
        ("<a>größer</a>".encode(), "<a>größer</a>".encode(), "größer".encode()),
    ],
)
def test_an_element_ends_behind_its_own_end_tag(inside: bytes, whole: bytes, content: bytes | None):
    text = b"<r>" + inside if b"</r>" in inside else b"<r>" + inside + b"</r>"
    found = written(text, "a")
    assert found[0] == whole
    assert content is None or found[1] == content


def test_the_root_ends_with_the_file():
    assert written(b"<r>\n<a/></r>\n", "r") == (b"<r>\n<a/></r>", b"\n<a/>")


def test_an_element_longer_than_what_is_read_at_once_has_its_end():
    data = b"<r><a>" + b"<b/>" * 20_000 + b"</a></r>"
    assert written(data, "a")[0] == data[3:-4]


def test_an_element_of_the_same_name_inside_is_not_the_end():
    (outer, _) = [
        one for one in parse_source("x", b"<r><a><a/></a></r>").elements if one.tag == "a"
    ]
    assert outer.end == len(b"<r><a><a/></a>")


def test_an_element_of_a_broken_text_ends_where_it_is_whole():
    tree = recover("x", b"<robot><a><b/></a><c><d x=1/></c><e></robot>").tree
    whole, broken, open_one = (
        next(one for one in tree.elements if one.tag == tag) for tag in ("a", "c", "e")
    )
    assert tree.data[whole.offset : whole.end] == b"<a><b/></a>"
    for one in (broken, open_one):
        with pytest.raises(EditError, match="was not found"):
            _ = one.end
