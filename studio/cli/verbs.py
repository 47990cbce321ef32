"""Verbs of a command, as `echo` of `studio topic`."""

from __future__ import annotations

import argparse
from collections.abc import Callable

Run = Callable[[argparse.Namespace], int | None]


class Verbs:
    """The verbs of one command, each with a parser of its own; one of them must be given."""

    def __init__(self, parser: argparse.ArgumentParser) -> None:
        self._parsers = parser.add_subparsers(title="verbs", metavar="VERB", required=True)

    def add(
        self, name: str, run: Run | None, summary: str, details: str = ""
    ) -> argparse.ArgumentParser:
        """Add a verb; `run` returns its exit code, or None for 0."""
        parser = self._parsers.add_parser(
            name,
            help=summary,
            description=f"{summary[0].upper()}{summary[1:]}.\n{details}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        parser.set_defaults(run=run)
        return parser
