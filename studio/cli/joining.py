"""Options of all commands that join ROS nodes: over which router, and in which domain."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable

_HIGHEST_DOMAIN: Final = 232
JOINING: Final = "ROS 2 over Zenoh"
"""The group of these options in the help."""


def add_joining_options(add: Callable[..., object], router: str, router_help: str) -> None:
    """Add them; `router` is the default of `--router`, and `router_help` its text in the help."""
    add(
        "--connect",
        action="append",
        default=[],
        metavar="ENDPOINT",
        help="the router, for example tcp/192.0.2.7:7447 (default: tcp/127.0.0.1:7447)",
    )
    add(
        "--domain",
        type=domain_number,
        metavar="N",
        help="the domain (default: ROS_DOMAIN_ID, else 0)",
    )
    add("--router", default=router, metavar="auto|off|ENDPOINT", help=router_help)


def domain_number(text: str) -> int:
    """Read a ROS_DOMAIN_ID, for argparse."""
    number = int(text)
    if not 0 <= number <= _HIGHEST_DOMAIN:
        raise argparse.ArgumentTypeError(f"{number} is no domain: 0 to {_HIGHEST_DOMAIN}")
    return number
