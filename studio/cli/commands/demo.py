"""`studio demo`: open a working copy of the sample rover."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.cli.serving import add_server_options, read_mappings, serve, server_settings

if TYPE_CHECKING:
    import argparse


_PACKAGE = "rover_description"


def add(parser: argparse.ArgumentParser) -> None:
    """Add the options of `demo` to the parser."""
    parser.add_argument(
        "--fresh", action="store_true", help="renew the working copy; its changes are lost"
    )
    parser.add_argument(
        "--no-graph",
        action="store_true",
        help="without the ROS 2 node that drives the rover (see: studio demos)",
    )
    parser.set_defaults(run=run, takes_mappings=True)
    add_server_options(parser)


def run(options: argparse.Namespace) -> None:
    """Open the working copy of the rover, and let it drive."""
    arguments = read_mappings(options.mappings)
    open_demo(options, arguments, fresh=options.fresh, moving=not options.no_graph)


def open_demo(
    options: argparse.Namespace, arguments: dict[str, str], *, fresh: bool, moving: bool = False
) -> None:
    """Open the working copy of the rover, made or renewed first; `moving` has a node drive it."""
    from studio.packages.examples import working_copy
    from studio.settings import repository_or_wheel

    settings = server_settings(options)
    models = repository_or_wheel("models")
    package = working_copy(models, settings.data_folder, _PACKAGE, fresh=fresh)
    if fresh:
        from studio.documents.draft_files import forget_drafts

        forget_drafts(settings.data_folder, package.rglob("*"))
    if not moving:
        serve(options, settings, package, arguments)
        return
    from studio.course.processes import DemoProcesses, rover_call
    from studio.ros.wire.settings import wire_settings

    wire = wire_settings(settings.wire.connect, settings.wire.domain)
    with DemoProcesses.at(wire) as nodes:
        call = rover_call(package, arguments, settings.wire.router)
        # Afterwards: the page comes first, and a studio that cannot start leaves no node behind.
        serve(options, settings, package, arguments, lambda: nodes.start_leashed(*call))
