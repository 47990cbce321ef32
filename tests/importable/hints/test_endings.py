"""What is told at the end: of a file that is no Python, of a `main` that nothing calls."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.importable.hints.endings import ending_hint, uncalled_hint
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
    assert "four a level" in (ending_hint(TabError("t", place)) or "")
    assert "node.py:3 is no Python" in (ending_hint(SyntaxError("invalid syntax", place)) or "")
    assert ending_hint(SyntaxError("invalid", ("<string>", 1, 1, "x"))) is None


MAIN = "import rclpy\n\n\ndef main():\n    pass\n"


@pytest.mark.parametrize(
    ("rest", "said"),
    [
        (
            "",
            "node.py:4: main is defined and never called: add "
            'if __name__ == "__main__": main() at the end.',
        ),
        (
            '\nif __name__ == "main":\n    main()\n',
            'node.py:7: main is not called, for __name__ is "__main__" there: write '
            'if __name__ == "__main__": main().',
        ),
        ('\nif __name__ == "__main__":\n    main()\n', None),
        ("\nmain()\n", None),
        ("\nrun = main\n", None),
    ],
)
def test_a_main_that_is_not_called_is_said_with_its_line(
    tmp_path: Path, rest: str, said: str | None
):
    file = tmp_path / "node.py"
    file.write_text(MAIN + rest)
    assert uncalled_hint(str(file)) == said


@pytest.mark.parametrize("text", ["x = 1\n", "def main(:\n"])
def test_nothing_is_said_of_other_files(tmp_path: Path, text: str):
    file = tmp_path / "node.py"
    file.write_text(text)
    assert uncalled_hint(str(file)) is None


def test_nothing_is_said_of_a_file_that_is_gone(tmp_path: Path):
    assert uncalled_hint(str(tmp_path / "gone.py")) is None
