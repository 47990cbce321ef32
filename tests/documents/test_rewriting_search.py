"""Words found in texts as an editor counts, and others written in their place."""

from __future__ import annotations

import pytest

from studio.description.editing.edits import apply
from studio.documents.rewriting import SearchText, matches_in, replacements_in

TEXT = "<a>\r\n  Größe 🤖 Wheel wheel_1 wheels\r\n</a>".encode()


def found(words: SearchText, *texts: bytes, limit: int = 100) -> list[tuple[int, int, int]]:
    matches = matches_in(((f"/{n}", data) for n, data in enumerate(texts)), words, limit)
    return [(one.place.line, one.place.column, one.place.length) for one in matches.shown]


def test_places_count_as_an_editor_does():
    assert found(SearchText("wheel"), TEXT) == [(2, 12, 5), (2, 18, 5), (2, 26, 5)]


@pytest.mark.parametrize(
    ("words", "columns"),
    [
        (SearchText("wheel", match_case=True), [18, 26]),
        (SearchText("WHEEL", match_case=True), []),
        (SearchText("wheel", whole_word=True), [12]),
        (SearchText("w.*l"), []),
        (SearchText("(("), []),
    ],
)
def test_case_whole_words_and_signs_are_taken_as_they_are(words: SearchText, columns: list[int]):
    assert [column for _, column, _ in found(words, TEXT)] == columns


def test_a_long_line_is_shown_around_the_words():
    data = b"x" * 5000 + b"needle" + b"y" * 5000
    (one,) = matches_in([("/f", data)], SearchText("needle"), 10).shown
    start = one.place.column - one.line_column
    assert one.line[start : start + one.place.length] == "needle"
    assert len(one.line) < 300


def test_all_are_counted_and_the_first_ones_shown():
    matches = matches_in([("/a", b"aaa"), ("/b", b"aa"), ("/c", b"b")], SearchText("a"), 4)
    assert (len(matches.shown), matches.count, matches.files) == (4, 5, 2)


def test_replacing_leaves_every_other_byte():
    edits = replacements_in("/f", TEXT, SearchText("wheel", match_case=True), "tyre\n")
    after = apply(TEXT, edits)
    assert after == TEXT.replace(b"wheel", b"tyre\r\n")


def test_of_more_places_than_asked_for_the_first_are_replaced():
    edits = replacements_in("/f", b"aXaXa", SearchText("x"), "-", 1)
    assert apply(b"aXaXa", edits) == b"a-aXa"


@pytest.mark.parametrize(
    ("words", "text", "columns"),
    [
        (SearchText("i"), "\u0130 I i", [1, 3, 5]),
        (SearchText("ÄÖ"), "äö ÄÖ", [1, 4]),
        (SearchText("aa"), "aaaaa", [1, 3]),
        (SearchText("aa", whole_word=True), "aaa aa_ aa aaä aa", [9, 16]),
        (SearchText("\r\nx"), "a\nx\n", [2]),
    ],
)
def test_letters_of_any_kind_are_found_in_any_case(
    words: SearchText, text: str, columns: list[int]
):
    assert [column for _, column, _ in found(words, text.encode())] == columns


@pytest.mark.parametrize(
    ("words", "data", "count"),
    [
        (SearchText("a" * 999 + "b"), b"a" * 4_000_000, 0),
        (SearchText("a"), b" " * 3_900_000 + b"a" * 100_000, 100_000),
        (SearchText("\n"), b"\n" * 300_000, 300_000),
    ],
)
def test_a_text_made_to_take_long_does_not(words: SearchText, data: bytes, count: int):
    """It is the time limit of a test that says so: each of these took a minute and more."""
    assert matches_in([("/f", data)], words, 1000).count == count


def test_many_places_behind_wide_letters_are_replaced_as_quickly():
    data = "é\r\n".encode() * 100_000
    assert apply(data, replacements_in("/f", data, SearchText("É"), "e")) == b"e\r\n" * 100_000
