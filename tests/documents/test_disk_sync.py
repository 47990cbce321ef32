"""Another program writes the files of an open document: merged live, or put to a choice."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import EditError, SaveConflictError
from studio.protocol.saving import GetCollisions, ResolveCollisions
from tests.support.open_documents import Ear, engine, opened, until
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document


MAST = """<robot name="mast" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="c" value="${xacro.load_yaml('$(find mast_description)/config/c.yaml')}"/>
  <xacro:property name="reach" value="0.4"/>
  <xacro:property name="width" value="0.1"/>
  <link name="base"/>
  <link name="tip"/>
  <joint name="hold" type="fixed">
    <parent link="base"/><child link="tip"/><origin xyz="${width} ${c['y']} ${reach}"/>
  </joint>
</robot>
"""
CONFIG = "x: 1.0\ny: 2.0\n"


@pytest.fixture
def mast(tmp_path: Path) -> Path:
    files = {"urdf/mast.urdf.xacro": MAST, "config/c.yaml": CONFIG}
    return write_package(tmp_path / "mast_description", files=files) / "urdf/mast.urdf.xacro"


def tip_of(document: Document) -> list[float]:
    """Where the tip stands, x y z in m."""
    joint = document.model.robot.joints["hold"]
    return [round(float(one), 6) for one in joint.origin.xyz]


def codes(ear: Ear) -> set[str]:
    return {one["code"] for one in ear.last("problems")["problems"]}


def test_an_outside_write_and_an_unsaved_edit_are_both_in_the_robot(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
            mast.write_text(MAST.replace('value="0.1"', 'value="0.3"'))
            await until(lambda: tip_of(document) == [0.3, 2.0, 0.5])
            assert ear.last("disk_merged") == {
                "type": "disk_merged",
                "file": str(mast),
                "kept": 1,
            }
            await until(lambda: ear.site("width")["text"] == "0.3")
            assert (ear.site("reach")["saved_text"], ear.site("width")["saved_text"]) == (
                "0.4",
                None,
            )
            await document.saving.save()
            assert mast.read_text() == MAST.replace('"0.1"', '"0.3"').replace('"0.4"', '"0.5"')

    asyncio.run(run())


def test_a_save_right_after_an_outside_write_keeps_both(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
            mast.write_text(MAST.replace('value="0.1"', 'value="0.3"'))
            await document.saving.save()
            assert mast.read_text() == MAST.replace('"0.1"', '"0.3"').replace('"0.4"', '"0.5"')
            assert tip_of(document) == [0.3, 2.0, 0.5]

    asyncio.run(run())


def test_a_yaml_file_put_in_place_by_a_rename_is_merged_too(mast: Path, tmp_path: Path):
    config = mast.parent.parent / "config" / "c.yaml"

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            await document.edits.edit_site(ear.site("y")["id"], "5.0", "")
            beside = config.with_suffix(".new")
            beside.write_text("# by another\n" + CONFIG)
            beside.rename(config)
            await until(lambda: "disk_merged" in {one["type"] for one in ear.events})
            await document.saving.save()
            assert config.read_text() == "# by another\nx: 1.0\ny: 5.0\n"
            assert tip_of(document) == [0.1, 5.0, 0.4]

    asyncio.run(run())


@pytest.mark.parametrize(("keep", "reach"), [("mine", 0.5), ("theirs", 0.9)])
def test_a_collision_is_shown_overwrites_nothing_and_is_chosen(
    mast: Path, tmp_path: Path, keep: str, reach: float
):
    theirs = MAST.replace('value="0.4"', 'value="0.9"').replace('value="0.1"', 'value="0.3"')

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
            mast.write_text(theirs)
            await until(lambda: "changed-on-disk" in codes(ear))
            with pytest.raises(SaveConflictError):
                await document.saving.save()
            assert (mast.read_text(), tip_of(document)) == (theirs, [0.1, 2.0, 0.5])
            told = document.disk.collisions(GetCollisions(file=str(mast)))
            (place,) = told.places
            assert (place.line, told.count) == (3, 1)
            assert ('"0.4"' in place.base, '"0.5"' in place.mine, '"0.9"' in place.theirs) == (
                True,
                True,
                True,
            )
            side = ResolveCollisions.model_validate({"file": str(mast), "keep": keep}).keep
            await document.disk.resolve(ResolveCollisions(file=str(mast), keep=side))
            assert tip_of(document) == [0.3, 2.0, reach]
            assert "changed-on-disk" not in codes(ear)
            await document.saving.save()
            assert f'value="{reach}"' in mast.read_text()
            with pytest.raises(EditError):
                await document.disk.resolve(ResolveCollisions(file=str(mast), keep=side))

    asyncio.run(run())


def test_a_collision_is_gone_when_the_edit_is_taken_back(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
            mast.write_text(MAST.replace('value="0.4"', 'value="0.9"'))
            await until(lambda: "changed-on-disk" in codes(ear))
            await document.edits.undo()
            await until(lambda: tip_of(document) == [0.1, 2.0, 0.9])
            assert "changed-on-disk" not in codes(ear)
            assert not document.has_unsaved

    asyncio.run(run())


def test_a_half_written_file_keeps_the_model_until_the_rest_comes(mast: Path, tmp_path: Path):
    theirs = MAST.replace('value="0.1"', 'value="0.3"')

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            mast.write_text(theirs[:-60])
            await until(lambda: document.last_run.failed)
            assert tip_of(document) == [0.1, 2.0, 0.4]
            mast.write_text(theirs)
            await until(lambda: tip_of(document) == [0.3, 2.0, 0.4])
            assert not document.has_unsaved
            assert ear.last("problems")["showing_last_good"] is False

    asyncio.run(run())


def test_a_file_that_comes_back_is_merged_with_what_was_kept(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
            mast.unlink()
            await until(lambda: "file-gone" in codes(ear))
            mast.write_text(MAST.replace('value="0.1"', 'value="0.3"'))
            await until(lambda: tip_of(document) == [0.3, 2.0, 0.5])
            assert "file-gone" not in codes(ear)

    asyncio.run(run())
