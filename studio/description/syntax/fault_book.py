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
        self._line, self._line_start = 1, 0

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
        place = self.place(at)
        self._line, self._line_start = place.line, self._data.rfind(b"\n", 0, at) + 1
        return place

    def place(self, at: int) -> Place:
        """The place of any byte."""
        line, start = self._line, self._line_start
        if at < start:
            line, start = 1, 0
        breaks = self._data.count(b"\n", start, at)
        if breaks:
            start = self._data.rfind(b"\n", start, at) + 1
        text = self._data[start:at].removeprefix(b"\xef\xbb\xbf")
        column = len(text.decode(self._encoding, "replace")) + 1
        return Place(self._path, line + breaks, column)
