"""Differences are all counted, and shown up to a limit."""

from __future__ import annotations

from studio.description.editing.line_diff import DiffLine, LineDiff, line_diff

OLD, NEW = DiffLine("old", 1, None, "a"), DiffLine("new", None, 1, "b")
SAME = DiffLine("same", 2, 2, "c")


def test_all_that_differs_is_counted_and_shown():
    found = line_diff([(OLD, NEW, SAME), (NEW,)], 10)
    assert found == LineDiff(2, 1, ((OLD, NEW, SAME), (NEW,)), 0)


def test_what_is_beyond_the_limit_is_counted_only():
    found = line_diff([(OLD, NEW, SAME), (NEW,), (OLD,)], 4)
    assert found == LineDiff(2, 2, ((OLD, NEW, SAME), (NEW,)), 1)
    assert line_diff([(OLD, NEW, SAME)], 2).hunks == ((OLD, NEW),)


def test_without_differences_there_is_nothing_to_show():
    assert line_diff([], 5) == LineDiff()
