"""The `studio` command in this process: what it answers and prints."""

from __future__ import annotations

import contextlib
import io
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.cli import main
from tests.support.demos import running

if TYPE_CHECKING:
    from collections.abc import Generator

    from tests.support.demos import RunningDemo


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


@contextlib.contextmanager
def started(endpoint: str, *words: str) -> Generator[RunningDemo]:
    """Run one line in a process of its own, at a router, until the block ends."""
    with running([sys.executable, "-m", "studio", *words], endpoint) as process:
        yield process
