"""Blocks: the parts of a recorded file that are read as a whole, and which channels lie in each."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from studio.bags.recording import Recorded
    from studio.ros.node.samples import RawSample


@dataclass(frozen=True, slots=True)
class Definition:
    """What a file says about a type: its text, `ros2msg` or `ros2idl`, with all that it names."""

    type_name: str
    encoding: str
    text: str


@dataclass(frozen=True, slots=True)
class Channel:
    """Messages of one topic and type in one file.

    Attributes:
        key: Its number in the file.
        encoding: Of its messages, `cdr` in ROS 2.
        qos_text: What its publishers offered, as the file has it, YAML.
        count: Messages of it; None: the file does not say.
    """

    key: int
    topic: str
    type_name: str
    encoding: str
    type_hash: str
    qos_text: str
    count: int | None


class Entries(NamedTuple):
    """Messages of one channel in one block, by time.

    Attributes:
        times_ns: Shape (N,), int64, ascending.
        places: Shape (N,), int64: where each lies, as only its file knows.
    """

    times_ns: NDArray[np.int64]
    places: NDArray[np.int64]


NO_ENTRIES = Entries(np.zeros(0, np.int64), np.zeros(0, np.int64))


class Columns(NamedTuple):
    """Messages of one topic in one block, without an object for each.

    Attributes:
        times_ns: Shape (N,), int64, ascending.
        data: Holds all payloads.
        offsets: Shape (N,), int64: where each payload begins in `data`.
        lengths: Shape (N,), int64: bytes of each.
    """

    times_ns: NDArray[np.int64]
    data: bytes
    offsets: NDArray[np.int64]
    lengths: NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Presence:
    """In which blocks a channel lies; shape (N,) each, by their numbers.

    Attributes:
        blocks: Their numbers, int32, ascending.
        begins_ns: When each block begins, all channels together.
        ends_max_ns: When the last of it and those before it ends: ascending.
        marks: What its file knows of the channel in each, int64.
    """

    blocks: NDArray[np.int32]
    begins_ns: NDArray[np.int64]
    ends_max_ns: NDArray[np.int64]
    marks: NDArray[np.int64]

    def mark(self, block: int) -> int | None:
        """Return what the file knows of the channel in a block; None: it is not in there."""
        at = int(np.searchsorted(self.blocks, block))
        found = at < len(self.blocks) and self.blocks[at] == block
        return int(self.marks[at]) if found else None


@dataclass(frozen=True, slots=True)
class BlockTable:
    """The blocks of a file, numbered by their begins, and the channels of each.

    Attributes:
        begins_ns: The first time in each, shape (N,), int64, ascending.
        ends_ns: The last time in each.
        starts: Where each lies in the file: of messages with one time, those of the block that
            lies first come first.
        presence: By channel; one without messages is not in it.
    """

    begins_ns: NDArray[np.int64]
    ends_ns: NDArray[np.int64]
    starts: NDArray[np.int64]
    presence: Mapping[int, Presence] = field(default_factory=dict[int, Presence])

    @classmethod
    def of(
        cls,
        begins_ns: NDArray[np.int64],
        ends_ns: NDArray[np.int64],
        starts: NDArray[np.int64],
        pairs: tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int64]],
    ) -> BlockTable:
        """Make a table of blocks by their begins, and of channel, block and mark in any order."""
        order = np.lexsort((pairs[1], pairs[0]))
        channels, blocks, marks = pairs[0][order], pairs[1][order], pairs[2][order]
        cuts = (np.flatnonzero(np.diff(channels)) + 1).tolist()
        edges = [0, *cuts, len(channels)]
        presence: dict[int, Presence] = {}
        for first, last in pairwise(edges):
            if first < last:
                own = blocks[first:last]
                presence[int(channels[first])] = Presence(
                    own, begins_ns[own], np.maximum.accumulate(ends_ns[own]), marks[first:last]
                )
        return cls(begins_ns, ends_ns, starts, presence)

    @property
    def span_ns(self) -> tuple[int, int]:
        """The first and the last time of all; 0 and 0 without a block."""
        if not len(self.begins_ns):
            return 0, 0
        return int(self.begins_ns.min()), int(self.ends_ns.max())


class Outline(NamedTuple):
    """How a message of a channel is handed out."""

    topic: str
    gid: bytes


class Scan(Protocol):
    """Messages of some channels in a block, by their numbers: as they lie in the file.

    Each is made when it is asked for: as long as a whole block of them lives, the garbage collector
    looks at them again and again, which takes a fifth of the time of reading them.
    """

    @property
    def times_ns(self) -> Sequence[int]:
        """When each came."""
        ...

    def made(self, numbers: Iterable[int]) -> Iterator[Recorded]:
        """Yield those, without the ones that are damaged."""
        ...


class BlockFile(Protocol):
    """A file of a recording, read block by block; thread-safe.

    A damaged block has no entries: the file says so in its `troubles`.
    """

    @property
    def path(self) -> Path:
        """Where it lies."""
        ...

    @property
    def channels(self) -> Mapping[int, Channel]:
        """By their keys."""
        ...

    @property
    def definitions(self) -> Sequence[Definition]:
        """What it says about types."""
        ...

    @property
    def distro(self) -> str:
        """What recorded it; empty: it does not say."""
        ...

    @property
    def table(self) -> BlockTable:
        """Its blocks."""
        ...

    @property
    def troubles(self) -> Sequence[str]:
        """What is damaged, a sentence each."""
        ...

    @property
    def compresses_messages(self) -> bool:
        """Whether each message is compressed by itself."""
        ...

    def entries(self, block: int, channel: int) -> Entries:
        """Return which messages of a channel lie in a block."""
        ...

    def sample(self, block: int, channel: int, place: int, gid: bytes) -> RawSample | None:
        """Return one message; None: it is damaged, and `entries` may know better now."""
        ...

    def scanned(self, block: int, wanted: Mapping[int, Outline], *, keep: bool = True) -> Scan:
        """Return all messages of some channels in a block.

        Args:
            block: Its number.
            wanted: How the messages of each channel are handed out.
            keep: Whether the block will be asked for again: otherwise others stay at hand for it.
        """
        ...

    def columns(self, block: int, channel: int) -> Columns | None:
        """Return the payloads of a channel in a block; None: there are none, or it is damaged."""
        ...

    def close(self) -> None:
        """Give the file back."""
        ...
