"""`studio router`: run a Zenoh router, where nodes find each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse

    from studio.ros.wire.settings import WireSettings


_LOOPBACK = "tcp/127.0.0.1:7447"


def add(parser: argparse.ArgumentParser) -> None:
    """Add the options of `router` to the parser."""
    parser.description = "Run a Zenoh router until Ctrl-C, so that nodes find each other."
    parser.add_argument(
        "--listen",
        default=_LOOPBACK,
        metavar="ENDPOINT",
        help=f"where (default: {_LOOPBACK}, this machine only)",
    )
    parser.add_argument(
        "--join",
        action="store_true",
        help="join the router that ZENOH_CONFIG_OVERRIDE names, by its certificate: then the nodes "
        "of this machine need ROS_DOMAIN_ID alone",
    )
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> None:
    from studio.ros.wire.router import run_router
    from studio.ros.wire.settings import wire_settings

    settings = wire_settings()
    joins = _joined(settings) if options.join else ()
    run_router(options.listen, _print, settings.overrides, settings.router_config_file, joins)


def _joined(settings: WireSettings) -> tuple[str, ...]:
    from studio.errors import WireSettingsError

    if settings.connect == (_LOOPBACK,):
        raise WireSettingsError(
            "ZENOH_CONFIG_OVERRIDE names no router to join: paste the line of the class first."
        )
    return settings.connect


def _print(endpoint: str) -> None:
    print(f"Zenoh router at {endpoint}; Ctrl-C ends it.", flush=True)
