"""Which line of a launch file made a thing."""

from __future__ import annotations

import inspect
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING

from studio.launch.plan import Where

if TYPE_CHECKING:
    from collections.abc import Generator
    from types import TracebackType

_OURS = "studio.launch."
_MACHINERY = ("importlib", "runpy", "contextlib")
_PLACE: ContextVar[Where | None] = ContextVar("place of an element", default=None)


def here() -> Where:
    """Return the line that called into the vocabulary, or the element that is being read."""
    placed = _PLACE.get()
    if placed is not None:
        return placed
    frame = inspect.currentframe()
    while frame is not None:
        name = str(frame.f_globals.get("__name__", ""))
        if not name.startswith((_OURS, *_MACHINERY)) and not frame.f_code.co_filename.startswith(
            "<frozen"
        ):
            return Where(frame.f_code.co_filename, frame.f_lineno)
        frame = frame.f_back
    return Where()


@contextmanager
def placed(where: Where) -> Generator[None]:
    """Have all that is made within the block stand at a place: an element of XML or YAML."""
    token = _PLACE.set(where)
    try:
        yield
    finally:
        _PLACE.reset(token)


@contextmanager
def unplaced() -> Generator[None]:
    """Have what is made within stand where its code is, though an element is being read."""
    token = _PLACE.set(None)
    try:
        yield
    finally:
        _PLACE.reset(token)


def where_raised(traceback: TracebackType | None, file: str = "") -> Where:
    """Return the innermost line of user's code of a traceback; of that file where it has one."""
    found = Where(file)
    while traceback is not None:
        code = traceback.tb_frame.f_code
        name = str(traceback.tb_frame.f_globals.get("__name__", ""))
        if not name.startswith("studio.") and not code.co_filename.startswith("<"):
            at = Where(code.co_filename, traceback.tb_lineno)
            if not file or code.co_filename == file or found.line == 0:
                found = at
        traceback = traceback.tb_next
    return found
