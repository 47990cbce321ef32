"""`studio topic pub`: publish messages, once or again and again, one or those of a file."""

from __future__ import annotations

import argparse
import itertools
import re
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from studio.cli.graph import full_name
from studio.cli.numbers import count
from studio.cli.own_node import own_node
from studio.cli.qos_options import add_qos_options, given_profile
from studio.cli.wire import STARTING, add_wire_options
from studio.errors import SettingsError
from studio.ros.names import full_type_name

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.cli.own_node import OwnNode
    from studio.cli.verbs import Verbs
    from studio.ros.node.publisher import Publisher
    from studio.ros.types.classes import MessageValue


_KEEP_ALIVE_S = 0.1
_PRINT_EVERY_S = 1.0


def add(verbs: Verbs) -> None:
    """Add the verb."""
    pub = verbs.add(
        "pub",
        _run,
        "publish a message",
        "Where no router answers, one is started for as long as the command runs.",
    )
    pub.add_argument("topic_name", metavar="TOPIC")
    pub.add_argument("message_type", metavar="TYPE")
    pub.add_argument(
        "values", metavar="YAML", nargs="?", default="{}",
        help="the fields, for example \"data: 'Hello'\"; now is the time, a header may be auto",
    )  # fmt: skip
    source = pub.add_mutually_exclusive_group()
    source.add_argument("--stdin", action="store_true", help="read the fields from standard input")
    source.add_argument(
        "--yaml-file", type=Path, metavar="FILE",
        help="publish the messages of a file one after another, as topic echo printed them",
    )  # fmt: skip
    often = pub.add_mutually_exclusive_group()
    often.add_argument("-r", "--rate", type=_rate, metavar="HZ", help="a second (default: 1)")
    often.add_argument("-1", "--once", action="store_true", help="publish one message and end")
    pub.add_argument("-t", "--times", type=count, metavar="N", help="publish N messages and end")
    pub.add_argument("-p", "--print", type=count, default=1, metavar="N", help="print every Nth")
    pub.add_argument(
        "-w", "--wait-matching-subscriptions", dest="wait", type=int, metavar="N",
        help="begin when so many listen (default: 1 with --once or --times, else 0)",
    )  # fmt: skip
    pub.add_argument(
        "--max-wait-time-secs", dest="wait_s", type=float, metavar="SECONDS",
        help="wait for them no longer, then end with 1",
    )  # fmt: skip
    pub.add_argument(
        "--keep-alive", type=float, default=_KEEP_ALIVE_S, metavar="SECONDS",
        help=f"stay this long after the last message (default: {_KEEP_ALIVE_S})",
    )  # fmt: skip
    pub.add_argument("-n", "--node-name", help="name of the node (default: a hidden one)")
    add_qos_options(pub)
    pub.set_defaults(takes_late=("values", "{}"))
    add_wire_options(pub, STARTING)


def _rate(text: str) -> float:
    number = float(text)
    if not 0 < number < 1e6:
        raise argparse.ArgumentTypeError(f"{number} is no rate: give more than 0")
    return number


def _run(options: argparse.Namespace) -> int:
    from studio.ros.qos import QoSProfile

    type_name = full_type_name(options.message_type)
    name = full_name(options.topic_name)
    with own_node(options, options.node_name, answers=True) as own:
        kind = own.types.message(type_name)
        source = source_of(options, kind)
        qos = given_profile(options, QoSProfile(depth=10))
        publisher = own.node.create_publisher(kind, name, qos)
        times = 1 if options.once else options.times
        wanted = options.wait if options.wait is not None else int(times is not None)
        if not _wait_for_listeners(own, name, wanted, options.wait_s):
            return 1
        beats = _beats(own, 1 / (options.rate or 1.0))
        _publish(_numbers(times, source.count), beats, source.messages, publisher, options.print)
        own.work_until(lambda: False, max(0.0, options.keep_alive))
    return 0


