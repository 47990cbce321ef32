from __future__ import annotations

import pytest

from studio.ros.node.log_lines import COLORIZED, FORMAT, USE_STDOUT, line_of, write_line
from studio.ros.node.logger import Entry, LoggingSeverity

ENTRY = Entry(LoggingSeverity.WARN, 12_000_000_034, "a.b", "text", "f.py", "tick", 7)


@pytest.mark.parametrize(
    ("form", "line"),
    [
        ("", "[WARN] [12.000000034] [a.b]: text"),
        ("{severity}|{name}|{message}|{function_name}|{file_name}|{line_number}",
         "WARN|a.b|text|tick|f.py|7"),
        ("{time_as_nanoseconds} {nope} {", "12000000034 {nope} {"),
        ("{date_time_with_ms}", ".000"),
    ],
)  # fmt: skip
def test_a_line_has_the_form_that_the_variable_gives(
    monkeypatch: pytest.MonkeyPatch, form: str, line: str
):
    monkeypatch.setenv(FORMAT, form)
    assert line_of(ENTRY).endswith(line)


@pytest.mark.parametrize(("asked", "begin"), [("1", "\033[33m["), ("0", "["), ("", "[")])
def test_lines_are_coloured_where_that_is_asked_for(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], asked: str, begin: str
):
    monkeypatch.setenv(COLORIZED, asked)
    write_line(ENTRY)
    assert capsys.readouterr().err.startswith(begin)


def test_lines_go_to_stdout_where_that_is_asked_for(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.setenv(USE_STDOUT, "1")
    write_line(ENTRY)
    assert capsys.readouterr().out.endswith("[a.b]: text\n")
