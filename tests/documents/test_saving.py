"""What saving would write, which files of it are written, and copies of what cannot be."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import CommandError, NotSavedError, OutsideRootsError, StudioError
from studio.protocol.saving import GetChanges, GetCollisions, ResolveCollisions, Save, SaveCopy
from studio.protocol.texts import EditText, GetText, TextChange
from tests.support.open_documents import Ear, engine, opened
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document


MAST = """<robot name="mast" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="c" value="${xacro.load_yaml('$(find mast)/c.yaml')}"/>
  <xacro:property name="reach" value="0.4"/>
  <link name="base"><visual><geometry><box size="1 ${c['y']} ${reach}"/></geometry></visual></link>
</robot>
"""


@pytest.fixture
def mast(tmp_path: Path) -> Path:
    files = {"mast.urdf.xacro": MAST, "c.yaml": "y: 2.0\n"}
    return write_package(tmp_path / "mast", files=files) / "mast.urdf.xacro"


async def edited(document: Document, ear: Ear) -> None:
    await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
    await document.edits.edit_site(ear.site("y")["id"], "3.0", "")


def test_the_changes_are_counted_and_only_the_chosen_file_is_written(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            await edited(document, ear)
            await made.execute(GetChanges(document=document.id), ear)
            told = {one["file"]: one for one in ear.last("changes")["files"]}
            assert set(told) == {str(mast), str(mast.with_name("c.yaml"))}
            first = told[str(mast)]
            assert (first["added"], first["removed"], first["hindrance"]) == (1, 1, "")
            lines = [one["text"].strip() for one in first["hunks"][0] if one["kind"] != "same"]
            assert lines == [
                '<xacro:property name="reach" value="0.4"/>',
                '<xacro:property name="reach" value="0.5"/>',
            ]
            await made.execute(Save(document=document.id, files=(str(mast),)), ear)
            assert mast.read_text() == MAST.replace("0.4", "0.5")
            assert mast.with_name("c.yaml").read_text() == "y: 2.0\n"
            assert document.sources.unsaved_files == (str(mast.with_name("c.yaml")),)

    asyncio.run(run())


def test_a_file_that_may_only_be_read_says_so_before_and_is_saved_as_a_copy(
    mast: Path, tmp_path: Path
):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            await edited(document, ear)
            mast.chmod(0o444)
            await made.execute(GetChanges(document=document.id), ear)
            told = ear.last("changes")
            (hindrance,) = (one["hindrance"] for one in told["files"] if one["hindrance"])
            assert "read-only" in hindrance
            assert told["copies"] == str(mast.parent)
            with pytest.raises(NotSavedError):
                await document.saving.save()
            assert document.has_unsaved
            copy = mast.with_name("copy.urdf.xacro")
            wish = SaveCopy(document=document.id, file=str(mast), path=str(copy))
            await made.execute(wish, ear)
            assert copy.read_text() == MAST.replace("0.4", "0.5")
            assert document.has_unsaved

    asyncio.run(run())


@pytest.mark.parametrize(
    ("path", "error", "words"),
    [
        ("mast/c.yaml", NotSavedError, "there already"),
        ("mast/no/such.xacro", NotSavedError, "no such folder"),
        ("outside.xacro", OutsideRootsError, "outside"),
    ],
)
def test_a_copy_goes_nowhere_else(
    mast: Path, tmp_path: Path, path: str, error: type[StudioError], words: str
):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            wish = SaveCopy(document=document.id, file=str(mast), path=str(tmp_path / path))
            with pytest.raises(error, match=words):
                await made.execute(wish, ear)
            assert mast.with_name("c.yaml").read_text() == "y: 2.0\n"
            with pytest.raises(CommandError, match="no whole path"):
                await made.execute(wish.model_copy(update={"path": "x.xacro"}), ear)

    asyncio.run(run())


def test_a_folder_that_vanished_loses_nothing(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            await edited(document, ear)
            mast.parent.rename(tmp_path / "elsewhere")
            await made.execute(GetChanges(document=document.id), ear)
            assert all("deleted" in one["hindrance"] for one in ear.last("changes")["files"])
            with pytest.raises(NotSavedError, match="put it back or save a copy"):
                await document.saving.save()
            (tmp_path / "elsewhere").rename(mast.parent)
            await document.saving.save()
            assert mast.read_text() == MAST.replace("0.4", "0.5")

    asyncio.run(run())


def test_each_collision_is_chosen_by_itself(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            two = mast.with_name("two.urdf.xacro")
            two.write_text(
                '<robot name="r">\n<link name="a"/>\n<!-- 1 -->\n<link name="b"/>\n</robot>'
            )
            document, ear = await opened(made, two)
            read = GetText(document=document.id, file=str(two))
            await made.execute(read, ear)
            text = ear.last("text")["text"]
            for old, new in (('"a"', '"mine_a"'), ('"b"', '"mine_b"')):
                at = text.index(old)
                change = TextChange(start=at, end=at + 3, text=new)
                version = document.texts.answer(read, ear.role).version
                edit = EditText(
                    document=document.id, file=str(two), version=version, changes=(change,)
                )
                await made.execute(edit, ear)
                text = text.replace(old, new)
            two.write_text(two.read_text().replace('"a"', '"a2"').replace('"b"', '"b2"'))
            document.sources.refresh(str(two))
            await made.execute(GetCollisions(document=document.id, file=str(two)), ear)
            state = ear.last("collisions")["state"]
            choice = ResolveCollisions(
                document=document.id,
                file=str(two),
                keep="mine",
                each=("theirs", "mine"),
                state=state,
            )
            with pytest.raises(StudioError, match="compare it again"):
                await made.execute(choice.model_copy(update={"state": "old"}), ear)
            await made.execute(choice, ear)
            assert list(document.model.robot.links) == ["a2", "mine_b"]

    asyncio.run(run())
