"""Strictness: what works here and would not in ROS 2 is warned of once, or is an error.

Only a process that runs a user's program begins it; elsewhere nothing is said.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from studio.errors import WouldFailError

_ROOM: Final = str(Path(__file__).parent.parent)


@dataclass
class _Strictness:
    is_begun: bool = False
    strict: bool = False
    said: set[tuple[str, str]] = field(default_factory=set[tuple[str, str]])


_state = _Strictness()


def begin(*, strict: bool) -> None:
    """Warn from now on, or raise."""
    _state.is_begun, _state.strict = True, strict


def is_begun() -> bool:
    """Whether this process runs a user's program."""
    return _state.is_begun


def would_fail(reason: str, mend: str) -> None:
    """Say once for each line of the user's code that it would fail in ROS 2.

    Raises:
        WouldFailError: `--strict` asked for it.
    """
    if not _state.is_begun:
        return
    place = _users_place()
    error = WouldFailError(place, reason, mend)
    if _state.strict:
        raise error
    if (place, reason) not in _state.said:
        _state.said.add((place, reason))
        print(f"studio: {error}", file=sys.stderr, flush=True)  # noqa: T201


def _users_place() -> str:
    """Return `file:line` of the innermost frame that is not the studio's."""
    frame = sys._getframe(1)  # pyright: ignore[reportPrivateUsage]
    while frame is not None and frame.f_code.co_filename.startswith((_ROOM, "<")):
        frame = frame.f_back
    return f"{frame.f_code.co_filename}:{frame.f_lineno}" if frame is not None else ""
