"""Bytes as lines and columns of an editor, before and after typing."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.description.editing.editor_text import EditorText
from studio.description.language.reading import Drift, TextPlaces


@pytest.mark.parametrize(
    "data",
    [
        b"<a>\n  <b/>\n</a>",
        b"\xef\xbb\xbf<a>\r\n  <b/>\r\n</a>",
        "<a>\r<größe/>\r🤖<b/>".encode(),
        '<?xml version="1.0" encoding="iso-8859-1"?>\n<a n="ö"/><b/>'.encode("latin-1"),
    ],
)
def test_a_place_counts_lines_and_code_units_as_the_editor_does(data: bytes):
    editor = EditorText(data)
    byte = data.index(b"<b/>")
    place = TextPlaces("f", data).place(byte, byte + 4)
    offset = editor.offset_at(byte)
    before = editor.text.encode("utf-16-le")[: 2 * offset].decode("utf-16-le")
    column = len(before.rpartition("\n")[2].encode("utf-16-le")) // 2 + 1
    assert (place.line, place.column) == (before.count("\n") + 1, column)
    assert place.length == 4


def test_the_text_of_a_line_comes_without_its_blanks():
    places = TextPlaces("f", b"a\r\n  b c \r\nd")
    assert [places.line(number) for number in (1, 2, 3, 9)] == ["a", "b c", "d", "d"]


@given(st.binary(max_size=40), st.integers(0, 40), st.integers(0, 40), st.binary(max_size=10))
def test_bytes_around_a_change_are_found_again(old: bytes, one: int, other: int, new: bytes):
    start, end = sorted((min(one, len(old)), min(other, len(old))))
    changed = old[:start] + new + old[end:]
    drift = Drift(old, changed)
    for byte in range(len(old)):
        moved = drift.to_new(byte)
        assert 0 <= moved <= len(changed)
        if drift.to_old(moved) == byte and not start <= byte < end:
            assert changed[moved : moved + 1] == old[byte : byte + 1]


def test_what_is_typed_before_a_tag_moves_the_tag():
    old, new = b"<a><b/></a>", b"<a><new/><b/></a>"
    assert Drift(old, new).to_new(old.index(b"<b/>")) == new.index(b"<b/>")
    assert Drift(old, new).to_old(new.index(b"</a>")) == old.index(b"</a>")
