"""Program: what can be started as a process of its own."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from studio.system import PYTHON_OPTIONS, python_command

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

Kind: TypeAlias = Literal["workspace", "studio", "installed", "command"]
"""A node in Python of the user's; a node of the studio's own; an installed program, run as it is;
a command of the studio that does what a program of ROS does."""

_MODULE_AT: Final = 1 + len(PYTHON_OPTIONS)
RUNNER: Final = "studio.importable"
"""The module that runs a user's Python code, with rclpy and its companions importable."""


@dataclass(frozen=True, slots=True)
class Program:
    """What to start, found and checked.

    Attributes:
        package: Its package; empty for a file.
        executable: Its name there; of a file, the file's name.
        command: The process to start, without arguments of its own and without ROS arguments:
            those follow it.
        file: The file that holds its code; None where that is not known.
        environment: Variables that the process needs beside those of its parent.
    """

    package: str
    executable: str
    kind: Kind
    command: tuple[str, ...]
    file: Path | None = None
    environment: Mapping[str, str] = field(default_factory=dict[str, str])

    @property
    def module(self) -> str:
        """The module that Python runs; empty for what is run as it is."""
        return self.command[_MODULE_AT] if self.command[1:_MODULE_AT] == PYTHON_OPTIONS else ""

    @property
    def arguments(self) -> tuple[str, ...]:
        """What follows the module, or the program that is run as it is."""
        return self.command[_MODULE_AT + 1 :] if self.module else self.command[1:]


def studio_command(words: Sequence[str]) -> tuple[str, ...]:
    """Return the command that is `studio WORDS`."""
    return python_command("studio", *words)
