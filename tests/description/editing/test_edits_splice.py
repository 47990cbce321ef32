"""Edits change their bytes and no other, on made-up files and on every file of the corpus."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.description.editing.edits import apply, decode, difference, edit_at, encode, inverse
from studio.description.syntax.attribute_spans import attribute_spans
from studio.description.syntax.params import param_defaults
from studio.description.syntax.source_tree import parse_source
from studio.description.syntax.yaml_spans import read_yaml_document
from studio.description.values import Edit, Span
from studio.errors import EditError

if TYPE_CHECKING:
    from pathlib import Path

ROVER = (
    '\ufeff<?xml version="1.0" encoding="utf-8"?>\r\n'
    '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\r\n'
    "  <!-- Räder -->\r\n"
    "  <xacro:property\tname=\"radius\"\r\n    value = '0.10'/>\r\n"
    '  <xacro:property name="test" value="${a > b and &quot;x&quot; &lt; 1}"/>\r\n'
    '  <xacro:macro name="m" params="a:=1 b:=\'x y\'"/>\r\n'
    "</robot>\r\n"
).encode()


def spans_of(data: bytes) -> list[Span]:
    tree = parse_source("f", data)
    elements = [one for one in tree.elements if one.tag != "robot"]
    return [span for one in elements for span in attribute_spans(data, one.offset).values()]


def test_one_edit_changes_only_its_span():
    data = ROVER
    span = attribute_spans(data, parse_source("f", data).elements[1].offset)["value"]
    edited = apply(data, [edit_at("f", data, span, "0.12")])
    assert edited == data.replace(b"0.10", b"0.12")


def test_what_an_expression_says_is_kept_when_it_is_written_again():
    for span in spans_of(ROVER):
        assert edit_at("f", ROVER, span, decode(ROVER, span)).new == ROVER[span.start : span.end]


@given(st.data())
def test_any_edits_and_then_their_inverses_give_the_file_back(data: st.DataObject):
    now, undo = ROVER, list[Edit]()
    for _ in range(data.draw(st.integers(1, 8))):
        span = data.draw(st.sampled_from(spans_of(now)))
        text = data.draw(st.text(st.sampled_from("0123456789. <&>'\"é\t\n${}x"), max_size=9))
        edit = edit_at("f", now, span, f"v{text}")
        undo.append(inverse(now, edit))
        before, now = now, apply(now, [edit])
        assert now[: edit.start] == before[: edit.start]
        assert now[edit.start + len(edit.new) :] == before[edit.end :]
        assert decode(now, Span(edit.start, edit.start + len(edit.new), span.syntax)) == f"v{text}"
    assert apply(now, reversed(undo)) == ROVER


@given(st.binary(max_size=40), st.binary(max_size=40))
def test_a_difference_leads_from_one_text_to_the_other(old: bytes, new: bytes):
    edit = difference("f", old, new)
    assert (apply(old, [edit]) if edit else old) == new
    assert edit is None or old != new


def test_a_difference_is_as_short_as_it_can_be():
    assert difference("f", b"a = 0.10;", b"a = 0.12;") == Edit("f", 7, 8, b"2")


def test_an_edit_outside_the_file_is_refused():
    with pytest.raises(EditError, match="bytes 3-9 are not in the file"):
        apply(b"abc", [Edit("f", 3, 9, b"")])


def test_a_latin_1_file_stays_latin_1():
    data = '<?xml version="1.0" encoding="latin-1"?><p a="é" b="1"/>'.encode("latin-1")
    span = attribute_spans(data, data.index(b"<p"))["b"]
    edited = apply(data, [edit_at("f", data, span, "ü€")])
    assert parse_source("f", edited).root.attributes == {"a": "é", "b": "ü€"}
    assert edited.replace(b"&#252;&#8364;", b"1") == data


def test_a_yaml_scalar_is_written_in_the_style_it_has():
    data = "a: 'x' # é\nb: 1.50\n".encode()
    first, second = (one.span for one in read_yaml_document(data).scalars)
    assert encode("it's", data, first) == b"'it''s'"
    assert encode("1.75", data, second) == b"1.75"


@pytest.mark.corpus
def test_writing_what_stands_there_leaves_every_file_of_the_corpus_as_it_is(corpus: Path):
    """Every attribute, every macro default and every YAML scalar, decoded and spelled again."""
    from tests.support.corpus_files import xml_trees, yaml_files

    checked = 0
    for tree in xml_trees(corpus):
        spans = [s for e in tree.elements for s in _editable(tree.data, e.offset, e.tag)]
        edits = [edit_at("f", tree.data, span, decode(tree.data, span)) for span in spans[:400]]
        assert apply(tree.data, edits) == tree.data, tree.path
        checked += len(edits)
    for path in yaml_files(corpus):
        data = path.read_bytes()
        spans = [one.span for one in read_yaml_document(data).scalars]
        assert apply(data, [edit_at("f", data, s, decode(data, s)) for s in spans]) == data, path
        checked += len(spans)
    assert checked > 20_000


def _editable(data: bytes, offset: int, tag: str) -> list[Span]:
    spans = attribute_spans(data, offset)
    found = list(spans.values())
    if tag == "xacro:macro" and "params" in spans:
        found += [one.span for one in param_defaults(data, spans["params"])]
    return found
