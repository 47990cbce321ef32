"""`studio bag cut`: write a part of a bag into another one."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.cli.bag_storing import add_storing_options, storing_of
from studio.cli.graph import full_name

if TYPE_CHECKING:
    import argparse

    from studio.cli.verbs import Verbs

_EPOCH_FROM_S: Final = 1e9
"""Times from here on are since 1970, those below since the beginning of the bag."""


def add(verbs: Verbs) -> None:
    """Add the verb."""
    cut = verbs.add(
        "cut",
        _run,
        "write a part of a bag into another one",
        "The last messages of latched topics come first, so that the part shows the robot.",
    )
    cut.add_argument("bag", type=Path, metavar="IN")
    cut.add_argument("output", type=Path, metavar="OUT", help="the folder of the new bag")
    cut.add_argument(
        "--from", dest="begin_s", type=float, metavar="S",
        help="seconds since the beginning, or since 1970 (default: the beginning)",
    )  # fmt: skip
    cut.add_argument("--to", dest="end_s", type=float, metavar="S", help="default: the end")
    cut.add_argument("--topics", nargs="+", default=[], metavar="TOPIC", help="default: all")
    add_storing_options(cut)


def _run(options: argparse.Namespace) -> int:
    from studio.bags.cutting import write_recording
    from studio.bags.opening import open_bag

    storing = storing_of(options)
    bag = open_bag(options.bag)
    try:
        for trouble in bag.troubles:
            print(f"WARNING: {trouble}", file=sys.stderr)
        written = write_recording(
            bag,
            options.output,
            [full_name(one) for one in options.topics],
            _at_ns(options.begin_s, bag.begin_ns, bag.begin_ns),
            _at_ns(options.end_s, bag.begin_ns, bag.end_ns + 1),
            lambda _done: None,
            storing=storing,
        )
    finally:
        bag.close()
    print(f"{written.messages} messages, {written.bytes} bytes: {options.output}")
    return 0


def _at_ns(given_s: float | None, zero_ns: int, default_ns: int) -> int:
    if given_s is None:
        return default_ns
    return round(given_s * 1e9) + (0 if given_s >= _EPOCH_FROM_S else zero_ns)
