"""BagWriter: writes a rosbag2 folder of which all but the last moment is whole at any time."""

from __future__ import annotations

import contextlib
import errno
import os
import shutil
import time
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, Literal, NoReturn, TypeAlias

import zstandard

from studio.bags.definition_text import definition_text
from studio.bags.mcap_writer import Chunking, McapWriter
from studio.bags.metadata_text import (
    METADATA_NAME,
    BagDescription,
    Span,
    information_text,
    metadata_text,
)
from studio.bags.sqlite_writer import SqliteWriter
from studio.errors import BagNotWrittenError, SettingsError
from studio.files import is_there, temporary_beside, write_whole
from studio.ros.duration import NANOSECONDS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from pathlib import Path
    from typing import Self

    from studio.bags.recording import RecordedTopic
    from studio.bags.storage_file import StorageFile
    from studio.ros.node.samples import RawSample
    from studio.ros.types.library import TypeLibrary

Storage: TypeAlias = Literal["mcap", "sqlite3"]
CompressionMode: TypeAlias = Literal["none", "file", "message"]
STORAGES: Final[tuple[Storage, ...]] = ("mcap", "sqlite3")
FLOOR_BYTES: Final = 64 * 1024 * 1024
"""Left free on the disk: who fills it up takes the room of all other programs."""
_SUFFIXES: Final[Mapping[Storage, str]] = {"mcap": "mcap", "sqlite3": "db3"}
_SPLIT_MIN: Final[Mapping[Storage, int]] = {"mcap": 1_024, "sqlite3": 86_016}
_LOOK_EVERY_BYTES: Final = 8 * 1024 * 1024
"""Between two looks at the room on the disk."""
_FLUSH_EVERY_S: Final = 2.0
"""A killed process loses no more of a slow topic than this."""
_DESCRIBE_EVERY_S: Final = 5.0
_FULL: Final = frozenset({errno.ENOSPC, errno.EFBIG, errno.EDQUOT})


@dataclass(frozen=True, slots=True)
class Storing:
    """How a bag is written; the words are those of `ros2 bag record`.

    Attributes:
        storage: The form of its files.
        chunking: Of .mcap files.
        mode: What is compressed by zstd: whole files, or each message; none beside chunks.
        max_bytes: Another file begins after so many; 0: never.
        max_s: Another file begins after so long; 0: never.
        max_files: The oldest file is removed where there are more; 0: never.
        resilient: A loss of power is to harm a .db3 file no more than a killed process does.
        custom_data: Kept in the metadata.
        floor_bytes: Left free on the disk.
    """

    storage: Storage = "mcap"
    chunking: Chunking = field(default_factory=Chunking)
    mode: CompressionMode = "none"
    max_bytes: int = 0
    max_s: float = 0.0
    max_files: int = 0
    resilient: bool = False
    custom_data: Mapping[str, str] = field(default_factory=dict[str, str])
    floor_bytes: int = FLOOR_BYTES

    def check(self) -> None:
        """Check that these go together.

        Raises:
            SettingsError: They do not.
        """
        least = _SPLIT_MIN[self.storage]
        if self.max_bytes and self.max_bytes < least:
            raise SettingsError(
                f"A bag of {self.storage} splits at {least} bytes or more: "
                f"{self.max_bytes} is too little."
            )
        if self.mode == "message" and self.storage == "mcap":
            raise SettingsError(
                "rosbag2 reads no mcap whose messages are compressed one by one: give "
                "--storage-preset-profile zstd_fast, which compresses chunks, or -s sqlite3."
            )
        if self.max_files and not (self.max_bytes or self.max_s):
            raise SettingsError(
                "A number of files is kept where a bag is split: give --max-bag-size or "
                "--max-bag-duration, too."
            )


@dataclass(frozen=True, slots=True)
class Written:
    """A bag that was written."""

    path: Path
    messages: int
    bytes: int
    begin_ns: int
    """Since the Unix epoch, 0 without messages."""
    end_ns: int


@dataclass(frozen=True, slots=True)
class _Done:
    """A file that is complete: its name, and what is in it."""

    name: str
    span: Span
    counts: Mapping[int, int]
    bytes: int


