"""`studio demo`: the sample rover, as a copy to play with."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.cli.mappings import read_mappings
from studio.cli.serving import add_server_options, serve, server_settings

if TYPE_CHECKING:
    import argparse

_PACKAGE = "rover_description"


def add(parser: argparse.ArgumentParser) -> None:
    """Give the parser the options of `demo`."""
    parser.add_argument(
        "--fresh", action="store_true", help="renew the working copy; its changes are lost"
    )
    parser.set_defaults(run=run)
    add_server_options(parser)


def run(options: argparse.Namespace) -> None:
    """Open the working copy of the rover."""
    open_demo(options, read_mappings(options.mappings), fresh=options.fresh)


def open_demo(options: argparse.Namespace, arguments: dict[str, str], *, fresh: bool) -> None:
    """Open the working copy of the rover, made or renewed first."""
    from studio.packages.working_copy import working_copy
    from studio.settings import repository_or_wheel

    settings = server_settings(options)
    models = repository_or_wheel("models")
    package = working_copy(models, settings.data_folder, _PACKAGE, fresh=fresh)
    if fresh:
        from studio.engine.keeping.draft_store import forget_drafts

        forget_drafts(settings.data_folder, package.rglob("*"))
    serve(options, settings, package, arguments)
