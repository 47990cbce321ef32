"""A full disk, files that may only be read, links, and bytes that are not ours to change."""

from __future__ import annotations

import asyncio
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import NotSavedError
from studio.protocol.edits import ApplyFix
from studio.protocol.saving import Save
from studio.protocol.texts import Rename
from tests.support.open_documents import engine, opened, until
from tests.support.permissions import open_folder, unprivileged

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

pytestmark = [
    pytest.mark.skipif(sys.platform == "win32", reason="limits, modes and symlinks of Unix"),
]

ARM = """<?xml version="1.0"?>
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <!-- Größe 🤖 -->
  <xacro:property name="reach" value="0.4"/>
  <link name="base"/>
  <link name="tip"/>
  <joint name="turn" type="fixed"><parent link="bse"/><child link="tip"/>
    <origin xyz="0 0 ${reach}"/></joint>
</robot>
"""


@contextmanager
def no_room_for(size_bytes: int) -> Generator[None]:
    """While it lasts the system writes no file of this process that is larger, as a full disk."""
    import resource

    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size_bytes, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    path = tmp_path / "arm" / "arm.urdf.xacro"
    path.parent.mkdir()
    path.write_text(ARM)
    return path


def test_a_disk_without_room_keeps_the_file_and_the_edits_and_takes_them_later(
    arm: Path, tmp_path: Path
):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
            with no_room_for(64), pytest.raises(NotSavedError, match=r"arm\.urdf\.xacro.*large"):
                await made.execute(Save(document=document.id), ear)
            assert arm.read_text() == ARM
            assert [one.name for one in arm.parent.iterdir()] == [arm.name]
            assert document.has_unsaved
            await document.edits.edit_site(ear.site("reach")["id"], "0.6", "")
            await made.execute(Save(document=document.id), ear)
            assert arm.read_text() == ARM.replace("0.4", "0.6")

    asyncio.run(run())


def test_a_data_folder_without_room_for_drafts_stops_no_edit(arm: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)

            def is_said() -> bool:
                found = ear.last("problems")["problems"]
                return any(one["code"] == "draft-not-kept" for one in found)

            with no_room_for(16):
                await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
                await until(is_said)
            assert document.sources.text(str(arm)).decode() == ARM.replace("0.4", "0.5")
            await document.edits.edit_site(ear.site("reach")["id"], "0.6", "")
            await until(lambda: not is_said())

    asyncio.run(run())


def test_a_file_and_a_folder_of_somebody_else_are_left_alone_in_a_sentence(tmp_path: Path):
    with open_folder() as folder:
        path = folder / "arm.urdf.xacro"
        path.write_text(ARM)

        async def run() -> None:
            async with engine(tmp_path / "data") as made:
                document, ear = await opened(made, path)
                await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
                with unprivileged(), pytest.raises(NotSavedError, match="read-only"):
                    await made.execute(Save(document=document.id), ear)
                path.chmod(0o666)
                with unprivileged(), pytest.raises(NotSavedError, match="its folder is read-only"):
                    await made.execute(Save(document=document.id), ear)
                assert path.read_text() == ARM
                assert document.has_unsaved

        asyncio.run(run())


def test_a_symlinked_file_is_edited_and_saved_where_it_lies(arm: Path, tmp_path: Path):
    link = tmp_path / "arm" / "link.urdf.xacro"
    link.symlink_to("arm.urdf.xacro")

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, link)
            await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
            await made.execute(Save(document=document.id), ear)
            assert link.is_symlink()
            assert arm.read_text() == ARM.replace("0.4", "0.5")
            assert not document.has_unsaved
            arm.write_text(ARM.replace("0.4", "0.9"))
            await until(lambda: ear.site("reach")["text"] == "0.9")

    asyncio.run(run())


def test_only_the_changed_bytes_of_a_file_with_crlf_and_a_mark_are_written(
    arm: Path, tmp_path: Path
):
    awkward = b"\xef\xbb\xbf" + ARM.replace("\n", "\r\n").encode()
    arm.write_bytes(awkward)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            await document.edits.edit_site(ear.site("reach")["id"], "0.55", "")
            at = len(ARM[: ARM.index("reach")].encode("utf-16-le")) // 2
            rename = Rename(document=document.id, file=str(arm), offset=at, name="height", count=2)
            await made.execute(rename, ear)

            def mendable() -> list[dict[str, Any]]:
                found = ear.last("problems")["problems"]
                return [one for one in found if "bse" in one["sentence"] and one["fix"]]

            await until(lambda: mendable() != [])
            (problem,) = mendable()
            fix = ApplyFix(
                document=document.id,
                code=problem["code"],
                sentence=problem["sentence"],
                label=problem["fix"]["label"],
            )
            await made.execute(fix, ear)
            await made.execute(Save(document=document.id), ear)
            expected = awkward.replace(b"0.4", b"0.55").replace(b"reach", b"height")
            assert arm.read_bytes() == expected.replace(b'"bse"', b'"base"')

    asyncio.run(run())
