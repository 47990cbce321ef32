"""`studio topic hz`, `bw` and `delay`: how often, how large and how late messages are."""

from __future__ import annotations

import argparse
import sys
import time
from typing import TYPE_CHECKING, Any

from studio.cli.acting import acting
from studio.cli.looking import full_name
from studio.cli.topic.filter_expression import filter_of
from studio.cli.topic.joining import join_topic, subscribe
from studio.cli.topic.measuring import WINDOW, Bandwidth, Delay, Rate
from studio.cli.topic.qos_options import add_qos_options
from studio.cli.topic.rate_table import rate_table
from studio.cli.wire import add_wire_options

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.cli.acting import Actor
    from studio.cli.verbs import Verbs
    from studio.ros.types.classes import MessageValue

_BW_WINDOW = 100
_PERIOD_S = 1.0
_WAITS = "A topic that nobody has yet is waited for."


def add_rates(verbs: Verbs) -> None:
    """Add the verbs that measure."""
    hz = verbs.add("hz", _hz, "print how many messages come in a second", _WAITS)
    hz.add_argument("topic_names", metavar="TOPIC", nargs="+")
    _add_options(hz, WINDOW)
    hz.add_argument("--wall-time", action="store_true", help="as is: the time on the wall")
    hz.add_argument(
        "--filter", metavar="EXPR",
        help="count only messages of which this holds, a Python expression such as 'm.x > 1'",
    )  # fmt: skip
    bw = verbs.add("bw", _bw, "print how many bytes come in a second", _WAITS)
    bw.add_argument("topic_name", metavar="TOPIC")
    _add_options(bw, _BW_WINDOW)
    delay = verbs.add(
        "delay", _delay, "print how old messages with a header are when they come", _WAITS
    )
    delay.add_argument("topic_name", metavar="TOPIC")
    _add_options(delay, WINDOW)


def _add_options(parser: argparse.ArgumentParser, window: int) -> None:
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
    rates = {name: Rate(options.window) for name in options.topic_names}
    is_taken = None if options.filter is None else filter_of(options.filter)

    def take(name: str, message: Any) -> None:  # noqa: ANN401  # bytes, or what a filter needs
        if is_taken is None or is_taken(message):
            rates[name].add(time.monotonic())

    def report() -> str | None:
        if len(rates) > 1:
            return rate_table(rates.items())
        return next(iter(rates.values())).report()

    _measure(options, list(rates), take, report, raw=is_taken is None)
    return 0


def _bw(options: argparse.Namespace) -> int:
    bandwidth = Bandwidth(options.window)

    def take(_name: str, payload: bytes) -> None:
        bandwidth.add(time.monotonic(), len(payload))

    def begin(name: str) -> None:
        print(f"Subscribed to [{name}]", flush=True)

    topics = [options.topic_name]
    _measure(
        options, topics, take, lambda: bandwidth.report(time.monotonic()), raw=True, begin=begin
    )
    return 0


def _delay(options: argparse.Namespace) -> int:
    delay = Delay(options.window)
    said = False

    def take(_name: str, message: MessageValue) -> None:
        nonlocal said
        stamp = getattr(getattr(message, "header", None), "stamp", None)
        if stamp is not None:
            delay.add(time.time_ns() / 1e9 - stamp.sec - stamp.nanosec / 1e9)
        elif not said:
            said = True
            print("msg does not have header", file=sys.stderr)

    _measure(options, [options.topic_name], take, delay.report, raw=False)
    return 0


def _measure(
    options: argparse.Namespace,
    topics: Sequence[str],
    take: Callable[[str, Any], None],
    report: Callable[[], str | None],
    *,
    raw: bool,
    begin: Callable[[str], None] = lambda _name: None,
) -> None:
    """Listen until Ctrl-C; each second, print the report when something came since the last.

    A topic that nobody has yet is waited for, as `ros2` does.
    """
    with acting(options) as actor:
        listening = _Listening(actor, options, take, raw=raw)
        said_count = 0

        def each_second() -> None:
            nonlocal said_count
            for name in listening.join():
                begin(name)
            text = report() if listening.count > said_count else None
            if text is not None:
                print(text, flush=True)
                said_count = listening.count

        listening.awaited = list(topics)
        each_second()
        for name in listening.awaited:
            print(f"WARNING: topic [{name}] does not appear to be published yet", file=sys.stderr)
        actor.report_every(_PERIOD_S, each_second)


class _Listening:
    """The topics that are listened to, and those that are not there yet.

    Attributes:
        awaited: Not there yet, as they were given.
        count: How many samples came.
    """

    def __init__(
        self,
        actor: Actor,
        options: argparse.Namespace,
        take: Callable[[str, Any], None],
        *,
        raw: bool,
    ) -> None:
        self._actor, self._options, self._take, self._raw = actor, options, take, raw
        self.awaited: list[str] = []
        self.count = 0

    def join(self) -> list[str]:
        """Listen to those that have come, and name them; one of several types ends the verb."""
        there = {name for name, _ in self._actor.graph.topics()}
        come = [name for name in self.awaited if full_name(name) in there]
        for name in come:
            self._listen(name)
        self.awaited = [name for name in self.awaited if name not in come]
        return come

    def _listen(self, name: str) -> None:
        joined = join_topic(self._actor, self._options, name, None, raw=self._raw)
        if joined is None:
            raise SystemExit(1)

        def counted(message: object) -> None:
            self.count += 1
            self._take(name, message)

        subscribe(self._actor, joined, counted, raw=self._raw)
