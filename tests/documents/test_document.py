"""A document with real workers on real files: edits, undo, saving, the disk, a fallen worker."""

from __future__ import annotations

import asyncio
import gc
import os
import shutil
import signal
import weakref
from typing import TYPE_CHECKING

import pytest

from studio.errors import CommandError, OutsideRootsError, StaleEditError
from studio.protocol.documents import CloseDocument, Watch
from studio.protocol.texts import GetText
from tests.support.loop_watch import calls_here
from tests.support.open_documents import Ear, engine, opened, until
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document


ARM = """<?xml version="1.0"?>
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="gripper" default="false"/>
  <xacro:property name="reach" value="0.4"/> <!-- [0.1:0.05:1] m how far it goes -->
  <link name="base"><visual><geometry><box size="0.1 0.1 ${reach}"/></geometry></visual></link>
  <link name="tip"/>
  <joint name="turn" type="revolute">
    <parent link="base"/><child link="tip"/><origin xyz="0 0 ${reach}"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <xacro:if value="$(arg gripper)"><link name="gripper"/>
    <joint name="hold" type="fixed"><parent link="tip"/><child link="gripper"/></joint>
  </xacro:if>
</robot>
"""


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    package = write_package(tmp_path / "arm_description", files={"urdf/arm.urdf.xacro": ARM})
    return package / "urdf" / "arm.urdf.xacro"


def height_of(document: Document) -> float:
    """Where the tip stands, m."""
    model = document.model
    return float(model.kinematics.wxyz_xyz(model.joints.values)[1, 6])


