"""`studio launch`: start what a launch file names, or print what it would start."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from studio.cli.interface_types import add_interfaces_option, environment_with
from studio.cli.packages import add_package_options, opened_packages
from studio.cli.terminal import harmless
from studio.cli.wire import STARTING, add_wire_options, ended_by_signals, profile_of
from studio.errors import SettingsError

if TYPE_CHECKING:
    from studio.launch.plan import Plan
    from studio.launch.reporting import Reporter
    from studio.packages.index import PackageIndex

_DETAILS = """\
A launch file is a program: what it says is done. Nodes of your packages run as they are, those of
ROS that the studio has are its own, rviz2 is the page, and what is installed here runs as it is;
the rest is listed as not started, with the reason. Ctrl-C ends all.

examples:
  studio launch my_package demo.launch.py
  studio launch demo.launch.py gui:=false
  studio launch my_package demo.launch.py --show-args
  studio launch my_package demo.launch.py --print     what it would start, and nothing runs
"""


def add(parser: argparse.ArgumentParser) -> None:
    """Add the options of `launch` to the parser."""
    parser.epilog = _DETAILS
    parser.usage = (
        "studio launch [options] PACKAGE FILE [NAME:=VALUE ...]\n"
        "       studio launch [options] FILE.launch.py|.xml|.yaml [NAME:=VALUE ...]"
    )
    parser.add_argument(
        "words",
        nargs="+",
        metavar="PACKAGE FILE",
        help="the launch file by its package and name, or by its path; then NAME:=VALUE for each "
        "of its arguments",
    )
    parser.add_argument("-s", "--show-args", action="store_true", help="print its arguments")
    parser.add_argument(
        "-p",
        "--print",
        "--print-description",
        dest="print_plan",
        action="store_true",
        help="print what it would start, and start nothing",
    )
    parser.add_argument("--json", action="store_true", help="print the same as JSON")
    parser.add_argument(
        "-a",
        "--show-all-subprocesses-output",
        dest="all_output",
        action="store_true",
        help="print what every node prints, also where its output is log",
    )
    for word in ("-d", "--debug"), ("-n", "--noninteractive"):
        parser.add_argument(*word, action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--events", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--node", action="store_true", help=argparse.SUPPRESS)
    add_package_options(parser)
    add_interfaces_option(parser, "types of one's own that the nodes know; may be given again")
    add_wire_options(parser, router=STARTING, own_types=False)
    parser.set_defaults(run=run, takes_mappings=True, interrupted_code=130)


def run(options: argparse.Namespace) -> int:
    """Plan or run a launch file."""
    from studio.launch.finding import find_launch_file

    words = [word for word in options.words if word != "--"]
    index = opened_packages(options, to_run=True)
    given = _given(options.mappings)
    if options.node:
        return _run(options, index, Path(words[0]), words, given)
    if len(words) > 2:
        raise SettingsError(
            f"studio launch {harmless(' '.join(words))}: {harmless(words[2])} is one word too "
            "many: arguments are written NAME:=VALUE, without blanks."
        )
    file = find_launch_file(index, words)
    index = _with_neighbours(options, index, file)
    if not (options.show_args or options.print_plan or options.json):
        return _run(options, index, file, [], given)
    return _print(options, index, file, given)


def _with_neighbours(options: argparse.Namespace, index: PackageIndex, file: Path) -> PackageIndex:
    """See the packages around a file that was given by its path, too."""
    from studio.packages.roots import package_folder_of, served_roots_for

    folder = package_folder_of(file.parent)
    if folder is None or any(one.folder == folder for one in index.packages):
        return index
    options.package_path = [
        *options.package_path,
        *map(str, served_roots_for(folder / "package.xml")),
    ]
    return opened_packages(options, to_run=True)


def _given(mappings: list[str]) -> dict[str, str]:
    found: dict[str, str] = {}
    for one in mappings:
        name, _, value = one.partition(":=")
        if not name:
            raise SettingsError(f"{harmless(one)} has no name: write NAME:=VALUE, without blanks.")
        found[name] = value
    return found


def _print(
    options: argparse.Namespace, index: PackageIndex, file: Path, given: dict[str, str]
) -> int:
    from studio.launch.plan import plan_to_json
    from studio.launch.planning import plan_launch_file
    from studio.launch.printing import shown_arguments, shown_plan

    plan = plan_launch_file(file, given, index)
    _warn_of_unknown(plan)
    if options.json:
        print(plan_to_json(plan).decode())
    elif options.show_args:
        print(harmless(shown_arguments(plan)))
        for one in plan.failures if not plan.arguments else plan.failures[:0]:
            print(f"studio: {harmless(f'{one.where}: {one.sentence}')}", file=sys.stderr)
    else:
        print(harmless(shown_plan(plan)))
    failed = plan.failures and not (options.show_args and plan.arguments)
    return 1 if plan.ended or failed else 0


def _warn_of_unknown(plan: Plan) -> None:
    known = ", ".join(sorted({one.name for one in plan.arguments})) or "none"
    for name in plan.unknown:
        text = f"{name} is no argument of {plan.file}: it has {known}"
        print(f"WARNING: {harmless(text)}", file=sys.stderr)


def _run(
    options: argparse.Namespace,
    index: PackageIndex,
    file: Path,
    node: list[str],
    given: dict[str, str],
) -> int:
    """Start a launch file, or one node as if a launch file named it."""
    from studio.launch.prepared import Prepared
    from studio.ros.wire.settings import environment_for, wire_settings

    reporter, commands = _reporter(options)
    # What it imports takes longer than all the rest of a launch.
    own_types = environment_with(options.interfaces) if options.interfaces else os.environ
    settings = wire_settings(tuple(options.connect), options.domain, profile_of(options))
    with Prepared(environment_for(settings, own_types)) as prepared, ended_by_signals():
        # Imported beside what the prepared process imports.
        from studio.launch.running import run_launch_file, run_node
        from studio.ros.wire.own_router import held_router

        with held_router(settings, options.router) as joined:
            environment = environment_for(joined, own_types)
            added = {k: v for k, v in environment.items() if os.environ.get(k) != v}
            if node:
                return run_node(node, index, added, reporter, commands, prepared)
            return run_launch_file(file, given, index, added, reporter, commands, prepared)


def _reporter(options: argparse.Namespace) -> tuple[Reporter, int | None]:
    """Return who is told, and the descriptor of commands."""
    from studio.launch.reporting import Events, Lines

    if not options.events:
        return Lines(shows_all=options.all_output), None
    events = os.dup(1)
    os.dup2(2, 1)  # what a launch file itself prints is no event
    return Events(events), 0
