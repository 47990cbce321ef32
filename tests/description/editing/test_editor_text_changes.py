from __future__ import annotations

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from studio.description.editing.editor_text import Piece, changes_between, patched

TEXTS = st.text(alphabet="ab\n🤖ü", max_size=30)


@given(TEXTS, TEXTS)
def test_the_pieces_lead_from_the_one_text_to_the_other(old: str, new: str):
    pieces = changes_between(old, new)
    assert patched(old, pieces) == new
    assert list(pieces) == sorted(pieces, key=lambda piece: piece.start)
    assert all(one.end < two.start for one, two in pairwise(pieces))


def test_a_text_that_is_the_same_has_no_pieces():
    assert changes_between("a\nb", "a\nb") == ()


def test_values_changed_in_two_lines_leave_the_lines_between_alone():
    old = "<a x='1'/>\n<keep/>\n<b y='2'/>"
    new = "<a x='15'/>\n<keep/>\n<b y='3'/>"
    assert changes_between(old, new) == (Piece(7, 7, "5"), Piece(25, 26, "3"))


def test_lines_that_came_are_one_piece():
    assert changes_between("a\nc\n", "a\nb\nc\n") == (Piece(2, 2, "b\n"),)
