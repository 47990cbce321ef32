"""A `main` that nothing calls."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.importable.hints.uncalled import uncalled_hint

if TYPE_CHECKING:
    from pathlib import Path

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
