"""All that a bag gives, and what it says of itself, for a test to compare."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

from studio.bags.opening import open_bag
from tests.support.bags import BEGIN_NS, string_cdr

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from studio.bags.bag import Bag
    from studio.bags.recording import RecordedTopic
    from tests.support.bags import Told
    from tests.support.written_bags import Told as ToldBytes

END_NS: Final = 2**62


class ReadBag(NamedTuple):
    """A bag that was read to its end."""

    messages: list[ToldBytes]
    troubles: list[str]
    topics: dict[str, RecordedTopic]
    begin_ns: int
    end_ns: int


def all_of(bag: Bag) -> list[ToldBytes]:
    """Topic, time and bytes of every message, by time."""
    found = bag.messages([topic.name for topic in bag.topics], 0, END_NS)
    return [(topic, one.received_ns, bytes(one.payload)) for topic, one in found]


def read_bag(path: Path, kept_in: Path | None = None) -> ReadBag:
    """Open a bag, read all of it, and close it."""
    bag = open_bag(path, kept_in=kept_in)
    try:
        found = all_of(bag)
        topics = {one.name: one for one in bag.topics}
        return ReadBag(found, list(bag.troubles), topics, bag.begin_ns, bag.end_ns)
    finally:
        bag.close()


def as_read(told: Iterable[Told]) -> list[ToldBytes]:
    """The messages of `write_mcap` as they are to be read."""
    return [(one.topic, BEGIN_NS + one.at_ns, string_cdr(one.text)) for one in told]
