"""`studio bag`: not served yet."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.cli.unserved import refuse
from studio.cli.verbs import Verbs

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Take any line of `bag`."""
    verbs = Verbs(parser)
    refuse(verbs, "record", "record topics", "bag record")
    refuse(verbs, "play", "play what was recorded", "bag play")
    refuse(verbs, "info", "say what was recorded", "bag info")
