"""`studio launch`: not served yet."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.cli.unserved import add_rest, say_unserved

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Take any line of `launch`."""
    add_rest(parser)
    parser.set_defaults(run=_run)


def _run(_options: argparse.Namespace) -> int:
    return say_unserved("launch")