def test_an_edit_moves_the_robot_and_is_undone_and_done_again(arm: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            reach = ear.site("reach")
            assert reach["widget"]["minimum"] == 0.1
            await document.edits.edit_site(reach["id"], "0.5", "drag")
            await document.edits.edit_site(reach["id"], "0.6", "drag")
            assert height_of(document) == pytest.approx(0.6)
            assert ear.site("reach")["saved_text"] == "0.4"
            assert len(ear.last("history")["undo"]) == 1
            await document.edits.undo()
            assert height_of(document) == pytest.approx(0.4)
            assert ear.last("history")["unsaved_count"] == 0
            await document.edits.redo()
            assert height_of(document) == pytest.approx(0.6)
            assert arm.read_text() == ARM

    asyncio.run(run())


def test_saving_writes_the_edited_bytes_and_clears_the_marks(arm: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            await document.edits.edit_site(ear.site("reach")["id"], "0.55", "")
            await document.saving.save()
            assert arm.read_text() == ARM.replace('value="0.4"', 'value="0.55"')
            assert ear.site("reach")["saved_text"] is None
            assert ear.last("saved")["files"] == [str(arm)]
            assert not document.has_unsaved

    asyncio.run(run())


def test_a_failed_run_keeps_the_model_and_its_undo_mends_it(arm: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            await document.edits.edit_site(ear.site("reach")["id"], "${unheard_of}", "")
            told = ear.last("problems")
            assert told["showing_last_good"]
            (problem,) = [one for one in told["problems"] if one["severity"] == "error"]
            assert problem["place"]["file"] == str(arm)
            assert problem["place"]["line"] == 4
            assert problem["fix"]["action"] == "undo"
            assert height_of(document) == pytest.approx(0.4)
            newcomer = Ear()
            document.attach(newcomer)
            assert newcomer.site("reach")["text"] == "${unheard_of}"
            await document.edits.undo()
            assert "error" not in {one["severity"] for one in ear.last("problems")["problems"]}
            assert ear.site("reach")["text"] == "0.4"

    asyncio.run(run())


def test_edits_that_come_during_a_run_all_count(arm: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            site = ear.site("reach")["id"]
            texts = [f"0.{number}" for number in range(41, 60)]
            await asyncio.gather(*(document.edits.edit_site(site, text, "g") for text in texts))
            assert height_of(document) == pytest.approx(0.59)
            await asyncio.gather(document.edits.edit_site(site, "0.7", "h"), document.edits.undo())
            assert height_of(document) == pytest.approx(0.59)

    asyncio.run(run())


def test_an_argument_adds_links_and_keeps_the_joints(arm: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            document.motion.set({"turn": 0.5})
            await document.edits.pass_arguments({"gripper": "true"})
            assert [link["name"] for link in ear.last("robot")["links"]][-1] == "gripper"
            assert ear.last("joints")["positions"] == {"turn": 0.5}
            assert ear.site("gripper")["argument"] == "true"
            await document.edits.undo()
            assert len(ear.last("robot")["links"]) == 2

    asyncio.run(run())


def test_a_change_on_disk_is_taken(arm: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, arm)
            changed = ARM.replace('value="0.4"', 'value="0.8"')
            await until(lambda: bool(arm.write_text(changed)) and height_of(document) > 0.7)
            assert not document.has_unsaved

    asyncio.run(run())


def test_a_deleted_file_is_said_and_the_model_and_edits_stay(arm: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            arm.unlink()
            await until(
                lambda: any(one["code"] == "file-gone" for one in ear.last("problems")["problems"])
            )
            await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
            assert height_of(document) == pytest.approx(0.5)

    asyncio.run(run())


def test_a_killed_worker_loses_no_edit(arm: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
            pid = document.runs.worker_pid
            assert pid is not None
            os.kill(pid, signal.SIGKILL)
            await document.edits.edit_site(ear.site("reach")["id"], "0.6", "")
            if (
                document.last_run.failed
            ):  # the run under way fell with the worker; the next one has a new one
                await document.edits.edit_site(ear.site("reach")["id"], "0.61", "")
            assert height_of(document) > 0.59
            assert ear.site("reach")["saved_text"] == "0.4"

    asyncio.run(run())


def test_a_missing_package_is_chosen_and_the_robot_opens(tmp_path: Path):
    elsewhere = write_package(
        tmp_path / "elsewhere" / "parts", files={"base.xacro": '<robot><link name="base"/></robot>'}
    )
    text = (
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:include filename="$(find parts)/base.xacro"/></robot>'
    )
    package = write_package(tmp_path / "ws" / "asks", files={"urdf/r.urdf.xacro": text})

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, package)
            assert document.last_run.phase == "failed"
            (problem,) = ear.last("problems")["problems"]
            assert problem["fix"] == {
                "label": "Choose its folder",
                "action": "choose_package",
                "target": "parts",
                "edits": [],
                "new_files": [],
            }
            await document.choose_package("parts", str(elsewhere))
            assert [link["name"] for link in ear.last("robot")["links"]] == ["base"]
            assert ear.last("problems")["problems"] == []

    asyncio.run(run())


def test_a_site_that_is_gone_is_refused(arm: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, arm)
            with pytest.raises(StaleEditError):
                await document.edits.edit_site("nowhere#1@value", "1", "")

    asyncio.run(run())


def test_two_documents_share_nothing_but_the_files(arm: Path, tmp_path: Path):
    other = arm.with_name("other.urdf.xacro")
    shutil.copy(arm, other)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            first, ear = await opened(made, arm)
            second, _ = await opened(made, other)
            await first.edits.edit_site(ear.site("reach")["id"], "0.5", "")
            assert (height_of(first), height_of(second)) == (0.5, 0.4)
            assert [first.id, second.id] == ["arm", "other"]

    asyncio.run(run())


def test_the_expanded_urdf_can_be_had_once_there_is_one(arm: Path, tmp_path: Path):
    arm.with_name("bad.urdf.xacro").write_text("<robot")

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, arm)
            assert '<box size="0.1 0.1 0.4"' in await document.urdf.text()
            bad, _ = await opened(made, arm.with_name("bad.urdf.xacro"))
            with pytest.raises(CommandError):
                await bad.urdf.text()

    asyncio.run(run())


def test_closing_the_engine_ends_every_worker(arm: Path, tmp_path: Path):
    async def run() -> int | None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, arm)
            return document.runs.worker_pid

    pid = asyncio.run(run())
    assert pid is not None
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


def test_a_number_that_became_a_word_stays_in_reach_when_its_worker_falls(
    arm: Path, tmp_path: Path
):
    """Also when it was saved so: nothing in the file says any more that it was a number."""

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            axis = next(name for name in ear.sites() if name.endswith("@xyz"))
            await document.edits.edit_site(axis, "upwards", "")
            await document.saving.save()
            assert document.runs.worker_pid is not None
            os.kill(document.runs.worker_pid, signal.SIGKILL)
            await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
            await document.edits.edit_site(axis, "0 1 0", "")
            assert b'xyz="0 1 0"' in document.sources.text(str(arm))

    asyncio.run(run())


def test_a_file_of_a_chosen_package_is_shown_and_cannot_be_edited(arm: Path, tmp_path: Path):
    leg = write_package(tmp_path / "far" / "leg", files={"urdf/leg.xacro": "<robot/>"})
    file = str(leg / "urdf" / "leg.xacro")

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            asked = GetText(document=document.id, request=1, file=file)
            with pytest.raises(OutsideRootsError):
                await made.execute(asked, ear)
            await document.choose_package("leg", str(leg))
            await made.execute(asked, ear)
            assert ear.last("text")["text"] == "<robot/>"
            assert ear.last("text")["read_only"]

    asyncio.run(run())


def test_the_memory_of_a_closed_document_is_given_back_at_once(tmp_path: Path):
    file = tmp_path / "r" / "r.urdf"
    file.parent.mkdir()
    file.write_text('<robot name="r"><link name="base"/></robot>')

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            ear = Ear()
            made.attach(ear)
            name = await made.open_path(file, {})
            await made.document(name).opened()
            await made.execute(Watch(document=name), ear)
            left = weakref.ref(made.document(name))
            await made.execute(CloseDocument(document=name), ear)
            await until(lambda: left() is None)

    gc.disable()
    try:
        asyncio.run(run())
    finally:
        gc.enable()


def test_a_save_makes_only_those_rows_anew_that_it_changes(tmp_path: Path):
    file = tmp_path / "r" / "arm.urdf.xacro"
    file.parent.mkdir()
    file.write_text(ARM)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, file)
            await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
            assert ear.site("reach")["saved_text"] == "0.4"
            with calls_here() as calls:
                await document.saving.save()
            assert ear.site("reach")["saved_text"] is None
            assert calls["SiteTable.send"]
            assert calls["_site_view"] == 1
            assert len(ear.sites()) > 1

    asyncio.run(run())
