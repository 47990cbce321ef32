"""The `studio` command in this process: what it answers and prints."""

from __future__ import annotations

import contextlib
import io
from dataclasses import dataclass

from studio.cli import main


@dataclass(frozen=True)
class Ran:
    """What a line came to."""

    code: int
    out: str
    err: str


def studio(*words: str) -> Ran:
    """Run one line that ends by itself."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            code = main(words)
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else 1
    return Ran(code, out.getvalue(), err.getvalue())
