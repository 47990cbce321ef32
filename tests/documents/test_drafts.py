"""Unsaved work comes back at the next opening: as it was, or merged with what the disk changed."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from typing import TYPE_CHECKING

import pytest

from studio.errors import OutsideRootsError
from studio.protocol.documents import CloseDocument
from studio.protocol.roles import Role
from studio.protocol.saving import DiscardRestored, ForgetWork, ResolveCollisions, UndoTo
from studio.protocol.texts import EditText, GetText, TextChange
from tests.support.open_documents import Ear, engine, opened, until
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

    from studio.description.editing.undo import KeptSources
    from studio.documents.document import Document


MAST = """<robot name="mast" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="side" default="left"/>
  <xacro:property name="reach" value="0.4"/>
  <xacro:property name="width" value="0.1"/>
  <link name="$(arg side)"/>
  <link name="tip"/>
  <joint name="hold" type="fixed">
    <parent link="$(arg side)"/><child link="tip"/><origin xyz="${width} 0 ${reach}"/>
  </joint>
</robot>
"""


@pytest.fixture
def mast(tmp_path: Path) -> Path:
    files = {"urdf/mast.urdf.xacro": MAST}
    return write_package(tmp_path / "mast_description", files=files) / "urdf/mast.urdf.xacro"


def tip_of(document: Document) -> list[float]:
    """Where the tip stands, x y z in m."""
    joint = document.model.robot.joints["hold"]
    return [round(float(one), 6) for one in joint.origin.xyz]


async def work(mast: Path, data: Path) -> None:
    """Edit and end the studio without saving."""
    async with engine(data) as made:
        document, ear = await opened(made, mast)
        await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
        await document.edits.pass_arguments({"side": "right"})
        await document.edits.edit_site(ear.site("width")["id"], "0.2", "")
        await document.edits.undo()


def test_edits_arguments_and_both_sides_of_the_undo_list_come_back(mast: Path, tmp_path: Path):
    async def run() -> None:
        await work(mast, tmp_path / "data")
        assert mast.read_text() == MAST
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            assert tip_of(document) == [0.1, 0, 0.5]
            assert next(iter(document.model.robot.links)) == "right"
            told = ear.last("restored")
            assert (bool(told["at"]), told["files"]) == (True, [str(mast)])
            assert ear.last("history")["undo"] == ["reach 0.4 → 0.5", "side (empty) → right"]
            await document.edits.redo()
            assert tip_of(document) == [0.2, 0, 0.5]
            await made.execute(UndoTo(document=document.id, position=0, of=3), ear)
            assert tip_of(document) == [0.1, 0, 0.4]
            assert document.sources.text(str(mast)) == MAST.encode()
            assert ear.last("restored")["at"] == ""

    asyncio.run(run())


def test_where_unsaved_work_gives_no_robot_the_saved_one_is_drawn_and_the_error_told(
    mast: Path, tmp_path: Path
):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            read = GetText(document=document.id, file=str(mast))
            for old, new in (
                ("<link", "<!-- longer than before --><link"),
                ("${reach}", "${nonsense}"),
            ):
                await made.execute(read, ear)
                text = ear.last("text")
                at = text["text"].index(old)
                change = TextChange(start=at, end=at + len(old), text=new)
                edit = EditText(
                    document=document.id, file=str(mast), version=text["version"], changes=(change,)
                )
                await made.execute(edit, ear)
            broken = document.sources.text(str(mast))
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            assert tip_of(document) == [0.1, 0, 0.4]
            assert (document.last_run.phase, document.last_run.failed) == ("ready", True)
            assert "nonsense" in str(ear.last("problems"))
            assert document.sources.text(str(mast)) == broken
            await document.edits.edit_site(ear.site("width")["id"], "0.2", "")
            assert b'"width" value="0.2"' in document.sources.text(str(mast))
            await document.edits.undo()
            await document.edits.undo()
            assert tip_of(document) == [0.1, 0, 0.4]
            assert not document.last_run.failed

    asyncio.run(run())


ARM = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="tool" default="short"/>
  <xacro:property name="reach" value="0.4"/>
  <xacro:include filename="$(arg tool).xacro"/>
</robot>
"""
TOOL = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="{0}"/></robot>"""


@pytest.mark.parametrize("broken", ["0.5", "${nonsense}"])
def test_where_the_arguments_of_unsaved_work_give_no_robot_the_saved_one_is_drawn(
    tmp_path: Path, broken: str
):
    tools = {f"urdf/{one}.xacro": TOOL.format(one) for one in ("short", "long")}
    package = write_package(tmp_path / "arm_description", files={"urdf/arm.xacro": ARM, **tools})
    arm, long = package / "urdf/arm.xacro", package / "urdf/long.xacro"

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            await document.edits.pass_arguments({"tool": "long"})
            await document.edits.edit_site(ear.site("reach")["id"], broken, "")
            edited = document.sources.text(str(arm))
        long.unlink()
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            assert list(document.model.robot.links) == ["short"]
            assert (document.last_run.phase, document.last_run.failed) == ("ready", True)
            assert "long.xacro" in str(ear.last("problems"))
            assert ear.last("restored")["at"] != ""
            assert document.sources.arguments == {"tool": "long"}
            assert document.sources.text(str(arm)) == edited
            long.write_text(TOOL.format("longer"))
            await document.edits.edit_site(ear.site("reach")["id"], "0.6", "")
            assert list(document.model.robot.links) == ["longer"]
            await made.execute(DiscardRestored(document=document.id), ear)
            assert list(document.model.robot.links) == ["short"]
            assert (document.sources.arguments, document.last_run.failed) == ({}, False)

    asyncio.run(run())


def test_what_the_disk_changed_meanwhile_is_merged(mast: Path, tmp_path: Path):
    async def run() -> None:
        await work(mast, tmp_path / "data")
        mast.write_text(MAST.replace('value="0.1"', 'value="0.3"'))
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            assert tip_of(document) == [0.3, 0, 0.5]
            await document.saving.save()
            text = MAST.replace('value="0.1"', 'value="0.3"').replace('"0.4"', '"0.5"')
            assert mast.read_text() == text
            await document.edits.pass_arguments({"side": None})
            assert ear.last("restored")["at"] == ""

    asyncio.run(run())


def test_where_both_changed_one_place_somebody_chooses(mast: Path, tmp_path: Path):
    async def run() -> None:
        await work(mast, tmp_path / "data")
        mast.write_text(MAST.replace('value="0.4"', 'value="0.9"'))
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            assert tip_of(document) == [0.1, 0, 0.5]
            codes = [one["code"] for one in ear.last("problems")["problems"]]
            assert codes == ["changed-on-disk"]
            choice = ResolveCollisions(document=document.id, file=str(mast), keep="theirs")
            await made.execute(choice, ear)
            assert tip_of(document) == [0.1, 0, 0.9]

    asyncio.run(run())


def test_what_was_restored_is_discarded_and_undo_brings_it_back(mast: Path, tmp_path: Path):
    async def run() -> None:
        await work(mast, tmp_path / "data")
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            await made.execute(DiscardRestored(document=document.id), ear)
            assert (tip_of(document), document.has_unsaved) == ([0.1, 0, 0.4], False)
            assert (document.sources.arguments, ear.last("restored")["at"]) == ({}, "")
            await document.edits.undo()
            assert tip_of(document) == [0.1, 0, 0.5]

    asyncio.run(run())


def test_a_document_closed_by_its_user_leaves_nothing(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
            await until(lambda: any((tmp_path / "data/drafts").glob("*.json")))
            await made.execute(CloseDocument(document=document.id, discard=True), ear)
            document, _ = await opened(made, mast)
            assert (tip_of(document), document.sources.undo_labels) == ([0.1, 0, 0.4], ())

    asyncio.run(run())


def test_a_draft_is_written_soon_and_goes_when_nothing_is_left_of_it(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            await document.edits.edit_site(ear.site("reach")["id"], "0.5", "drag")
            await until(lambda: any((tmp_path / "data/drafts").glob("*.json")))
            await document.edits.edit_site(ear.site("reach")["id"], "0.4", "drag")
            await until(lambda: not any((tmp_path / "data/drafts").glob("*.json")))

    asyncio.run(run())


def test_an_edit_is_shown_before_it_is_written_down(
    mast: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    # On a busy machine a run may take longer than an edit otherwise waits to be written.
    monkeypatch.setattr("studio.documents.edits._SHOWN_WITHIN_S", 60.0)
    monkeypatch.setattr("studio.documents.drafts._WRITE_AFTER_S", 0.0)
    os.utime(mast, (1e9, 1e9))  # one just written is looked at once more when it is watched
    tips: list[list[float]] = []

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            kept = document.sources.kept

            def note() -> KeptSources:
                if b'value="0.5"' in document.sources.text(str(mast)):
                    tips.append(tip_of(document))
                return kept()

            monkeypatch.setattr(document.sources, "kept", note)
            await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
            await until(lambda: bool(tips))
            assert tips[0] == [0.1, 0, 0.5]

    asyncio.run(run())


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGSTOP")
def test_an_edit_that_is_not_shown_for_long_is_written_down_meanwhile(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            assert document.runs.worker_pid is not None
            os.kill(document.runs.worker_pid, signal.SIGSTOP)
            edit = asyncio.create_task(document.edits.edit_site(ear.site("reach")["id"], "0.5", ""))
            try:
                await until(lambda: any((tmp_path / "data/drafts").glob("*.json")))
                assert tip_of(document) == [0.1, 0, 0.4]
            finally:
                os.kill(document.runs.worker_pid, signal.SIGCONT)
            await edit
            assert tip_of(document) == [0.1, 0, 0.5]

    asyncio.run(run())


def test_arguments_that_are_named_at_the_opening_win(mast: Path, tmp_path: Path):
    async def run() -> None:
        await work(mast, tmp_path / "data")
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast, side="middle")
            assert document.sources.arguments == {"side": "middle"}
            assert tip_of(document) == [0.1, 0, 0.5]

    asyncio.run(run())


def test_a_broken_draft_is_a_problem_and_the_robot_opens(mast: Path, tmp_path: Path):
    async def run() -> None:
        await work(mast, tmp_path / "data")
        (draft,) = (tmp_path / "data/drafts").glob("*.json")
        draft.write_bytes(draft.read_bytes()[:-30])
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            assert tip_of(document) == [0.1, 0, 0.4]
            (problem,) = ear.last("problems")["problems"]
            assert problem["code"] == "draft-not-kept"
            assert f"broken/{draft.name}" in problem["sentence"]

    asyncio.run(run())


def test_files_outside_the_opened_folders_are_not_brought_back(mast: Path, tmp_path: Path):
    async def run() -> None:
        await work(mast, tmp_path / "data")
        (draft,) = (tmp_path / "data/drafts").glob("*.json")
        outside = tmp_path / "outside.xacro"
        outside.write_text("secret")
        text = draft.read_text().replace('"texts":[{"file":"' + str(mast), '"texts":[{"file":"/x')
        draft.write_text(text)
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            assert (tip_of(document), document.sources.undo_labels) == ([0.1, 0, 0.4], ())

    asyncio.run(run())


def test_work_on_another_served_file_is_offered_to_presenters_and_can_be_given_up(
    mast: Path, tmp_path: Path
):
    other = mast.with_name("other.urdf")
    other.write_text('<robot name="other"><link name="a"/></robot>')

    async def run() -> None:
        await work(mast, tmp_path / "data")
        async with engine(tmp_path / "data") as made:
            presenter, viewer = Ear(), Ear(Role.GUEST)
            made.attach(presenter)
            made.attach(viewer)
            await opened(made, other)
            await until(lambda: any(one["type"] == "left_work" for one in presenter.events))
            (entry,) = presenter.last("left_work")["entries"]
            assert (entry["path"], entry["title"]) == (str(mast), "mast.urdf.xacro")
            assert all(one["type"] != "left_work" for one in viewer.events)
            document, _ = await opened(made, mast)
            await until(lambda: presenter.last("left_work")["entries"] == [])
            assert document.has_unsaved
        await work_is_given_up(other, mast, tmp_path / "data")

    asyncio.run(run())


async def work_is_given_up(other: Path, mast: Path, data: Path) -> None:
    async with engine(data) as made:
        presenter = Ear()
        made.attach(presenter)
        await opened(made, other)
        await until(lambda: any(one["type"] == "left_work" for one in presenter.events))
        await made.execute(ForgetWork(path=str(mast)), presenter)
        assert presenter.last("left_work")["entries"] == []
        document, _ = await opened(made, mast)
        assert not document.has_unsaved


def test_work_on_files_that_are_not_served_is_nobodys_business(mast: Path, tmp_path: Path):
    elsewhere = write_package(tmp_path / "elsewhere/e", files={"e.urdf": '<robot name="e"/>'})

    async def run() -> None:
        await work(mast, tmp_path / "data")
        async with engine(tmp_path / "data") as made:
            presenter = Ear()
            made.attach(presenter)
            await opened(made, elsewhere / "e.urdf")
            with pytest.raises(OutsideRootsError):
                await made.execute(ForgetWork(path=str(mast)), presenter)
            assert all(one["type"] != "left_work" for one in presenter.events)

    asyncio.run(run())
