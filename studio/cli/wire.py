"""Options of the verbs that speak with ROS nodes, and the session that they come to."""

from __future__ import annotations

import argparse
import os
import signal
from contextlib import contextmanager
from typing import TYPE_CHECKING

from studio.cli.interface_types import add_type_options, known_types
from studio.cli.joining import JOINING, add_joining_options

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.profiles import WireProfile
    from studio.ros.wire.session import WireSession

ROUTER_OFF = "off"
STARTING = "auto"
_DISTRO = "jazzy"


def add_wire_options(
    parser: argparse.ArgumentParser, router: str = ROUTER_OFF, *, own_types: bool = True
) -> None:
    """Add the options of a verb that joins nodes; `router` is the default of `--router`."""
    wire = parser.add_argument_group(JOINING)
    add_joining_options(
        wire.add_argument,
        router,
        "where no router answers: auto starts one in this process for as long as it runs, off "
        f"says so and ends (default here: {router})",
    )
    wire.add_argument(
        "--distro", help="humble, jazzy or kilted (default: ROS_DISTRO where known, else jazzy)"
    )
    wire.add_argument(
        "--spin-time",
        type=float,
        default=0.0,
        metavar="SECONDS",
        help="look for others for at least this long",
    )
    wire.add_argument("--no-daemon", action="store_true", help="as is: there is no daemon")
    parser.set_defaults(interrupted_code=int(signal.SIGINT))  # as ros2, 130 is that of shells
    if own_types:
        add_type_options(parser)


def take_wire_options(parser: argparse.ArgumentParser) -> None:
    """Accept and ignore the options of the wire, so that any line may have them."""
    for name in ("--connect", "--domain", "--router"):
        parser.add_argument(name, action="append", help=argparse.SUPPRESS)


@contextmanager
def opened_wire(options: argparse.Namespace, *, own_types: bool = True) -> Generator[WireSession]:
    """Open the session of a verb, closed at its end, also when Ctrl-C or SIGTERM ends it.

    A verb that encodes and decodes nothing needs no `own_types`, which take time to find.

    Raises:
        NoRouterError: None answers, and none may be started.
        WireSettingsError: An option or the environment holds an invalid value.
    """
    from studio.ros.wire.session import open_wire
    from studio.ros.wire.settings import wire_settings

    profile = profile_of(options)
    settings = wire_settings(tuple(options.connect), options.domain, profile)
    types = known_types(options, profile.distro) if own_types else None
    with ended_by_signals(), open_wire(settings, options.router, types) as wire:
        yield wire


def profile_of(options: argparse.Namespace) -> WireProfile:
    """Find the distribution that is spoken.

    Raises:
        RosNameError: `--distro` names none that is known.
    """
    from studio.ros.profiles import PROFILES, profile_named

    if options.distro is not None:
        return profile_named(options.distro)
    named = os.environ.get("ROS_DISTRO", "")
    return PROFILES.get(named, PROFILES[_DISTRO])


@contextmanager
def ended_by_signals() -> Generator[None]:
    """Let signals end the verb; Ctrl-C too where a script started it in the background."""

    def end(number: int, _frame: object) -> None:
        raise SystemExit(128 + number)

    handlers = {signal.SIGTERM: end, signal.SIGINT: signal.default_int_handler}
    hangup = getattr(signal, "SIGHUP", None)  # the terminal has closed; nohup ignores it
    if hangup is not None and signal.getsignal(hangup) is not signal.SIG_IGN:
        handlers[hangup] = end
    before = {number: signal.signal(number, handler) for number, handler in handlers.items()}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
