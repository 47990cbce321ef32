"""Says each hint once, on stderr, in one sentence."""

from __future__ import annotations

import ast
import os
import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.importable.hints import HINTS_VARIABLE

if TYPE_CHECKING:
    from types import FrameType

ROOM: Final = str(Path(__file__).parents[2])
"""The folder of the studio: frames of its files are none of the user's."""
_SKIPPED: Final = (ROOM, "<")
_SIZE_MAX: Final = 1_000_000
_SAID_MAX: Final = 20
"""A program that does so much wrong has its author's attention already."""


class Said:
    """What was said so far."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._said: set[str] = set()

    def say(self, about: str, sentence: str) -> None:
        """Print a hint, unless one about the same thing was printed; thread-safe."""
        with self._lock:
            if about in self._said or len(self._said) >= _SAID_MAX:
                return
            self._said.add(about)
        print(f"studio: hint: {sentence}", file=sys.stderr, flush=True)  # noqa: T201


def are_wanted() -> bool:
    """Whether hints are said."""
    return os.environ.get(HINTS_VARIABLE, "") != "0"


def is_users(frame: FrameType) -> bool:
    """Whether a frame is neither the studio's nor Python's own."""
    name = frame.f_code.co_filename
    return (
        not name.startswith(_SKIPPED)
        and "site-packages" not in name
        and (not name.startswith(_PYTHON))
    )


_PYTHON: Final = os.path.dirname(os.__file__) + os.sep  # noqa: PTH120


def place(frame: FrameType) -> str:
    """Return `file.py:12`, the file as short as it is known by."""
    return place_of(frame.f_code.co_filename, frame.f_lineno)


def place_of(file: str, line: int) -> str:
    """Return `file.py:12` of a file."""
    return f"{os.path.basename(file)}:{line}"  # noqa: PTH119 - a word


def tree_of(file: str) -> ast.Module | None:
    """Return a file of Python, parsed; None: it cannot be read, or is none."""
    try:
        with Path(file).open("rb") as text:
            return ast.parse(text.read(_SIZE_MAX))
    except (OSError, SyntaxError, ValueError, RecursionError):
        return None
