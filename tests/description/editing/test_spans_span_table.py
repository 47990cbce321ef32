"""Spans of sites between two runs."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.description.editing.edits import apply
from studio.description.editing.spans import SpanTable
from studio.description.values import Edit, Site, SiteKind, Span, Widget, WidgetKind
from studio.errors import StaleEditError
from studio.problems import Place

TEXT = b"<p a='10' b='' c='x'/>"
SPANS = {"a": Span(6, 8, "'"), "b": Span(13, 13, "'"), "c": Span(18, 19, "'")}


def site(name: str, span: Span, file: str = "f") -> Site:
    widget = Widget(WidgetKind.TEXT)
    place = Place(file, 1, 1)
    return Site(name, SiteKind.PROPERTY, name, place, span, "", "", None, 0, widget, "")


def table() -> SpanTable:
    spans = SpanTable()
    spans.adopt([site(*pair) for pair in SPANS.items()], tuple(SPANS), 0)
    return spans


def test_an_edit_stretches_its_own_span_and_moves_those_behind():
    spans = table()
    spans.note([Edit("f", 6, 8, b"12345")])
    assert spans.span("a") == Span(6, 11, "'")
    assert spans.span("b") == Span(16, 16, "'")


def test_an_edit_of_another_file_moves_nothing():
    spans = table()
    spans.note([Edit("g", 0, 1, b"12345")])
    assert spans.span("c") == SPANS["c"]


@given(st.lists(st.tuples(st.sampled_from("abc"), st.text("0123456789", max_size=4)), max_size=9))
def test_after_any_edits_each_span_holds_what_was_last_written_there(writes: list[tuple[str, str]]):
    spans, text = table(), TEXT
    wanted = {name: text[span.start : span.end] for name, span in SPANS.items()}
    for name, written in writes:
        span = spans.span(name)
        edit = Edit("f", span.start, span.end, written.encode())
        text = apply(text, [edit])
        spans.note([edit])
        wanted[name] = edit.new
    found = {name: spans.span(name) for name in SPANS}
    assert {name: text[span.start : span.end] for name, span in found.items()} == wanted


def test_an_edit_that_is_under_way_when_a_run_ends_still_counts():
    """The run saw the first edit only; its sites are true at that version."""
    spans = table()
    sent = spans.note([Edit("f", 6, 8, b"1")])
    spans.note([Edit("f", 6, 7, b"12345")])
    seen = [replace(spans.site("a"), span=Span(6, 7, "'")), site("c", Span(17, 18, "'"))]
    spans.adopt(seen, None, sent)
    assert spans.span("a") == Span(6, 11, "'")
    assert spans.span("c") == Span(21, 22, "'")


def test_a_site_that_the_order_no_longer_names_is_gone():
    spans = table()
    spans.adopt([], ("a", "b"), 0)
    with pytest.raises(StaleEditError, match="c is no longer in the source"):
        spans.span("c")


def test_an_edit_across_an_end_of_a_span_makes_it_stale():
    spans = table()
    spans.note([Edit("f", 7, 14, b"?")])
    with pytest.raises(StaleEditError):
        spans.span("a")
    assert spans.span("c") == Span(12, 13, "'")


@pytest.mark.parametrize(
    ("edit", "why"),
    [
        (Edit("f", 7, 10, b"???"), "as many bytes, across its end"),
        (Edit("f", 8, 9, b""), "the quote behind it deleted"),
        (Edit("f", 5, 6, b""), "the quote before it deleted"),
        (Edit("f", 8, 8, b"'"), "a quote typed into it"),
        (Edit("f", 6, 8, b"1' d='2"), "another attribute pasted over it"),
    ],
)
def test_a_text_that_may_end_elsewhere_is_stale_until_a_run_tells_its_place(edit: Edit, why: str):
    spans = table()
    sent = spans.note([edit])
    with pytest.raises(StaleEditError):
        spans.span("a")
    spans.adopt([], None, sent)
    spans.note([Edit("f", 0, 0, b" ")])
    with pytest.raises(StaleEditError):
        spans.span("a")
    told = replace(spans.site("a"), span=Span(40, 41, "'"))
    spans.adopt([told], None, spans.version)
    assert spans.span("a") == told.span, why


def test_what_is_typed_within_the_quotes_stays_one_text():
    spans = table()
    spans.note([Edit("f", 7, 7, b" ${x} "), Edit("f", 6, 7, b"")])
    assert spans.span("a") == Span(6, 13, "'")


@pytest.mark.parametrize("syntax", ["yaml", "param"])
def test_a_value_without_quotes_around_it_is_only_sure_as_one_whole_word(syntax: str):
    spans = SpanTable()
    spans.adopt([site("v", Span(3, 6, syntax))], ("v",), 0)
    spans.note([Edit("f", 3, 6, b"1.5e3")])
    assert spans.span("v") == Span(3, 8, syntax)
    spans.note([Edit("f", 8, 8, b"0")])
    with pytest.raises(StaleEditError):
        spans.span("v")


def test_a_text_that_was_written_as_its_place_spells_it_is_sure_whatever_it_says():
    spans = SpanTable()
    spans.adopt([site("v", Span(3, 6, "yaml"))], ("v",), 0)
    spans.note([Edit("f", 3, 6, b"'a # b'")])
    spans.wrote("v")
    assert spans.span("v") == Span(3, 10, "yaml")
