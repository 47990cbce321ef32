"""When the checks of a document start."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable


@dataclass(frozen=True, slots=True)
class Pace:
    """Checks begin when the document is open and has been quiet for a while."""

    opened: Callable[[], Awaitable[None]]
    """Waits for the opening, though not for ever."""
    quiet_s: float
    """Without a run or a mesh."""
