"""A file of SQLite as rosbag2 writes it, read in ranges of rows; nothing in it is trusted."""

from __future__ import annotations

import sqlite3
import threading
from itertools import islice
from typing import TYPE_CHECKING, Any, Final, cast
from urllib.parse import quote

import numpy as np

from studio.bags.blocks import (
    NO_ENTRIES,
    BlockTable,
    Channel,
    Columns,
    Definition,
    Entries,
)
from studio.bags.compression import PART_BYTES_MAX, decompressed_message
from studio.bags.recording import Recorded
from studio.errors import BagNotReadableError, DamagedPartError
from studio.files import is_there, stamp_of
from studio.ros.attachment import Attachment
from studio.ros.node.samples import RawSample

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
    from pathlib import Path

    from studio.bags.blocks import Outline, Scan
    from studio.bags.bounded_cache import BoundedCache

_BLOCK_ROWS: Final = 1_024
_BLOCK_BYTES: Final = 4 * 2**20
"""A block ends with the row that makes it larger."""
_ROWS_AT_ONCE: Final = 4_096
_GAPS_MAX: Final = 100
"""So many damaged parts of a table are passed over."""
_ROWS_MAX: Final = 2**40
_TOPICS_MAX: Final = 100_000
_DEFINITIONS_MAX: Final = 20_000
_TROUBLES_MAX: Final = 20
_NEEDED: Final = {
    "topics": {"id", "name", "type", "serialization_format"},
    "messages": {"topic_id", "timestamp", "data"},
}


