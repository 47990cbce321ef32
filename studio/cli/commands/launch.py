"""`studio launch`: start the nodes of a launch file (not served yet)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.cli.verbs import refuse

if TYPE_CHECKING:
    import argparse

_INSTEAD = "start the nodes that it names with studio run, each in a terminal of its own"


def add(parser: argparse.ArgumentParser) -> None:
    """Take any line of `launch`."""
    refuse(parser, "launch", _INSTEAD)
