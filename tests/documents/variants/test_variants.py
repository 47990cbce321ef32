"""Variants of open documents with real workers: kept, switched in one step, told."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import CommandError, VariantsFileError
from studio.protocol.documents import OpenPath, SetArgument, SetArguments
from studio.protocol.edits import Redo, Undo
from studio.protocol.texts import EditText, GetText, TextChange
from studio.protocol.variants import (
    ApplyVariant,
    DeleteVariant,
    RenameVariant,
    SaveVariant,
    UpdateVariant,
)
from tests.support.open_documents import Ear, engine, opened, until
from tests.support.open_mast import MAST, OpenMast, open_mast, write_mast
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def mast(tmp_path: Path) -> Path:
    return write_mast(tmp_path)


def test_a_variant_is_saved_left_and_come_back_to_in_one_step(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with open_mast(mast, tmp_path / "data") as at:
            await at.is_told("")
            await at.edit("reach", "0.9")
            await at.edit("upper", "2.5")
            await at.ask(SetArgument(name="gripper", value="true"))
            await at.is_told("", modified=True)
            await at.ask(SaveVariant(name=" Long ", note="reaches far"))
            await at.is_told("Long")
            assert at.file == mast.with_name("mast.variants.yaml")
            steps = len(at.document.sources.undo_labels)

            assert await at.apply("") == []
            await at.is_told("")
            assert (at.tip_m, at.document.has_unsaved) == (0.4, False)
            assert at.document.sources.arguments == {}
            assert len(at.document.sources.undo_labels) == steps + 1

            assert await at.apply("Long") == []
            await at.is_told("Long")
            assert at.tip_m == 0.9
            assert at.document.model.robot.links.keys() == {"base", "tip", "gripper"}
            assert at.document.model.robot.joints["turn"].limit.upper == 2.5  # pyright: ignore[reportOptionalMemberAccess]
            assert len(at.document.sources.undo_labels) == steps + 2

            await at.ask(Undo())
            await at.is_told("")
            assert at.tip_m == 0.4
            await at.ask(Redo())
            await at.is_told("Long")
            assert mast.read_text() == MAST

    asyncio.run(run())


def test_what_is_told_of_a_variant_can_be_read(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with open_mast(mast, tmp_path / "data", side="right") as at:
            await at.edit("upper", "2")
            await at.ask(SetArguments(values={"side": None, "gripper": "1"}))
            await at.ask(SaveVariant(name="One"))
            (told,) = at.ear.last("variants")["variants"]
            assert told["arguments"] == {"gripper": "1", "side": None}
            assert told["texts"] == [{"file": "limits.yaml", "name": "upper", "text": "2"}]
            newcomer = Ear()
            at.document.attach(newcomer)
            assert newcomer.last("variants") == at.ear.last("variants")
            assert newcomer.last("comparison")["sides"] is None

    asyncio.run(run())


def test_a_variant_reaches_into_a_file_that_the_last_run_did_not_read(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with open_mast(mast, tmp_path / "data", gripper="true") as at:
            await at.edit("jaw", "0.08")
            await at.ask(SaveVariant(name="Wide"))
        async with open_mast(mast, tmp_path / "data") as at:
            assert "gripper" not in at.document.model.robot.links
            await at.apply("Wide")
            (visual,) = at.document.model.robot.links["gripper"].visuals
            assert visual.geometry.radius_m == 0.08  # pyright: ignore

    asyncio.run(run())


def test_a_variant_holds_what_the_robot_was_opened_with(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with open_mast(mast, tmp_path / "data", side="right") as at:
            await at.ask(SaveVariant(name="Right"))
        async with open_mast(mast, tmp_path / "data") as at:
            await at.apply("Right")
            assert at.document.sources.arguments == {"side": "right"}
            await at.is_told("Right")
            await at.apply("")
            assert at.document.sources.arguments == {}

    asyncio.run(run())


def test_a_variant_by_hand_is_told_as_soon_as_it_is_written(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with open_mast(mast, tmp_path / "data") as at:
            at.file.write_text("variants:\n  - {name: By hand, arguments: {gripper: true}}\n")
            await until(lambda: len(at.ear.last("variants")["variants"]) == 1)
            await at.apply("By hand")
            assert "gripper" in at.document.model.robot.links
            at.file.write_text("variants: [")
            await until(lambda: bool(at.ear.last("variants")["trouble"]))
            with pytest.raises(VariantsFileError):
                await at.ask(DeleteVariant(name="By hand"))
            at.file.unlink()
            await until(lambda: at.ear.last("variants")["variants"] == [])

    asyncio.run(run())


def test_what_a_variant_names_and_is_gone_is_told_and_the_rest_applied(mast: Path, tmp_path: Path):
    mast.with_name("mast.variants.yaml").write_text(
        "variants:\n"
        "  - name: Old\n"
        "    values:\n"
        "      - {file: mast.urdf.xacro, property: height, text: 9}\n"
        "      - {file: gone.xacro, property: reach, text: 9}\n"
        "      - {file: ../../../../etc/passwd, property: root, text: 9}\n"
        "      - {file: package://nowhere/a.xacro, property: root, text: 9}\n"
        "      - {file: mast.urdf.xacro, property: reach, text: 0.7}\n"
    )

    async def run() -> None:
        async with open_mast(mast, tmp_path / "data") as at:
            left_out = await at.apply("Old")
            assert at.tip_m == 0.7
            assert len(left_out) == 4
            assert "mast.urdf.xacro has no property height any more." in left_out
            await at.is_told("Old")

    asyncio.run(run())


def test_a_variant_whose_robot_does_not_run_leaves_the_last_good_one(mast: Path, tmp_path: Path):
    mast.with_name("mast.variants.yaml").write_text(
        "variants:\n  - name: Broken\n    values:\n"
        "      - {file: mast.urdf.xacro, property: reach, text: '${nothing}'}\n"
    )

    async def run() -> None:
        async with open_mast(mast, tmp_path / "data") as at:
            await at.apply("Broken")
            assert (at.document.last_run.failed, at.tip_m) == (True, 0.4)
            await at.apply("")
            assert not at.document.last_run.failed
            await at.is_told("")

    asyncio.run(run())


def test_edits_beside_values_are_told_kept_and_given_up_for_the_file(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with open_mast(mast, tmp_path / "data") as at:
            await at.ask(GetText(file=str(mast)))
            text = at.ear.last("text")
            end = text["text"].index("</robot>")
            new = TextChange(start=end, end=end, text='<link name="new"/>')
            await at.ask(EditText(file=str(mast), version=text["version"], changes=(new,)))
            await at.edit("reach", "0.5")
            await at.ask(SaveVariant(name="Half"))
            (sentence,) = at.ear.last("variant_saved")["left_out"]
            assert sentence.startswith(f"{mast} has unsaved edits beside its values")
            await at.edit("reach", "0.6")
            await at.apply("Half")
            assert (at.tip_m, "new" in at.document.model.robot.links) == (0.5, True)
            await at.is_told("Half", modified=True)
            await at.apply("")
            assert "new" not in at.document.model.robot.links
            assert not at.document.has_unsaved

    asyncio.run(run())


def test_variants_are_updated_renamed_and_deleted(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with open_mast(mast, tmp_path / "data") as at:
            await at.edit("reach", "0.5")
            await at.ask(SaveVariant(name="A"))
            await at.edit("reach", "0.6")
            await at.is_told("A", modified=True)
            await at.ask(UpdateVariant(name="A"))
            await at.is_told("A")
            await at.ask(SaveVariant(name="B"))
            await at.ask(RenameVariant(name="B", new_name="C", note="new"))
            await at.is_told("C")
            with pytest.raises(CommandError, match="already"):
                await at.ask(RenameVariant(name="C", new_name="A"))
            with pytest.raises(CommandError, match="already"):
                await at.ask(SaveVariant(name="A "))
            with pytest.raises(CommandError, match="needs a name"):
                await at.ask(SaveVariant(name=" \n"))
            with pytest.raises(CommandError, match="no variant"):
                await at.ask(ApplyVariant(name="B"))
            await at.ask(DeleteVariant(name="C"))
            told = at.ear.last("variants")
            assert [(one["name"], one["texts"][0]["text"]) for one in told["variants"]] == [
                ("A", "0.6")
            ]
            await at.is_told("A")  # the robot is what A says

    asyncio.run(run())


def test_variants_of_a_folder_that_is_only_read_last_for_the_session(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data", mast.parents[1]) as made:
            beside = write_package(tmp_path / "src/b_description", files={"b.urdf": "<robot/>"})
            await opened(made, beside / "b.urdf")
            ear = Ear()
            await made.execute(OpenPath(path=str(mast)), ear)
            document = made.document(ear.last("opened")["document"])
            await document.opened()
            at = OpenMast(made, document, ear)
            document.attach(ear)
            await at.edit("reach", "0.5")
            await at.ask(SaveVariant(name="A"))
            told = ear.last("variants")
            assert (len(told["variants"]), told["only_here"] != "") == (1, True)
            assert not at.file.exists()
            await at.apply("")
            await at.apply("A")
            assert at.tip_m == 0.5

    asyncio.run(run())
