"""Files of SQLite: those of every release, damaged, hostile and changed while they are open."""

from __future__ import annotations

import os
import sqlite3
from contextlib import closing
from typing import TYPE_CHECKING

import pytest
import zstandard

from studio.bags.compression import PART_BYTES_MAX
from studio.bags.opening import open_bag
from studio.errors import BagNotReadableError
from tests.support.bag_oracle import write_rosbags
from tests.support.bags import BEGIN_NS, string_cdr
from tests.support.damaged_bags import overwrite
from tests.support.read_bags import all_of, read_bag

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

FOXY = """
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
  serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,
  timestamp INTEGER NOT NULL, data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
"""
"""The tables until Humble; Dashing's had no offered_qos_profiles."""
PAGE = 4_096
DASHING = FOXY.replace(", offered_qos_profiles TEXT NOT NULL", "")
STRING_ROW = "INSERT INTO topics(id, name, type, serialization_format{}) VALUES(?, ?, ?, 'cdr'{})"


def write_rows(file: Path, rows: list[tuple[int, object, object]], tables: str = FOXY) -> Path:
    """Write a file with `/a` as 1, `/b` as 2; rows are topic, ns from `BEGIN_NS`, data."""
    with closing(sqlite3.connect(file)) as database, database:
        database.executescript(tables)
        more = (", offered_qos_profiles", ", ''") if "offered" in tables else ("", "")
        for key, name in ((1, "/a"), (2, "/b")):
            database.execute(STRING_ROW.format(*more), (key, name, "std_msgs/msg/String"))
        for key, at, data in rows:
            at_ns = BEGIN_NS + at if isinstance(at, int) else at
            database.execute(
                "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
                (key, at_ns, data),
            )
    return file


def _many(count: int = 5_000) -> list[tuple[int, object, object]]:
    return [(1 + n % 2, n, string_cdr(f"text {n}")) for n in range(count)]


def _read_as(rows: list[tuple[int, object, object]]) -> list[tuple[str, int, object]]:
    return [
        ("/a" if key == 1 else "/b", BEGIN_NS + n, data) for n, (key, _, data) in enumerate(rows)
    ]


@pytest.mark.parametrize("tables", [FOXY, DASHING])
def test_a_file_of_an_old_release_is_read(tmp_path: Path, tables: str):
    rows = _many(3_000)
    found = read_bag(write_rows(tmp_path / "a.db3", rows, tables), tmp_path / "kept")
    assert found.messages == _read_as(rows)
    assert not found.troubles
    assert {name: one.count for name, one in found.topics.items()} == {"/a": 1_500, "/b": 1_500}
    assert not any(one.trouble for one in found.topics.values())


def test_a_row_that_is_no_message_is_left_out(tmp_path: Path):
    rows: list[tuple[int, object, object]] = [
        (1, 0, string_cdr("first")),
        (1, 1, "a text in the place of bytes"),
        (1, 2, b""),
        (1, "now", string_cdr("no time")),
        (77, 3, string_cdr("no topic")),
        (2, 4, string_cdr("last")),
    ]
    found = read_bag(write_rows(tmp_path / "a.db3", rows), tmp_path / "kept")
    assert found.messages == [
        ("/a", BEGIN_NS, string_cdr("first")),
        ("/a", BEGIN_NS + 2, b""),
        ("/b", BEGIN_NS + 4, string_cdr("last")),
    ]


