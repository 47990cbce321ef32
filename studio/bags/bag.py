"""A bag: files of ROS 2's recorder, opened by index and read by topic and time."""

from __future__ import annotations

import hashlib
import heapq
import itertools
import threading
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.bags import queries
from studio.bags.blocks import Columns, Outline
from studio.bags.metadata import profiles_of
from studio.bags.metadata_text import BagDescription, Span
from studio.bags.recording import RecordedTopic, Split
from studio.bags.schemas import types_of
from studio.errors import RecordingError
from studio.files import stamp_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from studio.bags.blocks import BlockFile, Channel
    from studio.bags.metadata import BagMetadata
    from studio.bags.recording import Recorded
    from studio.bags.schemas import BagTypes
    from studio.ros.node.samples import RawSample
    from studio.ros.types.library import TypeLibrary

BINS_MAX: Final = 100_000
_CDR: Final = "cdr"


class Bag:
    """Files that were recorded together; a `Recording`.

    A topic with messages of two types is listed by the type of most of them; the others are left
    out, and its `note` says so.

    Attributes:
        path: As it was asked for.
        storage: `mcap` or `sqlite3`.
        distro: That it was recorded with; empty: it does not say.
        splits: Where one file of it ends and the next begins, in their order.
        metadata: What `metadata.yaml` says; None without one.
    """

    def __init__(
        self,
        path: Path,
        storage: str,
        files: Sequence[BlockFile],
        sources: Sequence[Path],
        metadata: BagMetadata | None,
        troubles: Sequence[str],
    ) -> None:
        """Put files together.

        Args:
            path: As it was asked for.
            storage: Of all files.
            files: In their order.
            sources: The same on the disk, where they may be compressed.
            metadata: What `metadata.yaml` says; None without one.
            troubles: What is damaged or missing beside what the files themselves say.
        """
        self.path, self.storage, self.metadata = path, storage, metadata
        told = [metadata.distro if metadata else "", *(one.distro for one in files)]
        self.distro = next((distro for distro in told if distro), "")
        self.files = tuple(sources)
        self._read = tuple(files)
        self.splits = _splits(files, sources)
        self._own_troubles = tuple(troubles)
        self._stamps = [stamp_of(one) for one in sources]
        self._channels = _chosen_channels(files)
        self._lock = threading.RLock()
        spans = [one.table.span_ns for one in files if len(one.table.begins_ns)]
        self._span_ns = (
            (min(begin for begin, _ in spans), max(end for _, end in spans)) if spans else (0, 0)
        )

    @classmethod
    def together(cls, bags: Sequence[Bag]) -> Bag:
        """Put bags together, at least one; closing this one closes their files."""
        first = bags[0]
        files = [file for one in bags for file in one._read]
        sources = [source for one in bags for source in one.files]
        troubles = [trouble for one in bags for trouble in one._own_troubles]
        made = cls(first.path, first.storage, files, sources, first.metadata, troubles)
        made.splits = tuple(
            sorted((split for one in bags for split in one.splits), key=lambda one: one.begin_ns)
        )
        return made

    @property
    def title(self) -> str:
        """Its name: that of the folder or of the file."""
        return self.path.name

    @property
    def size_bytes(self) -> int:
        """Of all its files on the disk."""
        return sum(stamp[1] for stamp in self._stamps if stamp)

    def changed_on_disk(self) -> bool:
        """Whether a file is another one than when it was opened."""
        return [stamp_of(one) for one in self.files] != self._stamps

    def close(self) -> None:
        """Give its files back; nothing may be asked of it afterwards."""
        for one in self._read:
            one.close()

    # What it is

    @property
    def begin_ns(self) -> int:
        """When the first message came; 0 without one."""
        return self._span_ns[0]

    @property
    def end_ns(self) -> int:
        """When the last message came; 0 without one."""
        return self._span_ns[1]

    @property
    def message_count(self) -> int:
        """Messages of all topics."""
        return sum(channel.count or 0 for one in self._read for channel in one.channels.values())

    @property
    def troubles(self) -> Sequence[str]:
        """What is damaged or left out, a sentence each."""
        return [*self._own_troubles, *(trouble for one in self._read for trouble in one.troubles)]

    @property
    def topics(self) -> Sequence[RecordedTopic]:
        """All topics by name."""
        with self._lock:
            return self._topics

    def topic(self, name: str) -> RecordedTopic | None:
        """Return a topic; None: there is none of that name."""
        with self._lock:
            return self._topics_by_name.get(name)

    @property
    def types(self) -> TypeLibrary:
        """Message types as the files define them; where they do not, as the studio does."""
        with self._lock:
            return self._types.library

    @cached_property
    def _types(self) -> BagTypes:
        definitions = [one for file in self._read for one in file.definitions]
        return types_of(definitions, self.distro)

    @cached_property
    def _topics(self) -> tuple[RecordedTopic, ...]:
        return tuple(self._topics_by_name.values())

    @cached_property
    def _topics_by_name(self) -> dict[str, RecordedTopic]:
        everywhere: dict[str, list[Channel]] = {}
        for file in self._read:
            for channel in file.channels.values():
                everywhere.setdefault(channel.topic, []).append(channel)
        return {name: self._topic(name, everywhere[name]) for name in sorted(self._channels)}

    def _topic(self, name: str, everywhere: Sequence[Channel]) -> RecordedTopic:
        chosen = self._channels[name]
        first = chosen[0][1]
        trouble = (
            self._types.trouble(first.type_name)
            if first.encoding == _CDR
            else f'Its messages are in the form "{first.encoding[:40]}", which is not read here.'
        )
        qos = {text: None for _, channel in chosen if (text := channel.qos_text)}
        return RecordedTopic(
            name,
            first.type_name,
            first.type_hash,
            tuple(profile for text in qos for profile in profiles_of(text)),
            sum(channel.count or 0 for _, channel in chosen),
            trouble,
            _note(everywhere, first.type_name),
            first.encoding,
        )

    def description(self) -> BagDescription:
        """Return what a `metadata.yaml` is to say of the files as they are."""
        old = self.metadata
        is_packed = any(one.name.endswith(".zstd") for one in self.files)
        is_by_message = any(one.compresses_messages for one in self._read)
        mode = "file" if is_packed else "message" if is_by_message else ""
        return BagDescription(
            self.storage,
            {one.name: _span_of(file) for one, file in zip(self.files, self._read, strict=True)},
            [(one, one.count) for one in self.topics],
            "zstd" if mode else "",
            mode,
            old.custom_data if old else {},
            self.distro,
        )

    # Messages

    def _outlines(self, topics: Iterable[str]) -> list[dict[int, Outline]]:
        """Return how the messages of some topics are handed out, by channel, for each file."""
        found: list[dict[int, Outline]] = [{} for _ in self._read]
        for topic in topics:
            for file, channel in self._channels.get(topic, ()):
                found[file][channel.key] = Outline(topic, gid_of(topic, channel.type_name))
        return found

    def latest(self, topics: Iterable[str], at_ns: int) -> dict[str, RawSample]:
        """Return the newest sample of each topic at or before a time."""
        found = {topic: self.last(topic, at_ns, 1, -(2**63)) for topic in topics}
        return {topic: samples[-1] for topic, samples in found.items() if samples}

    def last(self, topic: str, at_ns: int, most: int, since_ns: int = 0) -> list[RawSample]:
        """Return the newest samples in [since_ns, at_ns], at most so many, the oldest first."""
        if most < 1:
            return []
        found: list[tuple[int, RawSample]] = []
        outlines = self._outlines([topic])
        ranks = {i: rank for rank, i in enumerate(self._by_begin())}
        for i in self._backwards(at_ns):
            enough = len(found) >= most
            if self._read[i].table.span_ns[1] < (found[0][1].received_ns if enough else since_ns):
                continue
            more = queries.newest(self._read[i], outlines[i], at_ns, most, since_ns)
            if more:
                both = [*found, *((ranks[i], one) for one in more)]
                found = sorted(both, key=lambda one: (one[1].received_ns, one[0]))[-most:]
        return [sample for _, sample in found]

    def _backwards(self, at_ns: int) -> list[int]:
        """Return the files that begin by a time, the one that ends last first."""
        spans = [one.table.span_ns for one in self._read]
        begun = [i for i, (begin, _) in enumerate(spans) if begin <= at_ns]
        return sorted(begun, key=lambda i: (spans[i][1], i), reverse=True)

    def messages(self, topics: Iterable[str], begin_ns: int, end_ns: int) -> Iterator[Recorded]:
        """Yield the messages of some topics in [begin_ns, end_ns), in the order of their times."""
        outlines = self._outlines(topics)
        for group in self._groups():
            parts = [
                queries.messages(self._read[i], outlines[i], begin_ns, end_ns)
                for i in group
                if outlines[i]
            ]
            if len(parts) == 1:
                yield from parts[0]
            else:
                yield from heapq.merge(*parts, key=lambda one: one.sample.received_ns)

    def _by_begin(self) -> list[int]:
        """Return the files by time: of messages of one time, those of the first come first."""
        return sorted(range(len(self._read)), key=lambda i: (self._read[i].table.span_ns, i))

    def _groups(self) -> list[list[int]]:
        """Return the files by time; those that overlap stand together."""
        spans = [one.table.span_ns for one in self._read]
        groups: list[list[int]] = []
        end_ns = 0
        for i in self._by_begin():
            if groups and spans[i][0] <= end_ns:
                groups[-1].append(i)
            else:
                groups.append([i])
            end_ns = max(end_ns, spans[i][1])
        return groups

    def columns(
        self, topic: str, begin_ns: int, end_ns: int, *, every: int = 1
    ) -> Iterator[Columns]:
        """Yield the payloads of a topic in [begin_ns, end_ns), without an object for each message.

        Args:
            topic: A topic.
            begin_ns: When it begins.
            end_ns: When it ends.
            every: Of the parts of the files that hold the topic, one in so many is read: for a
                coarse picture of a long time. Their number is that of `part_count`.

        Yields:
            Times and payloads, part by part in the order of the files' times; parts may overlap.
        """
        for i, key, block in self._parts(topic, begin_ns, end_ns)[::every]:
            found = self._read[i].columns(block, key)
            if found is not None:
                first, last = np.searchsorted(found.times_ns, (begin_ns, end_ns), "left").tolist()
                if first < last:
                    yield Columns(
                        found.times_ns[first:last],
                        found.data,
                        found.offsets[first:last],
                        found.lengths[first:last],
                    )

    def part_count(self, topic: str, begin_ns: int, end_ns: int) -> int:
        """Return how many parts of the files hold a topic in [begin_ns, end_ns)."""
        return len(self._parts(topic, begin_ns, end_ns))

    def _parts(self, topic: str, begin_ns: int, end_ns: int) -> list[tuple[int, int, int]]:
        """Return file, channel and block of each part that may hold a topic, by their begins."""
        found: list[tuple[int, int, int, int]] = []
        for i, channel in self._channels.get(topic, ()):
            table = self._read[i].table
            presence = table.presence.get(channel.key)
            if presence is not None:
                near = (presence.begins_ns < end_ns) & (table.ends_ns[presence.blocks] >= begin_ns)
                pairs = zip(
                    presence.begins_ns[near].tolist(), presence.blocks[near].tolist(), strict=True
                )
                found += [(begin, i, channel.key, block) for begin, block in pairs]
        return [one[1:] for one in sorted(found)]

    # Times

    def next_ns(self, topic: str, after_ns: int) -> int | None:
        """Return the time of the first message of a topic after a time."""
        found = [
            queries.next_time(self._read[i], channel.key, after_ns)
            for i, channel in self._channels.get(topic, ())
            if self._read[i].table.span_ns[1] > after_ns
        ]
        return min((one for one in found if one is not None), default=None)

    def previous_ns(self, topic: str, before_ns: int) -> int | None:
        """Return the time of the last message of a topic before a time."""
        found = [
            queries.previous_time(self._read[i], channel.key, before_ns)
            for i, channel in self._channels.get(topic, ())
            if self._read[i].table.span_ns[0] < before_ns
        ]
        return max((one for one in found if one is not None), default=None)

    def counts(self, topic: str, begin_ns: int, end_ns: int, bins: int) -> NDArray[np.int64]:
        """Return how many messages of a topic lie in each of so many equal parts of a range.

        Raises:
            RecordingError: There are no such parts.
        """
        if not 0 < bins <= BINS_MAX or end_ns < begin_ns:
            raise RecordingError(f"There are no {bins} parts between {begin_ns} and {end_ns} ns.")
        edges = [begin_ns + (end_ns - begin_ns) * k // bins for k in range(bins + 1)]
        counts = np.zeros(bins, np.int64)
        for i, channel in self._channels.get(topic, ()):
            queries.add_counts(self._read[i], channel.key, edges, counts)
        return counts


def _splits(files: Sequence[BlockFile], sources: Sequence[Path]) -> tuple[Split, ...]:
    """Return where the files of one bag change; none begins before those that stand before it."""
    spans = [one.table.span_ns if len(one.table.begins_ns) else (0, 0) for one in files]
    begins_ns = itertools.accumulate((begin for begin, _ in spans), max)
    return tuple(
        Split(begin_ns, closed, opened)
        for begin_ns, (closed, opened) in zip(
            itertools.islice(begins_ns, 1, None), itertools.pairwise(sources), strict=True
        )
    )


def _note(channels: Sequence[Channel], type_name: str) -> str:
    """Return what is left out of a topic; empty: nothing."""
    others = [one for one in channels if one.type_name != type_name]
    if not others:
        return ""
    types = ", ".join(sorted({one.type_name or "none" for one in others}))
    count = sum(one.count or 0 for one in others)
    return f"{count} messages of other types are left out: {types}."


def _span_of(file: BlockFile) -> Span:
    count = sum(one.count or 0 for one in file.channels.values())
    return Span(count, *file.table.span_ns) if count else Span()


def gid_of(topic: str, type_name: str) -> bytes:
    """Return what names the sender of a topic's messages: a bag does not say who it was."""
    return hashlib.blake2b(f"{topic}\0{type_name}".encode(), digest_size=16).digest()


def _chosen_channels(files: Sequence[BlockFile]) -> dict[str, list[tuple[int, Channel]]]:
    """Return the channels of each topic with their files: those of the type of most messages."""
    by_topic: dict[str, dict[tuple[bool, str], list[tuple[int, Channel]]]] = {}
    for i, file in enumerate(files):
        for channel in file.channels.values():
            kinds = by_topic.setdefault(channel.topic, {})
            kind = (channel.encoding == _CDR, channel.type_name)
            kinds.setdefault(kind, []).append((i, channel))
    return {
        topic: max(
            kinds.items(), key=lambda one: (one[0][0], sum(c.count or 0 for _, c in one[1]))
        )[1]
        for topic, kinds in by_topic.items()
    }
