"""`studio open`: open a robot (.xacro, .urdf, folder, .zip), a bag, or what a .rviz file shows."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from studio.cli.commands.demo import open_demo
from studio.cli.serving import add_server_options, read_mappings, serve, server_settings
from studio.cli.view_files import add_view_options, is_view, read_view, robot_of
from studio.errors import UnreadableFileError

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the options of `open` to the parser."""
    parser.add_argument("path", metavar="PATH", type=Path, nargs="?", help="default: the last one")
    parser.add_argument("name:=value", nargs="*", help="arguments of the xacro file")
    parser.set_defaults(run=run, takes_mappings=True)
    add_view_options(parser)
    add_server_options(parser)


def run(options: argparse.Namespace) -> None:
    """Open the path that was given, or what was opened last.

    Raises:
        UnreadableFileError: Nothing is there.
        RvizConfigError: The `.rviz` file is none.
    """
    arguments = read_mappings(options.mappings)
    if is_view(options.path):
        options.path, options.view = None, options.path
    view = read_view(options.view) if options.view else None
    if options.path is None and view is not None:
        settings = server_settings(options)
        serve(options, settings, robot_of(view, settings.data_folder), arguments)
        return
    if options.path is None:
        _open_last(options, arguments)
        return
    path = options.path.expanduser()
    if not path.exists():
        raise UnreadableFileError(str(path), "there is no such file or folder.")
    serve(options, server_settings(options), path.absolute(), arguments)


def _open_last(options: argparse.Namespace, arguments: dict[str, str]) -> None:
    """Open what was opened last; the sample rover while that was nothing."""
    from studio.packages.recent import last_opened

    settings = server_settings(options)
    last = last_opened(settings.data_folder)
    if last is None:
        open_demo(options, arguments, fresh=False)
        return
    serve(options, settings, Path(last.path), arguments or last.arguments)