@pytest.mark.parametrize(
    "tables",
    [
        "CREATE TABLE people(name TEXT);",
        FOXY.split(";", maxsplit=1)[0] + ";",
        FOXY.replace("timestamp INTEGER NOT NULL, data", "data").split("CREATE INDEX")[0],
        FOXY.split("CREATE TABLE messages", maxsplit=1)[0]
        + "CREATE VIEW messages AS SELECT 1 AS topic_id, 2 AS timestamp, x'00' AS data;",
        FOXY.replace("data BLOB NOT NULL", "data BLOB AS (zeroblob(1000000000))"),
        FOXY.replace("data BLOB NOT NULL)", "data BLOB NOT NULL) WITHOUT ROWID"),
    ],
)
def test_a_database_that_is_no_bag_or_computes_its_rows_is_refused(tmp_path: Path, tables: str):
    with closing(sqlite3.connect(tmp_path / "a.db3")) as database:
        database.executescript(tables)
    with pytest.raises(BagNotReadableError, match="a database, and no bag"):
        open_bag(tmp_path / "a.db3", kept_in=tmp_path / "kept")


@pytest.mark.parametrize("data", [b"", b"rubbish" * 1_000, b"SQLite format 3\0" + bytes(4_000)])
def test_a_file_that_is_no_database_is_refused_with_its_name(tmp_path: Path, data: bytes):
    (tmp_path / "a.db3").write_bytes(data)
    with pytest.raises(BagNotReadableError, match=r"a\.db3"):
        open_bag(tmp_path / "a.db3", kept_in=tmp_path / "kept")


@pytest.mark.parametrize("texts", [["text 0"], ["text 2500"], ["text 1000", "text 4000"]])
def test_a_damaged_page_costs_its_own_messages(tmp_path: Path, texts: list[str]):
    rows = _many()
    file = write_rows(tmp_path / "a.db3", rows)
    whole, lost = file.read_bytes(), 0
    for text in texts:
        page = whole.index(string_cdr(text)) // PAGE * PAGE
        lost += int.from_bytes(whole[page + 3 : page + 5], "big")  # rows, as its head says
        overwrite(file, page, b"\xff" * PAGE)
    bag = open_bag(file, kept_in=tmp_path / "kept")
    read = all_of(bag)
    kept = set(read)
    # The module of SQLite drops the row before a page that it cannot read.
    assert 0 < lost <= len(rows) - len(read) <= lost + len(texts)
    assert bag.message_count == len(read)
    assert read == [one for one in _read_as(rows) if one in kept]
    on_a = [data for topic, _, data in read if topic == "/a"]
    assert [one.payload for one in bag.last("/a", 2**62, 10_000)] == on_a
    assert int(bag.counts("/a", 0, 2**62, 7).sum()) == len(on_a)
    assert f"{len(read)} messages were found in it, others are lost" in bag.troubles[0]
    bag.close()


def test_what_a_killed_recorder_left_in_its_log_is_read(tmp_path: Path):
    file = write_rows(tmp_path / "a.db3", _many(10))
    with closing(sqlite3.connect(file)) as database:
        database.execute("PRAGMA journal_mode=WAL")
        database.execute(
            "INSERT INTO messages(topic_id, timestamp, data) VALUES(1, ?, ?)",
            (BEGIN_NS + 10, string_cdr("in the log")),
        )
        database.commit()
        for name in ("a.db3", "a.db3-wal", "a.db3-shm"):
            (tmp_path / "copy").mkdir(exist_ok=True)
            (tmp_path / "copy" / name).write_bytes((tmp_path / name).read_bytes())
    found = read_bag(tmp_path / "copy" / "a.db3", tmp_path / "kept")
    assert found.messages[-1] == ("/a", BEGIN_NS + 10, string_cdr("in the log"))
    assert not found.troubles


def test_a_transaction_that_was_never_ended_costs_none_before_it_and_is_told(tmp_path: Path):
    rows = _many(2_000)
    file = write_rows(tmp_path / "a.db3", rows)
    (tmp_path / "copy").mkdir()
    with closing(sqlite3.connect(file, isolation_level=None)) as database:
        database.execute("PRAGMA cache_size=2")  # so that it is written before it ends
        database.execute("BEGIN")
        database.executemany(
            "INSERT INTO messages(topic_id, timestamp, data) VALUES(1, ?, ?)",
            [(BEGIN_NS + 10**6 + n, bytes(200)) for n in range(3_000)],
        )
        for one in tmp_path.glob("a.db3*"):
            (tmp_path / "copy" / one.name).write_bytes(one.read_bytes())
    before = {one: one.read_bytes() for one in (tmp_path / "copy").iterdir()}
    assert len(before) == 2
    found = read_bag(tmp_path / "copy" / "a.db3", tmp_path / "kept")
    assert found.messages[: len(rows)] == _read_as(rows)
    assert "it was not closed" in found.troubles[0]
    assert {one: one.read_bytes() for one in (tmp_path / "copy").iterdir()} == before