class BagWriter:
    """Writes a new bag; used by one thread at a time.

    There is a `metadata.yaml` from the beginning, which is brought up to date every few seconds
    and with each file. Its methods raise a BagNotWrittenError where the disk refuses to go on: what
    was written until then is whole, and the writer is closed.

    Raises:
        BagNotWrittenError: There is something at the path, or no folder can be made there.
        SettingsError: What is asked for does not go together.
    """

    def __init__(self, folder: Path, types: TypeLibrary, storing: Storing | None = None) -> None:
        self._how = storing or Storing()
        self._how.check()
        self._folder, self._types = folder.absolute(), types
        self._topics: dict[int, tuple[RecordedTopic, str]] = {}
        """Each topic with the text of its type."""
        self._done: list[_Done] = []
        self._removed = Counter[int]()
        """Messages of each topic in files that were removed."""
        self._number = 0
        self._begun_ns: int | None = None
        """When the first message of the present file came."""
        self._unlooked_bytes = 0
        self._flushed_s = self._described_s = time.monotonic()
        self._is_closed = False
        self.on_split: Callable[[Path, Path], object] = _nothing
        """Called with the file that is complete and the one that begins, by who writes."""
        self._file: StorageFile | None = None
        try:
            self._make_folder()
        except OSError as error:
            raise self._refusal(error) from error
        try:
            self._check_room()
            self._file = self._opened()
            self._describe()
        except OSError as error:
            self.abandon()
            shutil.rmtree(self._folder, ignore_errors=True)
            raise self._refusal(error) from error

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def path(self) -> Path:
        """Its folder."""
        return self._folder

    @property
    def size(self) -> int:
        """Bytes that it takes, those that wait to be written among them."""
        return sum(one.bytes for one in self._done) + (self._file.size if self._file else 0)

    def count(self, number: int) -> int:
        """Return how many messages of a topic it holds; some that wait may be left out."""
        present = self._file.counts.get(number, 0) if self._file else 0
        return sum(one.counts.get(number, 0) for one in self._done) + present

    def add_topic(self, topic: RecordedTopic) -> int:
        """Announce a topic; return the number by which its messages are written."""
        number = len(self._topics) + 1
        definition = definition_text(self._types, topic.type_name, topic.type_hash)
        self._topics[number] = topic, definition
        try:
            self._present().add_topic(number, topic, definition)
        except OSError as error:
            self._end(error)
        return number

    def taken(self, number: int) -> int:
        """Return how many messages of a topic it took, those of removed files among them."""
        return self.count(number) + self._removed[number]

    def write(self, number: int, sample: RawSample) -> None:
        """Add a message; its time is that of its reception."""
        try:
            self._unlooked_bytes += len(sample.payload)
            if self._unlooked_bytes >= _LOOK_EVERY_BYTES:
                self._unlooked_bytes = 0
                self._check_room()
            if self._is_to_be_split(sample.received_ns):
                self._split()
            if self._begun_ns is None:
                self._begun_ns = sample.received_ns
            self._present().write(number, sample)
        except OSError as error:
            self._end(error)

    def tend(self) -> None:
        """Write what has waited for a while; to be called a few times in a second."""
        now_s = time.monotonic()
        if now_s - self._flushed_s < _FLUSH_EVERY_S:
            return
        self._flushed_s = now_s
        try:
            self._check_room()
            self._present().flush()
            if now_s - self._described_s >= _DESCRIBE_EVERY_S:
                self._described_s = now_s
                self._describe()
        except OSError as error:
            self._end(error)

    def split(self) -> None:
        """Begin another file; the present one is whole then."""
        try:
            self._split()
        except OSError as error:
            self._end(error)

    def close(self) -> Written:
        """Complete the bag; again returns the same."""
        if not self._is_closed:
            self._is_closed = True
            try:
                self._end_file()
                self._describe()
            except OSError as error:
                self._end(error)
        span = _whole(self._done)
        size = sum(one.bytes for one in self._done)
        begin_ns = span.begin_ns if span.count else 0
        return Written(self._folder, span.count, size, begin_ns, span.end_ns)

    def abandon(self) -> None:
        """Let go of the bag as it is; harmless where it is complete."""
        self._is_closed = True
        if self._file is not None:
            self._file.abandon()
            self._file = None

    def _end(self, error: OSError) -> NoReturn:
        """Complete the bag as far as can be, and raise why it goes no further."""
        self._is_closed = is_whole = True
        for step in (self._end_file, self._describe):
            try:
                step()
            except OSError:
                is_whole = False
        raise self._refusal(error, is_whole=is_whole) from error

    def _refusal(self, error: OSError, *, is_whole: bool = False) -> BagNotWrittenError:
        reason = error.strerror or str(error)
        if is_whole:
            reason += ". What was written before is whole"
        if error.errno in _FULL:
            reason += ": free some room, and record on into another bag"
        return BagNotWrittenError(str(self._folder), f"{reason}.")

    def _make_folder(self) -> None:
        """Make the folder.

        Raises:
            OSError: There is something of that name, or it cannot be made.
        """
        if is_there(self._folder):
            raise FileExistsError(
                errno.EEXIST, "there is something of that name already: give another name"
            )
        self._folder.mkdir(parents=True)

    def _check_room(self) -> None:
        """Check that the disk has room.

        Raises:
            OSError: Less is free than has to be left.
        """
        floor = self._how.floor_bytes
        if shutil.disk_usage(self._folder).free < floor:
            raise OSError(
                errno.ENOSPC, f"the disk is full, of which {floor / 1e6:.0f} MB are left free"
            )

    def _present(self) -> StorageFile:
        """Return the file that is written.

        Raises:
            OSError: The bag is closed.
        """
        if self._file is None:
            raise OSError(errno.EBADF, "it is closed")
        return self._file

    def _is_to_be_split(self, at_ns: int) -> bool:
        how = self._how
        if how.max_bytes and self._present().size >= how.max_bytes:
            return True
        if not how.max_s:
            return False
        begun_ns = self._begun_ns
        return begun_ns is not None and at_ns - begun_ns >= how.max_s * NANOSECONDS

    def _split(self) -> None:
        self._end_file()
        self._begun_ns = None
        self._number += 1
        self._file = self._opened()
        for number, (topic, definition) in self._topics.items():
            self._file.add_topic(number, topic, definition)
        closed = self._folder / self._done[-1].name
        self._remove_oldest()
        self._describe()
        self.on_split(closed, self._folder / self._name)

    def _opened(self) -> StorageFile:
        how = self._how
        path = self._folder / self._name
        if how.storage == "mcap":
            return McapWriter(path, how.chunking)
        is_each = how.mode == "message"
        return SqliteWriter(path, self._types.distro, compresses=is_each, resilient=how.resilient)

    @property
    def _name(self) -> str:
        """The name of the present file."""
        return f"{self._folder.name}_{self._number}.{_SUFFIXES[self._how.storage]}"

    def _end_file(self) -> None:
        """Complete the present file, if there is one."""
        file = self._file
        if file is None:
            return
        path = self._folder / self._name
        try:
            file.close(lambda: information_text(self._description()))
            if self._how.mode == "file":
                path = _compressed(path)
        finally:
            self._file = None
            self._done.append(_Done(path.name, file.span, file.counts, path.stat().st_size))

    def _remove_oldest(self) -> None:
        most = self._how.max_files
        while most and len(self._done) >= most:
            oldest = self._done.pop(0)
            self._removed.update(oldest.counts)
            (self._folder / oldest.name).unlink(missing_ok=True)

    def _describe(self) -> None:
        text = metadata_text(self._description())
        write_whole(self._folder / METADATA_NAME, text.encode())

    def _description(self) -> BagDescription:
        files = {one.name: one.span for one in self._done}
        if self._file is not None:
            files[self._name] = self._file.span
        mode = self._how.mode
        return BagDescription(
            storage=self._how.storage,
            files=files,
            topics=[(topic, self.count(number)) for number, (topic, _) in self._topics.items()],
            compression_format="" if mode == "none" else "zstd",
            compression_mode="" if mode == "none" else mode.upper(),
            custom_data=self._how.custom_data,
            distro=self._types.distro,
        )


def _nothing(_closed: Path, _opened: Path) -> None:
    """Do nothing: the default of `on_split`."""


def _whole(files: Iterable[_Done]) -> Span:
    whole = Span()
    for one in files:
        whole.join(one.span)
    return whole


def _compressed(path: Path) -> Path:
    """Put a file in zstd in the place of a file; return its path.

    Raises:
        OSError: The disk refuses it; the file is still there.
    """
    target = path.with_name(f"{path.name}.zstd")
    handle, temporary = temporary_beside(target, 0o666)
    try:
        with path.open("rb") as source, os.fdopen(handle, "wb") as sink:
            zstandard.ZstdCompressor(level=1).copy_stream(source, sink, size=path.stat().st_size)
        temporary.replace(target)
    except OSError:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)
        raise
    path.unlink()
    return target
