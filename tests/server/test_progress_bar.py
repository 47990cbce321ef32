from __future__ import annotations

import io

from studio.server.progress_bar import ProgressBar


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_nothing_is_drawn_before_a_second_has_passed():
    now_s, terminal = [0.0], Terminal()
    bar = ProgressBar(terminal, lambda: now_s[0])
    bar.show("files", 1, 4)
    bar.end()
    assert terminal.getvalue() == ""


def test_then_the_counts_are_said_on_one_line_that_goes_away():
    now_s, terminal = [0.0], Terminal()
    bar = ProgressBar(terminal, lambda: now_s[0])
    now_s[0] = 1.5
    bar.show("files", 1, 4)
    bar.show("folders", 7, 0)
    bar.end()
    bar.end()
    first, second, last = terminal.getvalue().split("\r\x1b[K")[1:]
    assert first == f"[{'#' * 6}{'.' * 18}] 1/4 files"
    assert second == "7 folders"
    assert last == ""


def test_nothing_is_drawn_where_nobody_sees_it():
    now_s, pipe = [0.0], io.StringIO()
    bar = ProgressBar(pipe, lambda: now_s[0])
    now_s[0] = 5.0
    bar.show("files", 1, 4)
    bar.end()
    assert pipe.getvalue() == ""
