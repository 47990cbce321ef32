"""`studio bag info`: print what is in a bag."""

from __future__ import annotations

import sys
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from studio.cli.terminal import shown
from studio.ros.duration import NANOSECONDS

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Iterable

    from studio.bags.bag import Bag
    from studio.bags.recording import RecordedTopic
    from studio.cli.verbs import Verbs

_ORDERS: Final[dict[str, Callable[[RecordedTopic], Any]]] = {
    "name": lambda one: one.name,
    "type": lambda one: (one.type_name, one.name),
    "count": lambda one: (-one.count, one.name),
}
_UNITS: Final = ("B", "KiB", "MiB", "GiB", "TiB")
_EVENTS: Final = "/_service_event"
"""Ends the name of a topic on which a service tells of its calls."""


def add(verbs: Verbs) -> None:
    """Add the verb."""
    info = verbs.add(
        "info",
        _run,
        "print what is in a bag",
        "A bag that was cut off or damaged is read as far as it is whole; what is lost is told.",
    )
    info.add_argument("bag", type=Path, help="its folder, or one of its files")
    info.add_argument("-t", "--topic-name", action="store_true", help="print names of topics only")
    info.add_argument("-v", "--verbose", action="store_true", help="print QoS and hashes as well")
    info.add_argument("--sort", choices=_ORDERS, default="name", help="order of topics")
    info.add_argument(
        "-s", "--storage", help="taken as ros2 takes it: the files tell by themselves"
    )


def _run(options: argparse.Namespace) -> int:
    from studio.bags.opening import open_bag

    bag = open_bag(options.bag)
    try:
        topics = sorted(bag.topics, key=_ORDERS[options.sort])
        plain = [one for one in topics if not _is_service(one)]
        services = [one for one in topics if _is_service(one)]
        if options.topic_name:
            _print(one.name for one in plain)
        else:
            _print(_lines(bag, plain, services, verbose=options.verbose))
        of_topics = (f"{one.name}: {said}" for one in topics if (said := one.trouble or one.note))
        for trouble in (*bag.troubles, *of_topics):
            print(shown(f"WARNING: {trouble}"), file=sys.stderr)
    finally:
        bag.close()
    return 0


def _print(lines: Iterable[str]) -> None:
    for line in lines:
        print(shown(line))


def _is_service(topic: RecordedTopic) -> bool:
    is_event = "/srv/" in topic.type_name and topic.type_name.endswith("_Event")
    return is_event and topic.name.endswith(_EVENTS)


def _lines(
    bag: Bag,
    topics: list[RecordedTopic],
    services: list[RecordedTopic],
    *,
    verbose: bool,
) -> Iterable[str]:
    """Yield what `ros2 bag info` prints, in its words."""
    yield ""
    yield from _listed("Files:", [one.name for one in bag.files])
    yield _row("Bag size:", _size(bag.size_bytes))
    yield _row("Storage id:", bag.storage)
    yield _row("ROS Distro:", bag.distro or "unknown")
    yield _row("Duration:", f"{_seconds(bag.end_ns - bag.begin_ns)}s")
    yield _row("Start:", _moment(bag.begin_ns))
    yield _row("End:", _moment(bag.end_ns))
    yield _row("Messages:", str(bag.message_count))
    yield from _listed("Topic information:", [_about(one, verbose=verbose) for one in topics])
    yield _row("Service:", str(len(services)))
    yield from _listed("Service information:", [_called(one) for one in services])


def _row(name: str, value: str) -> str:
    return f"{name:<18} {value}"


def _listed(name: str, values: list[str]) -> list[str]:
    first, *rest = values or [""]
    return [_row(name, first), *(_row("", one) for one in rest)]


def _about(topic: RecordedTopic, *, verbose: bool) -> str:
    told = (
        f"Topic: {topic.name} | Type: {topic.type_name} | Count: {topic.count} | "
        f"Serialization Format: {topic.encoding}"
    )
    if verbose:
        offered = ", ".join(
            f"{one.reliability.name.lower()} {one.durability.name.lower()} depth {one.depth}"
            for one in topic.qos
        )
        told += f" | QoS: {offered or 'unknown'} | Hash: {topic.type_hash or 'unknown'}"
    return told


def _called(topic: RecordedTopic) -> str:
    service = topic.name.removesuffix(_EVENTS)
    kind = topic.type_name.removesuffix("_Event")
    return (
        f"Service: {service} | Type: {kind} | Event Count: {topic.count} | "
        f"Serialization Format: {topic.encoding}"
    )


def _size(count: float) -> str:
    unit = 0
    while count >= 1024 and unit < len(_UNITS) - 1:
        count, unit = count / 1024, unit + 1
    return f"{count:.{1 if unit else 0}f} {_UNITS[unit]}"


def _seconds(span_ns: int) -> str:
    return f"{span_ns // NANOSECONDS}.{span_ns % NANOSECONDS:09}"


def _moment(at_ns: int) -> str:
    """Return a time by the clock of this place, and since 1970."""
    at = datetime.fromtimestamp(at_ns // NANOSECONDS).astimezone()
    return f"{at:%b %e %Y %H:%M:%S}.{at_ns % NANOSECONDS:09} ({_seconds(at_ns)})"
