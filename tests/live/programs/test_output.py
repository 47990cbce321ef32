"""The last lines of each process of a run."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from studio.live.programs.output import LINE_MAX, LINES_MAX, PROCESSES_MAX, SENT_MAX, RunLines


def texts(lines: RunLines, after: int = 0) -> list[str]:
    return [one.text for one in lines.after(after)]


def test_texts_are_cut_into_lines_wherever_they_come_apart():
    lines = RunLines()
    lines.take(1, "stdout", "on")
    lines.take(2, "stdout", "two\n")
    lines.take(1, "stderr", "bad\r\n")
    lines.take(1, "stdout", "e\nthree\n")
    assert texts(lines) == ["two", "bad", "one", "three"]
    assert [one.number for one in lines.after(2)] == [3, 4]


def test_what_stands_without_an_end_of_line_comes_at_the_end():
    lines = RunLines()
    lines.take(1, "stdout", "rest")
    lines.take(2, "stdout", "other")
    lines.end(1)
    assert texts(lines) == ["rest"]
    lines.end()
    assert texts(lines) == ["rest", "other"]
    assert lines.last_text(2) == "other"


def test_one_that_chatters_takes_no_line_of_another_away():
    lines = RunLines()
    lines.say("info", "begun")
    lines.take(1, "stdout", "quiet\n")
    lines.take(2, "stdout", "x\n" * (LINES_MAX + 500))
    assert lines.dropped == 500
    assert texts(lines)[:2] == ["begun", "quiet"]


def test_a_line_without_an_end_is_cut():
    lines = RunLines()
    lines.take(1, "stdout", "x" * (3 * LINE_MAX + 1))
    assert [len(one) for one in texts(lines)] == [LINE_MAX] * 3
    lines.end()
    assert texts(lines)[-1] == "x"


def test_many_processes_share_what_is_left_of_the_room():
    lines = RunLines()
    for process in range(PROCESSES_MAX + 50):
        lines.take(process, "stdout", "x\n" * 40)
    assert len(lines.after(lines.last - 10)) == 10
    assert lines.dropped == 50 * 40 - LINES_MAX


@given(st.lists(st.tuples(st.integers(0, 3), st.text("ab\n", max_size=20)), max_size=50))
def test_asked_again_and_again_all_lines_come_once_in_order(said: list[tuple[int, str]]):
    lines = RunLines()
    heard: list[int] = []
    for process, text in said:
        lines.take(process, "stdout", text)
        heard += [one.number for one in lines.after(heard[-1] if heard else 0)]
    assert heard == list(range(1, lines.last + 1))


def test_no_more_is_sent_at_once_than_is_meant():
    lines = RunLines()
    for process in (1, 2, 3):
        lines.take(process, "stdout", "x\n" * LINES_MAX)
    first = lines.after(0)
    assert len(first) == SENT_MAX
    assert lines.after(first[-1].number)[0].number == first[-1].number + 1