class SqliteFile:
    """One `.db3` file; thread-safe.

    A block is a range of rows. Memory for the index is 40 bytes a block and 12 more for each topic
    in it: a block has 1,024 rows or 4 MB.

    Attributes:
        path: Where it lies.
        table: Its blocks.
        channels: By their keys.
        definitions: What it says about types, since version 4.
        distro: What recorded it; empty: it does not say.
    """

    def __init__(
        self,
        path: Path,
        indexes: BoundedCache[object],
        progress: Callable[[float], None] | None = None,
    ) -> None:
        """Open a file, and look through its rows without their data.

        Raises:
            BagNotReadableError: It is no such file, or nothing of it can be read.
        """
        self.path = path
        self.compresses_messages = False
        self._indexes = indexes
        self._troubles: list[str] = []
        self._lock = threading.RLock()
        self._stamp = stamp_of(path)
        self._database = self._connected()
        try:
            columns = self._checked()
            names = self._topics(columns["topics"])
            self.definitions: Sequence[Definition] = self._definitions(columns)
            self.distro = self._distro(columns)
            self._firsts, self._lasts, self.table, counts = self._blocks(progress)
        except sqlite3.Error as error:
            self._database.close()
            raise BagNotReadableError(str(path), f"it is damaged ({error})") from None
        except BagNotReadableError:
            self._database.close()
            raise
        self.channels: Mapping[int, Channel] = {
            key: Channel(key, *about, counts.get(key, 0)) for key, about in names.items()
        }

    @property
    def troubles(self) -> Sequence[str]:
        """What is damaged, a sentence each."""
        with self._lock:
            return list(self._troubles)

    def close(self) -> None:
        """Give the file back; nothing may be asked of it afterwards."""
        with self._lock:
            self._database.close()

    # Opening

    def _connected(self) -> sqlite3.Connection:
        """Open it for reading: with its write-ahead log, and where that cannot be, without.

        What a killed recorder left half done is not taken back, which would change the files.
        """
        place = f"file:{quote(str(self.path.resolve()))}"
        try:
            return self._tried(f"{place}?mode=ro")
        except sqlite3.Error as error:
            if is_there(self.path.with_name(f"{self.path.name}-wal")):
                self._tell(
                    f"{self.path.name}: its last messages are left out: they are in a log beside "
                    f"it that cannot be read ({error})."
                )
            elif is_there(self.path.with_name(f"{self.path.name}-journal")):
                self._tell(
                    f"{self.path.name}: it was not closed, so that some of its last messages may "
                    "be missing."
                )
        try:
            return self._tried(f"{place}?mode=ro&immutable=1")
        except sqlite3.Error as error:
            raise BagNotReadableError(str(self.path), f"it is no bag ({error})") from None

    def _tried(self, uri: str) -> sqlite3.Connection:
        database = sqlite3.connect(uri, uri=True, check_same_thread=False, isolation_level=None)
        try:
            database.text_factory = _text
            database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, PART_BYTES_MAX)
            database.setlimit(sqlite3.SQLITE_LIMIT_ATTACHED, 0)
            database.execute("PRAGMA trusted_schema=OFF")
            # Reads a file that is cut off, as far as it goes: nothing is written here anyway.
            database.execute("PRAGMA writable_schema=ON")
            database.execute("SELECT count(*) FROM sqlite_master").fetchone()
        except sqlite3.Error:
            database.close()
            raise
        return database

    def _checked(self) -> dict[str, set[str]]:
        """Return the columns of each table; views and virtual tables, which run code, are none.

        Raises:
            BagNotReadableError: It has other tables than a bag.
        """
        rows = self._database.execute(
            "SELECT name, sql FROM sqlite_master WHERE type='table' LIMIT 100"
        ).fetchall()
        plain = [
            str(name)
            for name, sql in rows
            if name in (*_NEEDED, "message_definitions", "schema") and _is_plain(str(sql))
        ]
        columns = {
            name: {
                str(row[1])
                for row in self._database.execute(f"PRAGMA table_info({name})").fetchall()
            }
            for name in plain
        }
        if any(not needed <= columns.get(name, set()) for name, needed in _NEEDED.items()):
            raise BagNotReadableError(str(self.path), "it is a database, and no bag")
        return columns

    def _topics(self, columns: set[str]) -> dict[int, tuple[str, str, str, str, str]]:
        """Return topic, type, form, hash and QoS by key."""
        more = [
            name if name in columns else "''"
            for name in ("type_description_hash", "offered_qos_profiles")
        ]
        rows = self._database.execute(
            f"SELECT id, name, type, serialization_format, {', '.join(more)} FROM topics LIMIT ?",
            (_TOPICS_MAX,),
        )
        found: dict[int, tuple[str, str, str, str, str]] = {}
        for key, *texts in rows:
            name, kind, form, type_hash, qos = (str(one or "") for one in texts)
            if isinstance(key, int):
                found[key] = (name, kind, form, type_hash, qos)
        return found

    def _definitions(self, columns: dict[str, set[str]]) -> list[Definition]:
        needed = {"topic_type", "encoding", "encoded_message_definition"}
        if not needed <= columns.get("message_definitions", set()):
            return []
        rows = self._database.execute(
            "SELECT topic_type, encoding, encoded_message_definition "
            "FROM message_definitions LIMIT ?",
            (_DEFINITIONS_MAX,),
        )
        return [Definition(*(str(one) for one in row)) for row in rows]

    def _distro(self, columns: dict[str, set[str]]) -> str:
        if "ros_distro" not in columns.get("schema", set()):
            return ""
        row = self._database.execute("SELECT ros_distro FROM schema LIMIT 1").fetchone()
        return str(row[0]) if row else ""

    def _blocks(
        self, progress: Callable[[float], None] | None
    ) -> tuple[list[int], list[int], BlockTable, dict[int, int]]:
        """Look through the rows: first and last row of each block, the table, and the counts."""
        made = _Blocks()
        size = max(1, self._stamp[1] if self._stamp else 1)
        begin: int | None = -(2**63)
        damage = ""
        for _ in range(_GAPS_MAX):
            try:
                for rows in self._rows(begin):
                    made.take(rows)
                    if progress is not None:
                        progress(min(1.0, made.bytes / size))
                break
            except sqlite3.Error as error:
                damage = str(error)
            made.close()
            begin = self._behind_damage(max(begin, made.last_row, 0))
            if begin is None:
                break
        made.close()
        if damage:
            count = sum(made.counts.values())
            self._tell(
                f"{self.path.name} is damaged ({damage}): {count} messages were found in it, "
                "others are lost."
            )
        return made.finished()

    def _rows(self, begin: int) -> Iterator[list[tuple[int, int, int, int]]]:
        """Yield the rows from one on, without their data; up to the first damage, which it raises.

        Raises:
            sqlite3.Error: A part of the table cannot be read.
        """
        cursor = self._database.execute(
            "SELECT rowid, topic_id, timestamp, length(data) FROM messages "
            "WHERE rowid >= ? ORDER BY rowid",
            (begin,),
        )
        rows: list[Any] = []
        is_going_on = True
        while is_going_on:
            try:
                rows.extend(islice(cursor, _ROWS_AT_ONCE))
                is_going_on = bool(rows)
            finally:
                yield [row for row in rows if all(isinstance(one, int) for one in row)]
            rows.clear()

    def _behind_damage(self, last: int) -> int | None:
        """Return from which row on the table can be read again; None: from none."""
        low, step = last, 1
        while step <= _ROWS_MAX and last < _ROWS_MAX:
            if self._is_readable(last + step):
                break
            low, step = last + step, step * 2
        else:
            return None
        high = last + step
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (low, middle) if self._is_readable(middle) else (middle, high)
        return high

    def _is_readable(self, row: int) -> bool:
        """Whether the table can be read from a row on, or ends before it."""
        try:
            self._database.execute(
                "SELECT rowid FROM messages WHERE rowid >= ? ORDER BY rowid LIMIT 1", (row,)
            ).fetchall()
        except sqlite3.Error:
            return False
        return True

    # What is in a block

    def entries(self, block: int, channel: int) -> Entries:
        """Return which messages of a channel lie in a block."""

        def made() -> tuple[object, int]:
            found = self._entries(block)
            return found, sum(one.times_ns.nbytes * 2 + 300 for one in found.values())

        found = cast("dict[int, Entries]", self._indexes.get((self.path, block), made))
        return found.get(channel, NO_ENTRIES)

    def _entries(self, block: int) -> dict[int, Entries]:
        rows = self._asked(
            "SELECT topic_id, timestamp, rowid FROM messages WHERE rowid BETWEEN ? AND ? "
            "ORDER BY rowid",
            (self._firsts[block], self._lasts[block]),
        )
        whole = [row for row in rows if all(isinstance(one, int) for one in row)]
        columns = np.array(whole, np.int64).reshape(-1, 3)
        columns = columns[np.lexsort((columns[:, 1], columns[:, 0]))]
        cuts = np.flatnonzero(np.diff(columns[:, 0])) + 1
        parts = np.split(columns, cuts) if len(columns) else []
        return {int(part[0, 0]): Entries(part[:, 1].copy(), part[:, 2].copy()) for part in parts}

    def _asked(self, line: str, values: tuple[int, ...]) -> list[tuple[object, ...]]:
        """Return the rows of a query; of one that meets damage, those before it.

        Raises:
            BagNotReadableError: The file was changed since it was opened.
        """
        found: list[tuple[object, ...]] = []
        with self._lock:
            try:
                found.extend(self._database.execute(line, values))
            except sqlite3.Error as error:
                if stamp_of(self.path) != self._stamp:
                    raise BagNotReadableError(
                        str(self.path), "it was changed while it was open; open it again"
                    ) from None
                self._tell(f"Messages of {self.path.name} are lost: it is damaged ({error}).")
        return found

    # Its messages

    def sample(self, block: int, channel: int, place: int, gid: bytes) -> RawSample | None:
        """Return one message; None: it is damaged."""
        del block
        rows = self._asked(
            "SELECT timestamp, data FROM messages WHERE rowid=? AND topic_id=?", (place, channel)
        )
        for at_ns, data in rows:
            return self._sample(at_ns, data, gid)
        return None

    def _sample(self, at_ns: object, data: object, gid: bytes) -> RawSample | None:
        if not isinstance(at_ns, int) or not isinstance(data, bytes):
            return None
        payload = data
        if self.compresses_messages:
            try:
                payload = decompressed_message(data)
            except DamagedPartError as error:
                self._tell(f"A message of {self.path.name} is left out: {error.reason}.")
                return None
        return RawSample(payload, Attachment(0, at_ns, gid), at_ns)

    def scanned(
        self,
        block: int,
        wanted: Mapping[int, Outline],
        *,
        keep: bool = True,
    ) -> Scan:
        """Return all messages of some channels in a block.

        Nothing is kept: the system keeps what was read last.
        """
        rows = self._of_block(block, list(wanted))
        found: list[Recorded] = []
        for key, at_ns, data in rows:
            outline = wanted.get(cast("int", key))
            sample = self._sample(at_ns, data, outline.gid) if outline else None
            if outline and sample:
                found.append(Recorded(outline.topic, sample))
        return _Scan(found)

    def _of_block(self, block: int, channels: Sequence[int]) -> list[tuple[object, ...]]:
        """Return the rows of a block, without those of other topics where few are wanted."""
        few = tuple(channels) if len(channels) <= 20 else ()
        only = f" AND topic_id IN ({','.join('?' * len(few))})" if few else ""
        return self._asked(
            "SELECT topic_id, timestamp, data FROM messages "
            f"WHERE rowid BETWEEN ? AND ?{only} ORDER BY rowid",
            (self._firsts[block], self._lasts[block], *few),
        )

    def columns(self, block: int, channel: int) -> Columns | None:
        """Return the payloads of a channel in a block; None: there are none, or it is damaged."""
        samples = [
            sample
            for _, at_ns, data in self._of_block(block, [channel])
            if (sample := self._sample(at_ns, data, b""))
        ]
        samples.sort(key=lambda one: one.received_ns)
        lengths = np.array([len(one.payload) for one in samples], np.int64)
        times_ns = np.array([one.received_ns for one in samples], np.int64)
        data = b"".join(one.payload for one in samples)
        return Columns(times_ns, data, np.cumsum(lengths) - lengths, lengths) if samples else None

    def _tell(self, sentence: str) -> None:
        with self._lock:
            if sentence not in self._troubles and len(self._troubles) < _TROUBLES_MAX:
                self._troubles.append(sentence)