def _wait_for_listeners(own: OwnNode, name: str, wanted: int, timeout_s: float | None) -> bool:
    """Wait for so many subscriptions, with a message each second; False when the time is over."""
    end_s = None if timeout_s is None else time.monotonic() + timeout_s
    while not own.graph.wait_for(lambda: len(own.graph.subscriptions(name)) >= wanted, 0.01):
        print(f"Waiting for at least {wanted} matching subscription(s)...", flush=True)
        left_s = _PRINT_EVERY_S if end_s is None else min(_PRINT_EVERY_S, end_s - time.monotonic())
        if left_s <= 0:
            print(f"Timed out waiting for subscriptions of {name}.", file=sys.stderr)
            return False
        own.graph.wait_for(lambda: len(own.graph.subscriptions(name)) >= wanted, left_s)
    return True


def _numbers(*counts: int | None) -> Iterable[int]:
    """Number messages, as many as the least of those counts that are given."""
    given = [one for one in counts if one is not None]
    return range(1, min(given) + 1) if given else itertools.count(1)


def _publish(
    numbers: Iterable[int],
    beats: Iterator[None],
    messages: Iterator[MessageValue],
    publisher: Publisher,
    printed_every: int,
) -> None:
    print("publisher: beginning loop", flush=True)
    for number in numbers:
        next(beats)
        message = next(messages)
        if number % printed_every == 0:
            print(f"publishing #{number}: {message!r}\n", flush=True)
        publisher.publish(message)


def _beats(own: OwnNode, period_s: float) -> Iterator[None]:
    """Give one beat at once and then one each period, which do not drift; others are answered."""
    next_s = time.monotonic()
    while True:
        own.work_until(lambda: False, max(0.0, next_s - time.monotonic()))
        yield
        next_s += period_s


TEXT_BYTES_MAX = 10_000_000
_BETWEEN = re.compile(r"^---[ \t]*(?:#.*)?$", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class MessageSource:
    """Messages one after another; `count` of them, None without end."""

    messages: Iterator[MessageValue]
    count: int | None = None


def source_of(options: argparse.Namespace, kind: type[MessageValue]) -> MessageSource:
    """Return the messages that a line asks for; the first is made at once, to find mistakes early.

    Raises:
        MessageValueError: A text is no YAML, or no such message.
        SettingsError: There is nothing to read.
    """
    if options.yaml_file is not None:
        path = options.yaml_file.expanduser()
        texts = _documents(_read(path))
        return MessageSource(iter([_message(kind, text, str(path)) for text in texts]), len(texts))
    text = sys.stdin.read(TEXT_BYTES_MAX) if options.stdin else options.values
    source = "standard input" if options.stdin else ""
    return MessageSource(_again_and_again(kind, text, _message(kind, text, source)))


def _again_and_again(
    kind: type[MessageValue], text: str, first: MessageValue
) -> Iterator[MessageValue]:
    """Yield one message without end; where it holds the time, that of each moment."""
    has_time = "now" in text or "auto" in text
    while True:
        yield _message(kind, text) if has_time else first


def _message(kind: type[MessageValue], text: str, source: str = "") -> MessageValue:
    from studio.ros.types.convert import from_yaml

    return from_yaml(kind, text, now_ns=time.time_ns(), source=source)


def _documents(text: str) -> list[str]:
    """Part a file into its messages, each with the empty lines that keep its place in the file."""
    found: list[str] = []
    lines_before = 0
    for one in _BETWEEN.split(text):
        if one.strip():
            found.append("\n" * lines_before + one)
        lines_before += one.count("\n")
    if not found:
        raise SettingsError("--yaml-file holds no message: nothing stands between its lines ---.")
    return found


def _read(path: Path) -> str:
    try:
        with path.open("rb") as file:
            data = file.read(TEXT_BYTES_MAX + 1)
    except OSError as error:
        raise SettingsError(f"{path} cannot be read: {error.strerror}.") from error
    if len(data) > TEXT_BYTES_MAX:
        raise SettingsError(f"{path} is larger than {TEXT_BYTES_MAX} bytes.")
    return data.decode(errors="replace")
