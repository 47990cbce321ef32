"""A file that is no Python is told as Python tells it, and with what to do."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.importable.hints.syntax import syntax_hint
from tests.support.command_line import started
from tests.support.seeded_packages import sound
from tests.support.wire import running_router

if TYPE_CHECKING:
    from pathlib import Path

FLAT = "import rclpy\n\n\ndef main():\nrclpy.init()\n"


@pytest.mark.parametrize("words", [("talker",), ("flat.py",)])
def test_a_file_without_indentation_is_told_without_frames_of_the_studio(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...]
):
    if words == ("flat.py",):
        file = tmp_path / "flat.py"
        file.write_text(FLAT)
        line = ("run", str(file))
    else:
        package = sound(tmp_path) / "my_pkg"
        (package / "helper.py").write_text(FLAT)
        (package / "talker.py").write_text("from my_pkg import helper\n\nmain = helper\n")
        monkeypatch.chdir(tmp_path)
        line = ("run", "my_pkg", "talker")
    with running_router() as endpoint, started(endpoint, *line) as process:
        assert process.wait() == 1
    printed = process.printed
    assert "running.py" not in printed
    assert "importlib" not in printed
    assert "runpy" not in printed
    assert '.py", line 5\n    rclpy.init()\n    ^' in printed
    assert "IndentationError: expected an indented block" in printed
    assert printed.count("studio: hint: ") == 1
    assert ".py:5: the indentation of the lines is not as Python needs it" in printed


def test_each_kind_of_fault_has_its_sentence():
    place = ("a/node.py", 3, 1, "x")
    assert "four a level" in (syntax_hint(TabError("t", place)) or "")
    assert "node.py:3 is no Python" in (syntax_hint(SyntaxError("invalid syntax", place)) or "")
    assert syntax_hint(SyntaxError("invalid", ("<string>", 1, 1, "x"))) is None
