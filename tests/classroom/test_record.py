from __future__ import annotations

import asyncio
import stat
from typing import TYPE_CHECKING

import pytest

from studio.classroom.record import ClassFile, ClassRecord, MemberRecord
from studio.errors import DataFolderError

if TYPE_CHECKING:
    from pathlib import Path

RECORD = ClassRecord(
    open=True, members=(MemberRecord(person="1", name="Ada <b>", role="helper", removed=True),)
)


def test_what_is_kept_is_read_again_and_only_its_owner_may_read_it(tmp_path: Path):
    path = tmp_path / "class.json"
    asyncio.run(ClassFile(path).keep(lambda: RECORD))
    assert ClassFile(path).read() == RECORD
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    asyncio.run(ClassFile(path).delete())
    assert list(tmp_path.iterdir()) == []


def test_many_who_ask_at_once_cost_few_writes(tmp_path: Path):
    made = 0

    def record() -> ClassRecord:
        nonlocal made
        made += 1
        return RECORD

    async def run() -> None:
        file = ClassFile(tmp_path / "class.json")
        await asyncio.gather(*(file.keep(record) for _ in range(100)))

    asyncio.run(run())
    assert made <= 3


@pytest.mark.parametrize("text", ["", "{", "[]", '{"members": 5}', "\0" * 100])
def test_a_broken_file_begins_a_new_class(tmp_path: Path, text: str):
    path = tmp_path / "class.json"
    path.write_text(text)
    read = ClassFile(path).read()
    assert (read.open, read.members) == (False, ())


def test_a_disk_that_refuses_is_said(tmp_path: Path):
    with pytest.raises(DataFolderError):
        asyncio.run(ClassFile(tmp_path / "no folder" / "class.json").keep(lambda: RECORD))


def test_without_a_file_nothing_is_kept(tmp_path: Path):
    asyncio.run(ClassFile(None).keep(lambda: RECORD))
    assert ClassFile(None).read().members == ()
    assert list(tmp_path.iterdir()) == []
