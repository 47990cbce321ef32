"""A studio that is killed while it saves: what was written is told, nothing is lost or left."""

from __future__ import annotations

import asyncio
import signal
import subprocess
import sys
import zipfile
from io import BytesIO
from typing import TYPE_CHECKING

import pytest

from studio.documents.draft_files import SaveJournal
from tests.support.open_documents import Ear, engine, opened, until
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

MAST = """<robot name="mast" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="tools.xacro"/>
  <xacro:property name="reach" value="0.4"/>
  <link name="base"><visual><geometry><box size="1 ${width} ${reach}"/></geometry></visual></link>
</robot>
"""
TOOLS = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="width" value="0.1"/>
</robot>
"""


@pytest.fixture
def mast(tmp_path: Path) -> Path:
    files = {"urdf/mast.urdf.xacro": MAST, "urdf/tools.xacro": TOOLS}
    return write_package(tmp_path / "mast_description", files=files) / "urdf/mast.urdf.xacro"


def killed(when: str, mast: Path, data: Path) -> None:
    words = [sys.executable, "-m", "tests.support.killed_studio", when, str(data), str(mast)]
    assert subprocess.run(words, check=False, timeout=120).returncode == -signal.SIGKILL


def told(ear: Ear) -> list[str]:
    problems = ear.last("problems")["problems"]
    return [one["sentence"] for one in problems if one["code"] == "save-cut-off"]


def test_a_save_that_was_cut_off_is_told_until_it_is_made_up_for(mast: Path, tmp_path: Path):
    killed("saving", mast, tmp_path / "data")
    tools = mast.with_name("tools.xacro")
    assert ("0.5" in mast.read_text(), "0.2" in tools.read_text()) == (True, False)
    left = [one for one in mast.parent.iterdir() if one.name.startswith(".tools.xacro")]
    assert len(left) == 1

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            (sentence,) = told(ear)
            assert "mast.urdf.xacro was written, tools.xacro was not" in sentence
            assert document.sources.unsaved_files == (str(tools),)
            await until(lambda: not left[0].exists())
            await document.saving.save()
            assert not told(ear)
        assert "0.2" in tools.read_text()
        async with engine(tmp_path / "data") as made:
            _, ear = await opened(made, mast)
            assert not told(ear)

    asyncio.run(run())


def test_an_edit_is_in_the_draft_before_it_is_in_the_robot(mast: Path, tmp_path: Path):
    killed("edited", mast, tmp_path / "data")

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            assert b"0.5" in document.sources.text(str(mast))

    asyncio.run(run())


def test_what_a_killed_studio_left_is_not_exported(mast: Path, tmp_path: Path):
    names = [".mast.urdf.xacro.studio-1-abcdefgh.tmp", ".mast.urdf.xacro.abcdefgh.tmp"]
    for name in names:
        mast.with_name(name).write_text("left")

    async def run() -> list[str]:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            made_zip = b"".join((await document.exports.package(all_used=False)).chunks)
            return zipfile.ZipFile(BytesIO(made_zip)).namelist()

    exported = asyncio.run(run())
    assert "mast_description/urdf/tools.xacro" in exported
    assert not [one for one in exported if one.endswith(".tmp")]
    assert mast.with_name(names[1]).exists()


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [
        (b"new", b"old", (("a",), ("b",))),
        (b"new", b"new", ((), ())),
        (b"old", b"old", ((), ())),
        (b"new", b"of others", ((), ())),
    ],
)
def test_a_save_was_cut_off_where_some_files_are_new_and_others_old(
    tmp_path: Path, a: bytes, b: bytes, expected: tuple[tuple[str, ...], tuple[str, ...]]
):
    journal = SaveJournal(tmp_path / "x.saving")
    assert journal.cut(dict[str, bytes]().__getitem__) == ((), ())
    journal.begin([("a", b"old", b"new"), ("b", b"old", b"new")])
    assert journal.cut({"a": a, "b": b}.__getitem__) == expected
    (tmp_path / "x.saving").write_bytes(b"[{")
    assert journal.cut(dict[str, bytes]().__getitem__) == ((), ())
