"""Where a text differs from its base, by edits alone, against the texts themselves."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from studio.description.editing.edits import apply, inverse
from studio.description.editing.spans import ChangedRegions
from studio.description.values import Edit, Span

BASE = b"<a x='1.00' y='2'/><b z=''/>"
X, Y, Z = Span(6, 10, "'"), Span(15, 16, "'"), Span(25, 25, "'")


def edited(*edits: Edit) -> tuple[bytes, ChangedRegions]:
    text, regions = BASE, ChangedRegions(BASE)
    for edit in edits:
        text = apply(text, [edit])
        regions.note(edit, text)
    return text, regions


def test_two_edits_of_one_place_are_one_region():
    _, regions = edited(Edit("f", 6, 10, b"3"), Edit("f", 6, 7, b"4.5"))
    assert len(regions) == 1


def test_two_places_are_two_regions_and_each_knows_its_base():
    text, regions = edited(Edit("f", 6, 10, b"3"), Edit("f", 12, 13, b"77"))
    assert (len(regions), text) == (2, b"<a x='3' y='77'/><b z=''/>")
    assert regions.base_span(Span(6, 7, "'")) == X
    assert regions.base_span(Span(12, 14, "'")) == Y
    assert regions.base_span(Span(23, 23, "'")) == Z


def test_an_empty_value_that_was_filled_is_empty_in_the_base():
    _, regions = edited(Edit("f", 25, 25, b"9"))
    assert regions.base_span(Span(25, 26, "'")) == Z


def test_a_place_that_was_emptied_and_filled_again_is_one_region():
    _, regions = edited(Edit("f", 6, 10, b""), Edit("f", 6, 6, b"8"))
    assert len(regions) == 1
    assert regions.base_span(Span(6, 7, "'")) == X


def test_going_back_to_the_base_leaves_no_region():
    _, regions = edited(Edit("f", 6, 10, b"3"), Edit("f", 6, 7, b"1.00"))
    assert len(regions) == 0


def test_a_change_across_an_end_of_a_place_hides_its_base():
    _, regions = edited(Edit("f", 8, 16, b"?"))
    assert regions.base_span(Span(6, 8, "'")) is None


@given(st.data())
def test_the_regions_are_where_the_texts_differ(data: st.DataObject):
    """Everything outside of them is the base's, in order; and undoing all leaves none."""
    text, regions, undo = BASE, ChangedRegions(BASE), list[Edit]()
    for _ in range(data.draw(st.integers(0, 8))):
        start = data.draw(st.integers(0, len(text)))
        end = data.draw(st.integers(start, min(len(text), start + 6)))
        edit = Edit("f", start, end, data.draw(st.binary(max_size=6)))
        undo.insert(0, inverse(text, edit))
        text = apply(text, [edit])
        regions.note(edit, text)
    whole = regions.base_span(Span(0, len(text), "'"))
    assert whole == Span(0, len(BASE), "'")
    for edit in undo:
        text = apply(text, [edit])
        regions.note(edit, text)
    assert text == BASE
