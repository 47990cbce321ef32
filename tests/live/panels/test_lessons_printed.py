from __future__ import annotations

from studio.live.panels.lessons import LINE_MAX, LINES_MAX, PrintedLines


def test_lines_come_whole_however_the_bytes_are_cut():
    printed = PrintedLines()
    for piece in (b"one\ntw", b"o\r\n", "grüße".encode()[:3], "grüße".encode()[3:] + b"\n"):
        printed.take(piece)
    assert printed.after(0) == (("one", "two", "grüße"), 3)
    assert printed.after(2) == (("grüße",), 3)
    assert printed.after(3) == ((), 3)


def test_the_last_words_count_without_an_end_of_line():
    printed = PrintedLines()
    printed.take(b"why\n\n  \nbecause")
    assert printed.last_text == "why"
    printed.end()
    printed.end()
    assert printed.last_text == "because"
    assert printed.after(3) == (("because",), 4)


def test_of_many_lines_the_last_are_kept_with_their_numbers():
    printed = PrintedLines()
    printed.take(b"".join(b"%d\n" % at for at in range(1, 1001)))
    lines, last = printed.after(0)
    assert (len(lines), lines[0], lines[-1], last) == (LINES_MAX, "801", "1000", 1000)


def test_a_line_without_an_end_and_bytes_that_are_no_text_take_no_more_room():
    printed = PrintedLines()
    for _ in range(LINES_MAX):
        printed.take(b"\xff" * (3 * LINE_MAX))
    lines, last = printed.after(0)
    assert (len(lines), last) == (LINES_MAX, 3 * LINES_MAX)
    assert {len(line) for line in lines} == {LINE_MAX}
