"""`studio demos`: list and start the course's systems, as real nodes."""

from __future__ import annotations

import argparse
import textwrap
from typing import TYPE_CHECKING

from studio.cli.interface_types import add_interfaces_option, environment_with
from studio.cli.wire import STARTING, add_wire_options, opened_wire
from studio.errors import SettingsError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.course.demos import Demo


_DETAILS = """\
Without names: lists them. With names: starts them, all until Ctrl-C, and prints what to try.
Their names and the course's, as in `studio run`, are both understood.

examples:
  studio demos
  studio demos talker listener
  studio demos radio_dj song_requester --ros-args -p step_seconds:=0.1
  studio demos --about turtlesim_node
"""


def add(parser: argparse.ArgumentParser) -> None:
    """Give the parser the names of demos, and how they reach each other."""
    parser.epilog = _DETAILS
    parser.add_argument("names", metavar="NAME", nargs="*", help="which to start")
    parser.add_argument("--about", action="store_true", help="print what to try, and start nothing")
    parser.add_argument(
        "--ros-args",
        nargs=argparse.REMAINDER,
        default=[],
        metavar="...",
        help="given to each node: -p NAME:=VALUE, -r FROM:=TO",
    )
    add_interfaces_option(
        parser,
        "types of one's own that the nodes know: a package's folder, a folder of packages, "
        "or a file; may be given again",
    )
    parser.set_defaults(run=run)
    add_wire_options(parser, router=STARTING, own_types=False)


def run(options: argparse.Namespace) -> int:
    """List the demos, or start some and wait for them."""
    from studio.course.demos import DEMOS

    if not options.names:
        _list(DEMOS)
        return 0
    demos = [_demo(name) for name in options.names]
    for demo in demos:
        print(f"{demo.name}: {demo.shows}\n{textwrap.indent(demo.to_try, '  ')}")
    return 0 if options.about else _start(demos, options)


def _start(demos: Sequence[Demo], options: argparse.Namespace) -> int:
    """Hold the router, if it is ours, for as long as one of them runs."""
    from studio.course.demos import LESSONS
    from studio.course.processes import DemoProcesses
    from studio.ros.wire.settings import environment_for

    arguments = ["--ros-args", *options.ros_args] if options.ros_args else []
    own_types = environment_with(options.interfaces)
    with (
        opened_wire(options, own_types=False) as wire,
        DemoProcesses(environment_for(wire.settings, own_types)) as processes,
    ):
        for demo in demos:
            processes.start(demo.module, [*LESSONS[demo.name].arguments, *arguments])
        return processes.wait()


def _demo(name: str) -> Demo:
    from studio.course.demos import find_demo

    found = find_demo(name)
    if found is None:
        raise SettingsError(f"No demo is called {name}: `studio demos` lists them.")
    return found


def _list(demos: Sequence[Demo]) -> None:
    width = max(len(demo.name) for demo in demos)
    for demo in demos:
        print(f"{demo.name:{width}}  {demo.shows}")
    print(
        "\nStart some with `studio demos NAME ...`; `studio demos --about NAME` prints what to try."
    )
