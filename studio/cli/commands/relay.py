"""`studio relay`: serve browsers of a shared studio that is somewhere else, and dials in here."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.cli.serving import add_page_options, page_settings

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the options of `relay` to the parser."""
    parser.add_argument(
        "--listen",
        default="tls/0.0.0.0:7448",
        metavar="ENDPOINT",
        help="where studios dial in, always encrypted (default: tls/0.0.0.0:7448)",
    )
    parser.add_argument(
        "--name",
        default="",
        metavar="HOST",
        help="name or address by which studios and browsers find this machine",
    )
    parser.add_argument(
        "--new-key",
        action="store_true",
        help="make a new key; studios with the old one can no longer connect",
    )
    parser.add_argument(
        "--print",
        dest="printed",
        choices=("systemd", "compose", "nginx"),
        help="print a systemd unit, compose file or nginx site for this relay, and exit",
    )
    parser.set_defaults(run=run)
    add_page_options(parser)


def run(options: argparse.Namespace) -> None:
    """Serve until the command is stopped.

    Raises:
        StudioError: It cannot listen.
    """
    settings = page_settings(options, keeps=not options.printed)
    if options.printed:
        from studio.server.relays.prints import printed

        print(printed(options.printed, settings, options.listen, options.name), end="")
        return
    from studio.server.relays.serving import serve_relay

    serve_relay(settings, options.listen, options.name, new_key=options.new_key)
