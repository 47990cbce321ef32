"""`studio topic hz`, `bw` and `delay`: how often, how large and how late messages are."""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from studio.cli.filter_expression import filter_of
from studio.cli.graph import full_name
from studio.cli.own_node import own_node
from studio.cli.qos_options import add_qos_options
from studio.cli.subscribing import join_topic, subscribe
from studio.cli.wire import add_wire_options

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from studio.cli.own_node import OwnNode
    from studio.cli.verbs import Verbs
    from studio.ros.types.classes import MessageValue


_BW_WINDOW = 100
_PERIOD_S = 1.0
_WAITS = "A topic that does not exist yet is waited for."


def add(verbs: Verbs) -> None:
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
    has_warned = False

    def take(_name: str, message: MessageValue) -> None:
        nonlocal has_warned
        stamp = getattr(getattr(message, "header", None), "stamp", None)
        if stamp is not None:
            delay.add(time.time_ns() / 1e9 - stamp.sec - stamp.nanosec / 1e9)
        elif not has_warned:
            has_warned = True
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
    """Receive until Ctrl-C; each second, print the report when something came since the last.

    A topic that does not exist yet is waited for, as `ros2` does.
    """
    with own_node(options) as own:
        listening = _Listening(own, options, take, raw=raw)
        printed_count = 0

        def each_second() -> None:
            nonlocal printed_count
            for name in listening.join():
                begin(name)
            text = report() if listening.count > printed_count else None
            if text is not None:
                print(text, flush=True)
                printed_count = listening.count

        listening.awaited = list(topics)
        each_second()
        for name in listening.awaited:
            print(f"WARNING: topic [{name}] does not appear to be published yet", file=sys.stderr)
        own.report_every(_PERIOD_S, each_second)


class _Listening:
    """The topics that are listened to, and those that are not there yet.

    Attributes:
        awaited: Not there yet, as they were given.
        count: How many samples came.
    """

    def __init__(
        self,
        own: OwnNode,
        options: argparse.Namespace,
        take: Callable[[str, Any], None],
        *,
        raw: bool,
    ) -> None:
        self._actor, self._options, self._take, self._raw = own, options, take, raw
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


WINDOW = 10_000
_KILO, _MEGA = 1e3, 1e6


@dataclass(frozen=True, slots=True)
class Spread:
    """Number, mean, extremes and standard deviation of some numbers."""

    count: int
    mean: float
    lowest: float
    highest: float
    deviation: float

    @classmethod
    def of(cls, numbers: Iterable[float]) -> Spread:
        """Take the measure of at least one number."""
        all_of_them = list(numbers)
        mean = math.fsum(all_of_them) / len(all_of_them)
        squares = math.fsum((one - mean) ** 2 for one in all_of_them)
        return cls(
            len(all_of_them),
            mean,
            min(all_of_them),
            max(all_of_them),
            math.sqrt(squares / len(all_of_them)),
        )


class Rate:
    """The time between samples; times in seconds of any clock that does not jump."""

    def __init__(self, window: int = WINDOW) -> None:
        self._gaps_s: deque[float] = deque(maxlen=window)
        self._last_s: float | None = None

    def add(self, time_s: float) -> None:
        """A sample came; a clock that went backwards begins again."""
        if self._last_s is not None and time_s < self._last_s:
            self._gaps_s.clear()
        elif self._last_s is not None:
            self._gaps_s.append(time_s - self._last_s)
        self._last_s = time_s

    @property
    def hertz(self) -> float | None:
        """The mean rate; None before the second sample, or when all came at once."""
        total_s = math.fsum(self._gaps_s)
        return len(self._gaps_s) / total_s if total_s > 0 else None

    def gaps(self) -> Spread:
        """Take the measure of the times between samples, seconds; there must be some."""
        return Spread.of(self._gaps_s)

    def report(self) -> str | None:
        """Return the report of `ros2 topic hz`; None when there is nothing to report."""
        if self.hertz is None:
            return None
        gaps = self.gaps()
        return f"average rate: {self.hertz:.3f}\n{_spread_text(gaps, gaps.count + 1)}"


class Delay:
    """Age of samples on arrival, by the stamp of their header."""

    def __init__(self, window: int = WINDOW) -> None:
        self._delays_s: deque[float] = deque(maxlen=window)

    def add(self, delay_s: float) -> None:
        """A sample of this age came."""
        self._delays_s.append(delay_s)

    def report(self) -> str | None:
        """Return the report of `ros2 topic delay`; None when there is nothing to report."""
        if not self._delays_s:
            return None
        delays = Spread.of(self._delays_s)
        return f"average delay: {delays.mean:.3f}\n{_spread_text(delays, delays.count)}"


class Bandwidth:
    """Bytes per second, from the oldest sample of the window until now."""

    def __init__(self, window: int = 100) -> None:
        self._samples: deque[tuple[float, int]] = deque(maxlen=window)

    def add(self, time_s: float, size_bytes: int) -> None:
        """A sample of this size came."""
        self._samples.append((time_s, size_bytes))

    def report(self, now_s: float) -> str | None:
        """Return the report of `ros2 topic bw`; None before the second sample."""
        if len(self._samples) < 2 or now_s <= self._samples[0][0]:
            return None
        sizes = Spread.of(size for _, size in self._samples)
        bytes_per_s = sizes.mean * sizes.count / (now_s - self._samples[0][0])
        unit, name = _unit(bytes_per_s)
        places = 0 if unit == 1 else 2
        rate, mean, lowest, highest = (
            f"{number / unit:.{places}f} {name}"
            for number in (bytes_per_s, sizes.mean, sizes.lowest, sizes.highest)
        )
        return (
            f"{rate}/s from {sizes.count} messages\n"
            f"\tMessage size mean: {mean} min: {lowest} max: {highest}"
        )


def _unit(bytes_per_s: float) -> tuple[float, str]:
    if bytes_per_s < _KILO:
        return 1, "B"
    return (_KILO, "KB") if bytes_per_s < _MEGA else (_MEGA, "MB")


def _spread_text(spread: Spread, window: int) -> str:
    return (
        f"\tmin: {spread.lowest:.3f}s max: {spread.highest:.3f}s "
        f"std dev: {spread.deviation:.5f}s window: {window}"
    )


_HEAD = ("topic", "rate", "min_delta", "max_delta", "stddev", "window")
_GAP = "   "


def rate_table(rates: Iterable[tuple[str, Rate]]) -> str | None:
    """Write the topics that have a rate; None where none has."""
    rows = [(topic, *cells) for topic, rate in rates if (cells := _cells(rate)) is not None]
    if not rows:
        return None
    widths = [max(map(len, column)) for column in zip(_HEAD, *rows, strict=True)]
    head = _GAP.join(name.center(width) for name, width in zip(_HEAD, widths, strict=True))
    lines = [_GAP.join(map(str.ljust, row, widths)) for row in rows]
    return "\n".join([head, "=" * len(head), *lines, ""])


def _cells(rate: Rate) -> tuple[str, ...] | None:
    hertz = rate.hertz
    if hertz is None:
        return None
    gaps = rate.gaps()
    spread = (f"{gaps.lowest:.3f}", f"{gaps.highest:.3f}", f"{gaps.deviation:.5f}")
    return (f"{hertz:.3f}", *spread, str(gaps.count + 1))
