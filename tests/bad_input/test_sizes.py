"""Files and robots far larger than usual: refused in a sentence, or opened whole and soon."""

from __future__ import annotations

import asyncio
import json
from typing import TYPE_CHECKING

import pytest

from studio.errors import UploadError
from studio.protocol.language import GetOutline
from tests.support.large_robots import robot_of_includes, robot_of_links
from tests.support.open_documents import engine, opened

if TYPE_CHECKING:
    from collections.abc import AsyncIterator
    from pathlib import Path

pytestmark = pytest.mark.timeout(240)

LARGE_BYTES = 50_000_000
GOOD = '<robot name="r"><link name="base"/></robot>'


def test_a_file_of_50_mb_is_named_and_not_read_and_the_next_one_opens(tmp_path: Path):
    large, good = tmp_path / "large.urdf", tmp_path / "good.urdf"
    large.write_text(f'<robot name="r"><!--{"x" * LARGE_BYTES}--><link name="base"/></robot>')
    good.write_text(GOOD)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, large)
            assert document.last_run.phase == "failed"
            (problem,) = ear.last("problems")["problems"]
            assert problem["sentence"] == f"The file {large} is larger than 20 MB and was not read."
            after, _ = await opened(made, good)
            assert list(after.model.robot.links) == ["base"]

    asyncio.run(run())


def test_an_upload_of_50_mb_is_refused_before_it_is_sent(tmp_path: Path):
    line = json.dumps([{"path": "large.urdf", "size": LARGE_BYTES}]).encode()

    async def nothing_is_read() -> AsyncIterator[bytes]:
        pytest.fail("it was read")
        yield b""

    async def run() -> None:
        async with engine(tmp_path) as made:
            with pytest.raises(UploadError, match=r"large\.urdf.* 20 MB"):
                await made.uploads.take(line, nothing_is_read())
            assert made.documents == {}
            uploads = tmp_path / "uploads"
            assert not uploads.exists() or not list(uploads.iterdir())

    asyncio.run(run())


@pytest.mark.sweep
def test_ten_thousand_links_open_and_one_of_them_can_be_edited(tmp_path: Path):
    path = robot_of_links(tmp_path, 10_000)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, path)
            assert document.last_run.phase == "ready"
            assert len(document.model.robot.links) == 10_000
            last = next(one for one in ear.sites().values() if one["text"] == "99 99 0")
            await document.edits.edit_site(last["id"], "0 0 2", "")
            assert document.model.robot.joints["j9999"].origin.xyz == (0, 0, 2)
            await document.edits.undo()
            assert not document.has_unsaved

    asyncio.run(run())


def test_a_thousand_includes_are_read_listed_and_edited(tmp_path: Path):
    path = robot_of_includes(tmp_path, 1_000)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, path)
            assert len(document.model.robot.links) == 1_001
            assert len(document.sources.files) == 1_001
            await made.execute(GetOutline(document=document.id), ear)
            assert len(ear.last("outline")["outline"]["files"]) == 1_001
            await document.edits.edit_site(ear.site("size_999")["id"], "0.7", "")
            assert document.sources.unsaved_files == (str(path.parent / "parts/part_999.xacro"),)

    asyncio.run(run())