def _grow(file: Path) -> None:
    with closing(sqlite3.connect(file)) as database, database:
        database.execute(
            "INSERT INTO messages(topic_id, timestamp, data) VALUES(1, ?, ?)",
            (BEGIN_NS + 10**9, b"new"),
        )


def _replace(file: Path) -> None:
    write_rows(file.with_name("other.db3"), _many(3)).replace(file)


def _delete(file: Path) -> None:
    file.unlink()


@pytest.mark.parametrize("change", [_grow, _replace, _delete])
def test_what_was_there_when_it_was_opened_is_read_on(
    tmp_path: Path, change: Callable[[Path], None]
):
    rows = _many()
    file = write_rows(tmp_path / "a.db3", rows)
    bag = open_bag(file, kept_in=tmp_path / "kept")
    change(file)
    assert bag.changed_on_disk()
    assert [one[2] for one in all_of(bag)] == [row[2] for row in rows]
    bag.close()


@pytest.mark.parametrize("size", [0, 4_096, 40_000])
def test_a_file_truncated_while_it_is_open_is_said_to_be_changed(tmp_path: Path, size: int):
    file = write_rows(tmp_path / "a.db3", [(1, n, bytes(2_000)) for n in range(5_000)])
    bag = open_bag(file, kept_in=tmp_path / "kept")
    os.truncate(file, size)
    with pytest.raises(BagNotReadableError, match="changed while it was open"):
        all_of(bag)
    bag.close()


def test_a_topic_of_two_types_is_that_of_most_messages(tmp_path: Path):
    file = write_rows(tmp_path / "a.db3", _many(9))
    with closing(sqlite3.connect(file)) as database, database:
        database.execute("UPDATE topics SET name='/a', type='std_msgs/msg/Empty' WHERE id=2")
    found = read_bag(file, tmp_path / "kept")
    assert [data for _, _, data in found.messages] == [
        string_cdr(f"text {n}") for n in range(0, 9, 2)
    ]
    assert found.topics["/a"].type_name == "std_msgs/msg/String"
    assert "4 messages of other types are left out: std_msgs/msg/Empty" in found.topics["/a"].note


def test_a_message_that_unpacks_to_too_much_costs_itself(tmp_path: Path):
    told = [("/a", BEGIN_NS + n, string_cdr(str(n))) for n in range(9)]
    folder = write_rosbags(tmp_path / "bag", told, "sqlite3, messages")
    (file,) = folder.glob("*.db3")
    bomb = zstandard.compress(bytes(PART_BYTES_MAX + 1))
    with closing(sqlite3.connect(file)) as database, database:
        database.execute("UPDATE messages SET data=? WHERE timestamp=?", (bomb, BEGIN_NS + 4))
        database.execute("UPDATE messages SET data=? WHERE timestamp=?", (b"rub", BEGIN_NS + 5))
    found = read_bag(folder, tmp_path / "kept")
    assert found.messages == told[:4] + told[6:]
    assert ["a message would take more than" in one for one in found.troubles] == [True, False]
    assert ["no frame of zstd" in one for one in found.troubles] == [False, True]
    bag = open_bag(folder, kept_in=tmp_path / "kept")
    assert [one.payload for one in bag.last("/a", BEGIN_NS + 6, 3)] == [
        string_cdr(text) for text in "236"
    ]
    assert bag.latest(["/a"], BEGIN_NS + 5)["/a"].payload == string_cdr("3")
    bag.close()
