"""A setup.cfg as it is written: its sections and options with their bytes."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

from studio.packages.sources.scripts import GROUP, Script
from studio.packages.sources.spans import SourceText

if TYPE_CHECKING:
    from collections.abc import Iterator

FILE_NAME: Final = "setup.cfg"
_ENTRY_POINTS: Final = "options.entry_points"
_SECTION: Final = re.compile(rb"\[([^\]\r\n]+)\][ \t]*")
_OPTION: Final = re.compile(rb"([^\s=:\[#;][^=:\r\n]*?)[ \t]*[=:][ \t]*([^\r\n]*)")


@dataclass(frozen=True, slots=True)
class Option:
    """One option. `key` has `_` for `-`, as setuptools takes both; `start` to `end` is its value.

    A value of several lines is joined by line breaks.
    """

    section: str
    key: str
    value: str
    start: int
    end: int
    line: int


class SetupCfg:
    """The sections and options of a setup.cfg, in their order; what is neither is passed over."""

    def __init__(self, file: str, data: bytes) -> None:
        self.source = SourceText(file, data)
        self.sections: dict[str, int] = {}
        """Where the line behind each section's head begins."""
        self.options: list[Option] = []
        self._read()

    def option(self, section: str, key: str) -> Option | None:
        """Return an option; None if it is not set."""
        named = (one for one in self.options if (one.section, one.key) == (section, key))
        return next(named, None)

    @cached_property
    def scripts(self) -> tuple[Script, ...]:
        """The entries of `console_scripts`."""
        return tuple(self._scripts())

    def _scripts(self) -> Iterator[Script]:
        option = self.option(_ENTRY_POINTS, GROUP)
        at = option.start if option else 0
        for text in option.value.split("\n") if option else ():
            start = self.source.data.find(text.encode("utf-8", "replace"), at)
            if not text or start < 0 or text[0] in "#;":
                continue
            at = start + len(text.encode())
            yield Script(text, start, at, self.source.line_of(start), self.source)

    def _read(self) -> None:
        section, at = "", 0
        for raw in self.source.data.splitlines(keepends=True):
            line, begin = raw.rstrip(b"\r\n"), at
            at += len(raw)
            if found := _SECTION.fullmatch(line):
                section = found[1].decode("utf-8", "replace").strip()
                self.sections.setdefault(section, at)
            elif line[:1] in b" \t" and line.strip() and self.options:
                self._continue(line, begin)
            elif found := _OPTION.fullmatch(line):
                key = found[1].decode("utf-8", "replace").strip().lower().replace("-", "_")
                value = found[2].decode("utf-8", "replace").strip()
                start = begin + found.start(2)
                number = self.source.line_of(begin)
                self.options.append(
                    Option(section, key, value, start, start + len(found[2].rstrip()), number)
                )

    def _continue(self, line: bytes, begin: int) -> None:
        last = self.options.pop()
        text = line.decode("utf-8", "replace").strip()
        value = f"{last.value}\n{text}"
        end = begin + len(line.rstrip())
        self.options.append(Option(last.section, last.key, value, last.start, end, last.line))
