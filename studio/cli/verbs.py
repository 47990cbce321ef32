"""Verbs of a command, as `echo` of `studio topic`, and lines that are not served yet."""

from __future__ import annotations

import argparse
import sys
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

    def add_unserved(self, name: str, summary: str, line: str, instead: str) -> None:
        """Add a verb that is not served yet; see `refuse`."""
        refuse(self.add(name, None, f"{summary} (not served yet)"), line, instead)


def refuse(parser: argparse.ArgumentParser, line: str, instead: str) -> None:
    """Add a line of `ros2` that is not served yet: it prints so, whatever its arguments.

    Args:
        parser: Of the command or verb.
        line: Its name after `studio`.
        instead: What the user can do, as an end of a sentence.
    """

    def run(_options: argparse.Namespace) -> int:
        print(f"studio: studio {line} is not there yet: {instead}.", file=sys.stderr)
        return 2

    parser.add_argument("rest", nargs="*", help=argparse.SUPPRESS)
    parser.set_defaults(run=run, takes_rest=True)
