"""One entry of `console_scripts`, as setup.py or setup.cfg writes it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from studio.packages.sources.spans import SourceText

GROUP: Final = "console_scripts"


@dataclass(frozen=True, slots=True)
class Script:
    """`name = module:function` as written, with its bytes: of setup.py with its quotes."""

    text: str
    start: int
    end: int
    line: int
    source: SourceText = field(compare=False, repr=False)
    """The file that it stands in."""

    @property
    def name(self) -> str:
        """The name of the executable; empty where there is no `=`."""
        name, equals, _ = self.text.partition("=")
        return name.strip() if equals else ""

    @property
    def place(self) -> str:
        """`module:function`."""
        return self.text.partition("=")[2].strip()

    @property
    def module(self) -> str:
        """The dotted name of the module."""
        return self.place.partition(":")[0].strip()

    @property
    def function(self) -> str:
        """The function in it, which may be dotted; extras in brackets are left out."""
        return self.place.partition(":")[2].partition("[")[0].strip()
