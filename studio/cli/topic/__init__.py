"""`studio topic`: who publishes what, what is said, how often and how large; and to say it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.cli.topic.echo import add_echo
from studio.cli.topic.listing import add_listing_verbs
from studio.cli.topic.publishing import add_pub
from studio.cli.topic.rates import add_rates
from studio.cli.verbs import Verbs

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Give the parser the verbs of `topic`."""
    verbs = Verbs(parser)
    add_listing_verbs(verbs)
    add_echo(verbs)
    add_rates(verbs)
    add_pub(verbs)
