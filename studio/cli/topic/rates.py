"""`studio topic hz`, `bw` and `delay`: how often, how large and how late messages are."""

from __future__ import annotations

import argparse
import sys
import time
from typing import TYPE_CHECKING, cast

from studio.cli.acting import acting
from studio.cli.topic.joining import join_topic, subscribe
from studio.cli.topic.measuring import WINDOW, Bandwidth, Delay, Rate
from studio.cli.topic.qos_options import add_qos_options
from studio.cli.wire import add_wire_options

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.cli.acting import Actor
    from studio.cli.verbs import Verbs
    from studio.ros.types.classes import MessageValue

_BW_WINDOW = 100
_PERIOD_S = 1.0


def add_rates(verbs: Verbs) -> None:
    """Add the verbs that measure."""
    hz = verbs.add("hz", _hz, "print how many messages come in a second")
    _add_options(hz, WINDOW)
    hz.add_argument("--wall-time", action="store_true", help="as is: the time on the wall")
    bw = verbs.add("bw", _bw, "print how many bytes come in a second")
    _add_options(bw, _BW_WINDOW)
    delay = verbs.add("delay", _delay, "print how old messages with a header are when they come")
    _add_options(delay, WINDOW)


def _add_options(parser: argparse.ArgumentParser, window: int) -> None:
    parser.add_argument("topic_name", metavar="TOPIC")
    parser.add_argument(
        "-w", "--window", type=_window, default=window, metavar="N",
        help=f"over this many of the newest (default: {window})",
    )  # fmt: skip
    add_qos_options(parser)
    add_wire_options(parser)


def _window(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{number} is no window: give 1 or more")
    return number


def _hz(options: argparse.Namespace) -> int:
    rate = Rate(options.window)

    def take(_payload: bytes) -> None:
        rate.add(time.monotonic())

    return _measure(options, take, rate.report, raw=True)


def _bw(options: argparse.Namespace) -> int:
    bandwidth = Bandwidth(options.window)

    def take(payload: bytes) -> None:
        bandwidth.add(time.monotonic(), len(payload))

    def report() -> str | None:
        return bandwidth.report(time.monotonic())

    def begin(_actor: Actor) -> None:
        print(f"Subscribed to [{options.topic_name}]", flush=True)

    return _measure(options, take, report, raw=True, begin=begin)


def _delay(options: argparse.Namespace) -> int:
    delay = Delay(options.window)
    said = False

    def take(message: MessageValue) -> None:
        nonlocal said
        stamp = getattr(getattr(message, "header", None), "stamp", None)
        if stamp is not None:
            delay.add(time.time_ns() / 1e9 - stamp.sec - stamp.nanosec / 1e9)
        elif not said:
            said = True
            print("msg does not have header", file=sys.stderr)

    return _measure(options, take, delay.report, raw=False)


def _measure(
    options: argparse.Namespace,
    take: Callable[..., None],
    report: Callable[[], str | None],
    *,
    raw: bool,
    begin: Callable[[Actor], None] | None = None,
) -> int:
    """Listen for ever; each second, print the report when something came since the last."""
    with acting(options) as actor:
        joined = join_topic(actor, options, None)
        if joined is None:
            return 1
        count = said_count = 0

        def counted(message: object) -> None:
            nonlocal count
            count += 1
            cast("Callable[[object], None]", take)(message)

        def say() -> None:
            nonlocal said_count
            text = report() if count > said_count else None
            if text is not None:
                print(text, flush=True)
                said_count = count

        subscribe(actor, joined, counted, raw=raw)
        if begin is not None:
            begin(actor)
        actor.report_every(_PERIOD_S, say)
    return 0
