"""SqliteWriter: a .db3 file as rosbag2 writes it, in transactions that are whole once they end."""

from __future__ import annotations

import contextlib
import errno
import sqlite3
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

import zstandard

from studio.bags.metadata_text import VERSION, Span, qos_text

if TYPE_CHECKING:
    from collections.abc import Callable, Generator
    from pathlib import Path

    from studio.bags.recording import RecordedTopic
    from studio.ros.node.samples import RawSample

_TRANSACTION_BYTES: Final = 4 * 1024 * 1024
_TABLES: Final = """
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
CREATE TABLE metadata(
  id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);
CREATE TABLE topics(
  id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
  serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL,
  type_description_hash TEXT NOT NULL);
CREATE TABLE message_definitions(
  id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding TEXT NOT NULL,
  encoded_message_definition TEXT NOT NULL, type_description_hash TEXT NOT NULL);
CREATE TABLE messages(
  id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,
  data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
"""
_SCHEMA_VERSION: Final = 4
_RESILIENT: Final = "PRAGMA synchronous=NORMAL"
_QUICK: Final = "PRAGMA synchronous=OFF"
"""The system keeps what this process wrote, also if it is killed; a loss of power may cost it."""


class SqliteWriter:
    """Writes a new file; see `StorageFile`.

    The journal is a file beside it: what a killed process left half done is taken back by whoever
    opens it next.
    """

    def __init__(
        self, path: Path, distro: str, *, compresses: bool = False, resilient: bool = False
    ) -> None:
        path.touch(exist_ok=False)
        self._path = path
        self._compress = zstandard.ZstdCompressor(level=1).compress if compresses else None
        self._database = sqlite3.connect(path, check_same_thread=False)
        with self._transaction() as database:
            database.execute(_RESILIENT if resilient else _QUICK)
            database.executescript(_TABLES)
            database.execute("INSERT INTO schema VALUES(?, ?)", (_SCHEMA_VERSION, distro))
        self._types: set[str] = set()
        self._waiting: list[tuple[int, int, bytes]] = []
        self._waiting_bytes = 0
        self._size = path.stat().st_size
        self.span = Span()
        self.counts: dict[int, int] = {}

    @property
    def size(self) -> int:
        """Bytes, those that wait to be written among them."""
        return self._size + self._waiting_bytes

    def add_topic(self, number: int, topic: RecordedTopic, definition: str) -> None:
        """Announce a topic."""
        kind = topic.type_name
        with self._transaction() as database:
            database.execute(
                "INSERT INTO topics VALUES(?, ?, ?, 'cdr', ?, ?)",
                (number, topic.name, kind, qos_text(topic.qos), topic.type_hash),
            )
            if definition and kind not in self._types:
                database.execute(
                    "INSERT INTO message_definitions(topic_type, encoding,"
                    " encoded_message_definition, type_description_hash)"
                    " VALUES(?, 'ros2msg', ?, ?)",
                    (kind, definition, topic.type_hash),
                )
        self._types.add(kind)
        self.counts[number] = 0

    def write(self, number: int, sample: RawSample) -> None:
        """Add a message."""
        payload, _, at_ns = sample
        if self._compress is not None:
            payload = self._compress(payload)
        self._waiting.append((number, at_ns, payload))
        self._waiting_bytes += len(payload)
        if self._waiting_bytes >= _TRANSACTION_BYTES:
            self.flush()

    def flush(self) -> None:
        """Write what waits in one transaction."""
        if not self._waiting:
            return
        with self._transaction() as database:
            database.executemany(
                "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", self._waiting
            )
        waiting, self._waiting, self._waiting_bytes = self._waiting, [], 0
        self._size = self._path.stat().st_size
        for number, at_ns, _ in waiting:
            self.span.add(at_ns)
            self.counts[number] += 1

    def close(self, information: Callable[[], str]) -> None:
        """Write what waits, and what the file holds; on a full disk it goes without."""
        try:
            with contextlib.suppress(OSError):
                self.flush()
            with contextlib.suppress(OSError), self._transaction() as database:
                database.execute(
                    "INSERT INTO metadata(metadata_version, metadata) VALUES(?, ?)",
                    (VERSION, information()),
                )
        finally:
            self._database.close()

    def abandon(self) -> None:
        """Let go of the file as it is."""
        self._database.close()

    @contextmanager
    def _transaction(self) -> Generator[sqlite3.Connection]:
        """Write all that is done within, or nothing of it.

        Raises:
            OSError: The disk refuses it.
        """
        try:
            with self._database:
                yield self._database
        except sqlite3.Error as error:
            is_full = error.sqlite_errorcode == sqlite3.SQLITE_FULL
            raise OSError(errno.ENOSPC if is_full else errno.EIO, str(error)) from error
