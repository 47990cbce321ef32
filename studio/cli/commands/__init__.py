"""The commands of `studio`, found by name: each file here is one, and each folder.

The first line of a command's file is its line in `studio --help`, a docstring of the form
`studio NAME`: SUMMARY. It is read and not imported, so that the help stays quick.
"""

from __future__ import annotations

import importlib
import re
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, cast

if TYPE_CHECKING:
    import argparse

_FOLDER = Path(__file__).parent
_SUMMARY = re.compile(r'"""`studio [\w-]+`: (.+)\."""')
_FIRST = (
    *("demo", "open", "check", "xacro", "topic", "service", "action", "node", "param"),
    *("lifecycle", "interface", "pkg", "demos", "run", "doctor", "router", "daemon"),
)


class CommandModule(Protocol):
    """A command's file."""

    def add(self, parser: argparse.ArgumentParser) -> None:
        """Give the parser its options and verbs, and these defaults, of which only `run` is needed.

        run: Takes the options, and returns the exit code or None for 0.
        takes_mappings: Words with `:=` are arguments of a xacro file, wherever they stand.
        takes_late: The name of a last value, and what it is when it is left out.
        interrupted_code: The exit code after Ctrl-C, instead of 130.
        """
        ...


def summaries() -> dict[str, str]:
    """Return the summary of each command by its name, in the order of `studio --help`."""
    files = {file.stem: file for file in _FOLDER.glob("[!_]*.py")}
    files |= {file.parent.name: file for file in _FOLDER.glob("[!_]*/__init__.py")}
    return {name: _summary(files[name]) for name in sorted(files, key=_place)}


def add_command(name: str, parser: argparse.ArgumentParser) -> None:
    """Import a command, and let it fill in its parser."""
    cast("CommandModule", importlib.import_module(f"{__name__}.{name}")).add(parser)


def _place(name: str) -> tuple[int, str]:
    """Return a command's place in the help: those for beginners first, then by name."""
    return (_FIRST.index(name) if name in _FIRST else len(_FIRST), name)


def _summary(file: Path) -> str:
    with file.open(encoding="utf-8") as text:
        found = _SUMMARY.match(text.readline())
    return found[1] if found else ""
