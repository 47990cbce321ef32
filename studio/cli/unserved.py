"""Lines of `ros2` that the studio does not serve yet: one sentence says so, and exit code 2."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from studio.cli.verbs import Verbs

_INSTEAD = {
    "launch": "start the nodes that it names with studio run, each in a terminal of its own",
    "bag record": "record with ros2 bag on a machine that has ROS",
    "bag play": "play it with ros2 bag on a machine that has ROS",
    "bag info": "look at it with ros2 bag on a machine that has ROS",
    "pkg create": "write package.xml and its folders by hand, or with ros2 pkg create",
}


def refuse(verbs: Verbs, name: str, summary: str, line: str) -> None:
    """Add a verb that is not served, whatever stands behind it."""

    def run(_options: argparse.Namespace) -> int:
        return say_unserved(line)

    parser = verbs.add(name, run, f"{summary} (not served yet)")
    add_rest(parser)


def say_unserved(line: str) -> int:
    """Say that a line is not served, and what to do; answers the exit code."""
    print(f"studio: studio {line} is not there yet: {_INSTEAD[line]}.", file=sys.stderr)
    return 2


def add_rest(parser: argparse.ArgumentParser) -> None:
    """Take all that stands behind, options too."""
    parser.add_argument("rest", nargs="*", help=argparse.SUPPRESS)
    parser.set_defaults(takes_rest=True)
