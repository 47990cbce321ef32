"""The `studio` command in this process: what it answers and prints."""

from __future__ import annotations

import contextlib
import io
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.cli import main
from tests.support.demos import running
from tests.support.wire import ConditionNotMetError, wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

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


def comes_to(said: Callable[[Ran], bool], *words: str) -> None:
    """Run a line until what it prints is so: nodes that came or went are told a moment later."""
    ran = Ran(0, "", "")

    def is_so() -> bool:
        nonlocal ran
        ran = studio(*words)
        return said(ran)

    try:
        wait_until(f"`studio {' '.join(words)}` to say so", is_so)
    except ConditionNotMetError as error:
        raise ConditionNotMetError(f"{error}; it says {ran}") from None


@contextlib.contextmanager
def started(endpoint: str, *words: str) -> Generator[RunningDemo]:
    """Run one line in a process of its own, at a router, until the block ends."""
    with running([sys.executable, "-m", "studio", *words], endpoint) as process:
        yield process
