"""`studio bag`: record topics, play them again, and look into what was recorded."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, cast

from studio.cli.verbs import Verbs

if TYPE_CHECKING:
    import argparse


class VerbsModule(Protocol):
    """A file beside this one."""

    def add(self, verbs: Verbs) -> None:
        """Add the verbs of the file to those of `bag`."""
        ...


def add(parser: argparse.ArgumentParser) -> None:
    """Add the verbs of `bag` to the parser: those of each file beside this one."""
    verbs = Verbs(parser)
    for file in sorted(Path(__file__).parent.glob("[!_]*.py")):
        cast("VerbsModule", importlib.import_module(f"{__name__}.{file.stem}")).add(verbs)
