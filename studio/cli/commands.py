"""The commands by name: where each is written, so that only the one that was asked for is read."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, cast

if TYPE_CHECKING:
    import argparse


class CommandModule(Protocol):
    """What a file of a command holds: `add` gives its parser options, verbs and `run`."""

    def add(self, parser: argparse.ArgumentParser) -> None:
        """Give the parser what the command takes; `run(options)` answers its exit code."""
        ...


@dataclass(frozen=True, slots=True)
class Command:
    """One word behind `studio`.

    Attributes:
        file: The module of this room that `add`s it.
        summary: Its line in `studio --help`.
        takes_mappings: Whether words with `:=` are arguments of a xacro file, wherever they stand.
    """

    name: str
    file: str
    summary: str
    takes_mappings: bool = False

    def add_to(self, parser: argparse.ArgumentParser) -> None:
        """Read the command's file and let it fill in its parser."""
        module = importlib.import_module(f"studio.cli.{self.file}")
        cast("CommandModule", module).add(parser)


COMMANDS = (
    Command("demo", "demo", "open a working copy of the sample rover", takes_mappings=True),
    Command(
        "open", "opens", "open a .xacro or .urdf file, a folder or a .zip", takes_mappings=True
    ),
    Command(
        "check",
        "check",
        "say what is wrong with robots; exit code 1: errors",
        takes_mappings=True,
    ),
    Command("xacro", "xacro", "print the URDF, byte for byte as xacro does", takes_mappings=True),
    Command("topic", "topic", "list topics, see what is said on them, and say something"),
    Command("service", "service", "list services and call them"),
    Command("action", "action", "list actions and send them goals"),
    Command("node", "node", "list nodes and what they offer"),
    Command("param", "param", "list, read and set the parameters of nodes"),
    Command("lifecycle", "lifecycle", "see and change the states of managed nodes"),
    Command("interface", "interface", "list and show message, service and action types"),
    Command("pkg", "pkg", "list the packages of opened folders and what they start"),
    Command("demos", "demos", "list and start the course's systems, as real nodes"),
    Command("run", "run", "start a node by its package and name"),
    Command("doctor", "doctor", "look for what keeps nodes apart"),
    Command("router", "router", "run a Zenoh router, where nodes find each other"),
    Command("daemon", "daemon", "says that none is needed"),
    Command("launch", "launch", "start the nodes of a launch file (not served yet)"),
    Command("bag", "bag", "record and play topics (not served yet)"),
)
