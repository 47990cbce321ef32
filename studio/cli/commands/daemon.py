"""`studio daemon`: says that none is needed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.cli.verbs import Verbs
from studio.cli.wire import take_wire_options

if TYPE_CHECKING:
    import argparse

    from studio.cli.verbs import Run


_SENTENCES = {
    "start": "No daemon is needed: each command reads the graph live from the router.",
    "stop": "There is no daemon to stop: nothing is cached, a node that ends is gone at once.",
    "status": "The daemon is not running, and none is needed.",
}


def add(parser: argparse.ArgumentParser) -> None:
    """Add the verbs of `daemon` to the parser."""
    verbs = Verbs(parser)
    for name, sentence in _SENTENCES.items():
        summary = sentence[0].lower() + sentence[1:].rstrip(".")
        take_wire_options(verbs.add(name, _printing(sentence), summary))


def _printing(sentence: str) -> Run:
    def run(_options: argparse.Namespace) -> None:
        print(sentence)

    return run
