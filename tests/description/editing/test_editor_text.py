from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.description.editing.editor_text import EditorText
from studio.description.editing.edits import apply
from studio.errors import EditError
from tests.support.corpus import corpus
from tests.support.corpus_files import xml_trees

LATIN = b'<?xml version="1.0" encoding="iso-8859-1"?>\n<robot name="Gr\xfc\xdfe"/>'
PIECES = st.sampled_from(
    ["a", "<robot>", " ", "\n", "\r\n", "\r", "ü", "語", "🤖", "\ufeff", "${x * 2}"]
)
FILES = st.tuples(
    st.sampled_from([b"", b"\xef\xbb\xbf"]),
    st.lists(PIECES | st.binary(max_size=2), max_size=30),
).map(lambda drawn: drawn[0] + b"".join(map(_bytes, drawn[1])))


def _bytes(piece: str | bytes) -> bytes:
    return piece if isinstance(piece, bytes) else piece.encode()


def units(text: str) -> int:
    return len(text.encode("utf-16-le")) // 2


def starts(text: EditorText) -> list[int]:
    """Every offset at which a character of the text begins, and its end."""
    return [units(text.text[:index]) for index in range(len(text.text) + 1)]


@pytest.mark.parametrize(
    ("data", "shown"),
    [
        (b"", ""),
        (b"one\r\ntwo\rthree\n", "one\ntwo\nthree\n"),
        (b"\xef\xbb\xbf<robot/>", "<robot/>"),
        ("Größe 🤖".encode(), "Größe 🤖"),
        (LATIN, LATIN.decode("latin-1")),
        (b"broken \xff byte", "broken \ufffd byte"),
    ],
)
def test_the_editor_shows_plain_line_breaks_no_mark_and_every_letter(data: bytes, shown: str):
    assert EditorText(data).text == shown
    assert EditorText(data).length == units(shown)


def test_an_edit_behind_wide_letters_and_long_line_breaks_meets_its_bytes():
    data = "\ufeff<!-- Größe 🤖 語 -->\r\n<a x='1'/>\r\n".encode()
    text = EditorText(data)
    at = units(text.text[: text.text.index("1")])
    edit = text.edit("f", at, at + 1, "2\n3")
    assert apply(data, [edit]) == data.replace(b"1", b"2\r\n3")


def test_a_file_that_declares_another_encoding_is_written_in_it():
    text = EditorText(LATIN)
    at = text.text.index("ß")
    assert apply(LATIN, [text.edit("f", at, at + 1, "ö")]) == LATIN.replace(b"\xdf", b"\xf6")


@pytest.mark.parametrize(
    "data", [LATIN, b'<?xml version="1.0" encoding="iso-8859-1"?>\n<robot name="plain"/>']
)
def test_a_letter_that_the_encoding_lacks_is_refused_with_a_way_out(data: bytes):
    with pytest.raises(EditError, match=r"'€' cannot be written .* write &#8364; or declare UTF-8"):
        EditorText(data).edit("f", len(data) - 3, len(data) - 3, "€")


@pytest.mark.parametrize("encoding", ["utf-7", "iso2022_jp", "hz", "rot13", "hex", "no-such"])
def test_an_encoding_that_is_no_table_of_bytes_counts_as_utf_8(encoding: str):
    data = f'<?xml version="1.0" encoding="{encoding}"?>\n<robot/>'.encode() + b"\xff"
    text = EditorText(data)
    at = text.text.index("<robot")
    assert apply(data, [text.edit("f", at, at, " ")]) == data.replace(b"<robot", b" <robot")


@pytest.mark.parametrize(("start", "end"), [(-1, 0), (0, 3), (3, 4), (2, 1), (1, 1), (0, 1)])
def test_a_place_that_is_not_in_the_text_is_refused(start: int, end: int):
    with pytest.raises(EditError, match="The text has no place"):
        EditorText("🤖".encode()).edit("f", start, end, "")


@given(FILES)
def test_every_character_begins_at_the_byte_that_leads_back_to_it(data: bytes):
    text = EditorText(data)
    places = [text.byte_at(offset) for offset in starts(text)]
    assert places == sorted(places)
    assert places[-1] == len(data)
    if "\ufffd" not in text.text:
        assert [text.offset_at(byte) for byte in places] == starts(text)


@given(FILES, st.data())
def test_an_edit_puts_its_text_there_and_leaves_all_other_bytes(data: bytes, draw: st.DataObject):
    text = EditorText(data)
    places = starts(text)
    first = draw.draw(st.integers(0, len(places) - 1))
    last = draw.draw(st.integers(first, len(places) - 1))
    new = draw.draw(st.sampled_from(["", "x", "ä🤖", "p\nq"]))
    edit = text.edit("f", places[first], places[last], new)
    edited = EditorText(apply(data, [edit]))
    assert data.startswith(edited.data[: edit.start])
    assert data.endswith(edited.data[edit.start + len(edit.new) :])
    if not re.search(rb"\r", data) and "\ufffd" not in text.text and "\ufeff" not in text.text:
        assert edited.text == text.text[:first] + new + text.text[last:]


def test_a_letter_typed_into_any_real_file_touches_no_other_byte():
    for tree in xml_trees(corpus()):
        text = EditorText(tree.data)
        lines = text.text.split("\n")
        at = text.length - units("\n".join(lines[len(lines) // 2 :]))
        edited = apply(tree.data, [text.edit(tree.path, at, at, "x")])
        byte = text.byte_at(at)
        assert edited == tree.data[:byte] + b"x" + tree.data[byte:]
        assert EditorText(edited).text == "\n".join(
            [*lines[: len(lines) // 2], "x" + lines[len(lines) // 2], *lines[len(lines) // 2 + 1 :]]
        )
        assert text.offset_at(byte) == at
