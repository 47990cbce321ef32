"""Words found in texts as an editor counts, and others written in their place."""

from __future__ import annotations

import pytest

from studio.description.editing.splice import apply
from studio.engine.text_search import Words, matches_in, replacements_in

TEXT = "<a>\r\n  Größe 🤖 Wheel wheel_1 wheels\r\n</a>".encode()


def found(words: Words, *texts: bytes, limit: int = 100) -> list[tuple[int, int, int]]:
    matches = matches_in(((f"/{n}", data) for n, data in enumerate(texts)), words, limit)
    return [(one.place.line, one.place.column, one.place.length) for one in matches.shown]


def test_places_count_as_an_editor_does():
    assert found(Words("wheel"), TEXT) == [(2, 12, 5), (2, 18, 5), (2, 26, 5)]


@pytest.mark.parametrize(
    ("words", "columns"),
    [
        (Words("wheel", match_case=True), [18, 26]),
        (Words("WHEEL", match_case=True), []),
        (Words("wheel", whole_word=True), [12]),
        (Words("w.*l"), []),
        (Words("(("), []),
    ],
)
def test_case_whole_words_and_signs_are_taken_as_they_are(words: Words, columns: list[int]):
    assert [column for _, column, _ in found(words, TEXT)] == columns


def test_a_long_line_is_shown_around_the_words():
    data = b"x" * 5000 + b"needle" + b"y" * 5000
    (one,) = matches_in([("/f", data)], Words("needle"), 10).shown
    start = one.place.column - one.line_column
    assert one.line[start : start + one.place.length] == "needle"
    assert len(one.line) < 300


def test_all_are_counted_and_the_first_ones_shown():
    matches = matches_in([("/a", b"aaa"), ("/b", b"aa"), ("/c", b"b")], Words("a"), 4)
    assert (len(matches.shown), matches.count, matches.files) == (4, 5, 2)


def test_replacing_leaves_every_other_byte():
    edits = replacements_in("/f", TEXT, Words("wheel", match_case=True), "tyre\n")
    after = apply(TEXT, edits)
    assert after == TEXT.replace(b"wheel", b"tyre\r\n")
