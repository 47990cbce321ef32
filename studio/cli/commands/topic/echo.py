"""`studio topic echo`: print the messages of a topic."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.cli.filter_expression import filter_of
from studio.cli.numbers import whole
from studio.cli.own_node import own_node
from studio.cli.qos_options import add_qos_options
from studio.cli.subscribing import join_topic, subscribe
from studio.cli.terminal import shown
from studio.cli.wire import add_wire_options
from studio.errors import SettingsError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

    from studio.cli.verbs import Verbs
    from studio.ros.node.samples import MessageInfo
    from studio.ros.types.classes import MessageValue

_LENGTH = 128


def add(verbs: Verbs) -> None:
    """Add the verb."""
    echo = verbs.add("echo", _run, "print the messages of a topic")
    echo.add_argument("topic_name", metavar="TOPIC")
    echo.add_argument("message_type", metavar="TYPE", nargs="?", help="default: that of the topic")
    echo.add_argument("--once", action="store_true", help="print one message and end")
    echo.add_argument(
        "--timeout", type=float, metavar="SECONDS", help="end after this long; 1 if nothing came"
    )
    echo.add_argument("--field", metavar="PATH", help="one field alone, as pose.position.x")
    echo.add_argument("--csv", action="store_true", help="one line of values for each message")
    echo.add_argument("--no-arr", action="store_true", help="leave arrays out")
    echo.add_argument("--no-str", action="store_true", help="leave texts out")
    echo.add_argument("--flow-style", action="store_true", help="YAML in one line")
    echo.add_argument("-f", "--full-length", action="store_true", help="cut nothing off")
    echo.add_argument(
        "-l", "--truncate-length", type=whole, default=_LENGTH, metavar="N",
        help=f"cut arrays and texts off after this many (default: {_LENGTH})",
    )  # fmt: skip
    echo.add_argument("--include-message-info", action="store_true", help="when and from whom")
    echo.add_argument("--raw", action="store_true", help="print the bytes, also of unknown types")
    echo.add_argument(
        "--filter", metavar="EXPR",
        help="print only messages of which this holds, a Python expression such as 'm.x > 1'",
    )  # fmt: skip
    echo.add_argument(
        "--no-lost-messages", action="store_true", help="do not print how many were lost"
    )
    add_qos_options(echo)
    echo.set_defaults(takes_late=("message_type", None))
    add_wire_options(echo)


def _run(options: argparse.Namespace) -> int:
    from studio.cli.message_text import Printing

    is_taken = _filter(options)
    with own_node(options) as own:
        joined = join_topic(own, options, options.topic_name, options.message_type, raw=options.raw)
        if joined is None:
            return 1
        printing = Printing(options)
        count = 0

        def show(message: MessageValue | bytes, info: MessageInfo) -> None:
            nonlocal count
            if not isinstance(message, bytes) and not is_taken(message):
                return
            if count == 0 or not options.once:
                print(shown(printing.text(message, info)), flush=True)
                count += 1

        subscription = subscribe(own, joined, show, raw=options.raw)

        def is_done() -> bool:
            if not options.no_lost_messages:
                printing.print_lost(subscription.losses)
            return options.once and count > 0

        came = own.work_until(is_done, options.timeout)
        return 0 if came or count else 1


def _filter(options: argparse.Namespace) -> Callable[[MessageValue], bool]:
    """Return what chooses messages.

    Raises:
        SettingsError: Bytes cannot be chosen from, or the expression is none.
    """
    if options.filter is None:
        return lambda _message: True
    if options.raw:
        raise SettingsError("--filter looks into messages, --raw does not read them: give one.")
    return filter_of(options.filter)
