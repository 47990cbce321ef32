"""What a look at the disk found, of a file that is held."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from studio.description.values import Edit


class FileChange(Enum):
    """What somebody else did to a file."""

    NONE = auto()
    """It is as it was read, or as it is edited here."""
    RELOADED = auto()
    """It changed and had no unsaved edits: its new text is taken."""
    MERGED = auto()
    """It changed elsewhere than here: its changes are taken, the unsaved edits are kept."""
    CONFLICT = auto()
    """It changed where it has unsaved edits: nothing is taken until somebody chooses."""
    GONE = auto()
    """It cannot be read any more; its text here is kept."""


@dataclass(frozen=True, slots=True)
class DiskNews:
    """The change, the edits that took it over (in order), and how many places stay edited."""

    what: FileChange
    edits: tuple[Edit, ...] = ()
    kept: int = 0
