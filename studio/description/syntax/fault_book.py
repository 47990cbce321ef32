"""What is found wrong with a text while it is read: named, placed, bounded."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.problems import Place

if TYPE_CHECKING:
    from studio.problems import Fix

FAULTS_LIMIT: Final = 200
"""Of one text; behind that many nothing more is read."""


@dataclass(frozen=True, slots=True)
class XmlFault:
    """One thing that is wrong with a text; `fix` mends it when that is safe."""

    code: str
    sentence: str
    place: Place
    fix: Fix | None


class EnoughFaultsError(Exception):
    """So much is wrong that the rest is not looked at."""


class FaultBook:
    """The faults of one text; it knows on which line and column a byte stands."""

    def __init__(self, path: str, data: bytes, encoding: str) -> None:
        self._path, self._data, self._encoding = path, data, encoding
        self._found: list[XmlFault] = []
        self._at, self._line, self._column = 0, 1, 1

    def add(self, code: str, sentence: str, at: int, fix: Fix | None) -> None:
        """Note a fault at a byte.

        Raises:
            EnoughFaultsError: There are too many.
        """
        self._found.append(XmlFault(code, sentence, self.place(at), fix))
        if len(self._found) >= FAULTS_LIMIT:
            raise EnoughFaultsError

    @property
    def faults(self) -> tuple[XmlFault, ...]:
        """All of them, in the order in which they were met: what closes first is mended first."""
        return tuple(self._found)

    def pass_by(self, at: int) -> Place:
        """The place of a byte behind all that were passed by before; counting goes on there."""
        self._line, self._column = self._counted(self._at, self._line, self._column, at)
        self._at = at
        return Place(self._path, self._line, self._column)

    def place(self, at: int) -> Place:
        """The place of any byte."""
        if at >= self._at:
            return Place(self._path, *self._counted(self._at, self._line, self._column, at))
        return Place(self._path, *self._counted(0, 1, 1, at))

    def _counted(self, begin: int, line: int, column: int, at: int) -> tuple[int, int]:
        """Line and column of a byte, from those of an earlier one: what is between is counted."""
        breaks = self._data.count(b"\n", begin, at)
        if breaks:
            line, column = line + breaks, 1
            begin = self._data.rfind(b"\n", begin, at) + 1
        text = self._data[begin:at]
        if begin == 0:
            text = text.removeprefix(b"\xef\xbb\xbf")
        return line, column + len(text.decode(self._encoding, "replace"))
