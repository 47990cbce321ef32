"""The defaults inside a macro's params, against xacro's own reading of the same attribute."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.parsers import expat

import pytest
from hypothesis import given, reject
from hypothesis import strategies as st

from studio.description.editing.edits import apply, edit_at
from studio.description.syntax.attribute_spans import attribute_spans
from studio.description.syntax.params import param_defaults
from studio.errors import EditError
from tests.support.foreign_readers import defaults_by_xacro

if TYPE_CHECKING:
    from pathlib import Path

GRAMMAR = (
    "a:=1 b:='x y' *block **blocks c:=^|3 d:=${1 + 2} e:=$(find p) f:=^ g "
    "h='' i:=a'b c'd j := 5 k:=^|'p q'"
)


def params_of(data: bytes) -> str:
    read: dict[str, str] = {}
    parser = expat.ParserCreate()
    parser.StartElementHandler = lambda _tag, attributes: read.update(attributes)
    parser.Parse(data, True)
    return read["params"]


def unquoted(default: str) -> str:
    is_quoted = len(default) > 1 and default[0] == default[-1] and default[0] in "'\""
    return default[1:-1] if is_quoted and default[0] not in default[1:-1] else default


def test_each_default_is_found_as_xacro_finds_it():
    data = f'<m name="m" params="{GRAMMAR}"/>'.encode()
    found = param_defaults(data, attribute_spans(data, 0)["params"])
    raw = {one.name: data[one.span.start : one.span.end].decode() for one in found}
    assert raw == defaults_by_xacro(GRAMMAR)
    assert {one.name: one.text for one in found}["b"] == "x y"


def test_a_default_may_hold_references_and_letters_beyond_ascii():
    data = "<m params='é:=&apos;a &amp; b&apos; ü:=ö'/>".encode()
    found = param_defaults(data, attribute_spans(data, 0)["params"])
    assert [(one.name, one.text) for one in found] == [("é", "a & b"), ("ü", "ö")]
    assert data[found[0].span.start : found[0].span.end] == b"&apos;a &amp; b&apos;"
    assert found[0].span.syntax == "param'"


@given(
    st.text(st.sampled_from("ab1 '\"$({})^*:=|<&é>"), min_size=1, max_size=12),
    st.sampled_from(["a", "b", "c", "d", "k"]),
    st.sampled_from(["'", '"']),
)
def test_a_written_default_is_what_xacro_then_reads_and_no_other_changes(
    text: str, name: str, quote: str
):
    params = GRAMMAR.replace("'", "&apos;") if quote == "'" else GRAMMAR
    data = f"<m params={quote}{params}{quote}/>".encode()
    before = defaults_by_xacro(params_of(data))
    spans = {one.name: one.span for one in param_defaults(data, attribute_spans(data, 0)["params"])}
    try:
        edited = apply(data, [edit_at("f", data, spans[name], text)])
    except EditError:
        reject()
    after = defaults_by_xacro(params_of(edited))
    assert unquoted(after.pop(name)) == text
    before.pop(name)
    assert after == before


def test_a_text_that_no_quotes_can_hold_is_refused_in_a_sentence():
    data = b'<m params="a:=1"/>'
    (only,) = param_defaults(data, attribute_spans(data, 0)["params"])
    with pytest.raises(EditError, match="one kind of quotes"):
        edit_at("f", data, only.span, "a 'b' \"c\"")


def test_quotes_stay_as_they_were_written():
    data = b"""<m params='a:="x y"'/>"""
    (only,) = param_defaults(data, attribute_spans(data, 0)["params"])
    edited = apply(data, [edit_at("f", data, only.span, "z")])
    assert edited == b"""<m params='a:="z"'/>"""


@pytest.mark.corpus
def test_the_defaults_of_the_corpus_are_those_that_xacro_reads(corpus: Path):
    from tests.support.corpus_files import xml_trees

    count = 0
    for tree in xml_trees(corpus):
        for element in tree.elements:
            if element.tag != "xacro:macro" or "params" not in element.attributes:
                continue
            span = attribute_spans(tree.data, element.offset)["params"]
            found = {one.name: one.text for one in param_defaults(tree.data, span, tree.encoding)}
            wanted = defaults_by_xacro(element.attributes["params"])
            assert found == {name: unquoted(text) for name, text in wanted.items()}, element.place
            count += len(found)
    assert count > 300