def _text(data: bytes) -> str:
    """Return a text of the database; it need not be sound UTF-8."""
    return data.decode(errors="replace")


def _is_plain(sql: str) -> bool:
    """Whether a table has rows of its own, and computes none."""
    words = " ".join(sql.upper().split())
    return (
        words.startswith("CREATE TABLE") and " AS (" not in words and "WITHOUT ROWID" not in words
    )


class _Scan:
    """Messages of a block that were read; see `Scan`."""

    def __init__(self, found: Sequence[Recorded]) -> None:
        self._found = found
        self.times_ns = [sample.received_ns for _, sample in found]

    def made(self, numbers: Iterable[int]) -> Iterator[Recorded]:
        """Yield those."""
        return map(self._found.__getitem__, numbers)


class _Blocks:
    """Rows, put together into blocks."""

    def __init__(self) -> None:
        self.counts: dict[int, int] = {}
        self.bytes = 0
        self._blocks: list[tuple[int, int, int, int]] = []
        """First row, last row, begin and end of each."""
        self._pairs: list[tuple[int, int]] = []
        self.last_row = -(2**63)
        self._rows: list[tuple[int, int, int, int]] = []
        self._size = 0

    def take(self, rows: list[tuple[int, int, int, int]]) -> None:
        """Add rows: their number, topic, time and bytes."""
        for row in rows:
            self._rows.append(row)
            self.last_row = row[0]
            self._size += row[3]
            if len(self._rows) >= _BLOCK_ROWS or self._size >= _BLOCK_BYTES:
                self.close()

    def close(self) -> None:
        """End a block."""
        rows, self._rows = self._rows, []
        self.bytes, self._size = self.bytes + self._size, 0
        if not rows:
            return
        times = [row[2] for row in rows]
        for _, key, _, _ in rows:
            self.counts[key] = self.counts.get(key, 0) + 1
        self._pairs += [(key, len(self._blocks)) for key in {row[1] for row in rows}]
        self._blocks.append((rows[0][0], rows[-1][0], min(times), max(times)))

    def finished(self) -> tuple[list[int], list[int], BlockTable, dict[int, int]]:
        """Return first and last row of each block, numbered by their begins, with their table."""
        heads = np.array(self._blocks, np.int64).reshape(-1, 4)
        pairs = np.array(self._pairs, np.int64).reshape(-1, 2)
        order = np.lexsort((heads[:, 0], heads[:, 2]))
        numbers = np.empty(len(order), np.int32)
        numbers[order] = np.arange(len(order), dtype=np.int32)
        heads = heads[order]
        marks = np.zeros(len(pairs), np.int64)
        table = BlockTable.of(
            heads[:, 2], heads[:, 3], heads[:, 0], (pairs[:, 0], numbers[pairs[:, 1]], marks)
        )
        return heads[:, 0].tolist(), heads[:, 1].tolist(), table, self.counts
