"""The form of arguments: told for any file, and passed all at once."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import CommandError, OutsideRootsError
from studio.protocol.documents import Arguments, GetArguments, SetArguments
from tests.support.open_documents import Ear, engine, opened
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.engine import Engine


MAST = """<robot name="mast" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="reach" default="0.4"/>
  <link name="$(arg side)_base"/>
  <xacro:if value="${$(arg reach) &gt; 9}"><link name="tall"/></xacro:if>
</robot>
"""


@pytest.fixture
def mast(tmp_path: Path) -> Path:
    files = {"mast.urdf.xacro": MAST}
    return write_package(tmp_path / "mast_description", files=files) / "mast.urdf.xacro"


async def form(made: Engine, document: str = "", path: str = "") -> Arguments:
    ear = Ear()
    await made.execute(GetArguments(document=document, path=path), ear)
    return Arguments.model_validate(ear.last("arguments"))


def test_what_is_missing_is_asked_for_and_all_is_passed_in_one_step(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            fix = ear.last("problems")["problems"][0]["fix"]
            assert (document.last_run.phase, fix["action"]) == ("failed", "give_arguments")
            told = await form(made, document.id)
            assert told.missing == ("side",)
            assert [one.name for one in told.arguments] == ["side", "reach"]
            await made.execute(
                SetArguments(document=document.id, values={"side": "left", "reach": "2"}), ear
            )
            assert list(document.model.robot.links) == ["left_base"]
            assert document.sources.undo_labels == ("Arguments",)
            told = await form(made, document.id)
            assert (told.missing, [one.value for one in told.arguments]) == ((), ["left", "2"])
            await document.edits.undo()
            assert document.sources.arguments == {}
            assert document.last_run.failed

    asyncio.run(run())


def test_wrong_values_are_refused_and_leave_no_step(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast, side="left")
            await document.edits.pass_arguments({"reach": "2"})
            await document.edits.undo()
            with pytest.raises(CommandError, match=r"high.*as they were"):
                await document.edits.pass_arguments({"side": "right", "reach": "high"})
            assert not document.last_run.failed
            assert list(document.model.robot.links) == ["left_base"]
            assert document.sources.arguments == {"side": "left"}
            assert document.sources.undo_labels == ()
            assert document.sources.redo_labels == ("reach (empty) → 2",)

    asyncio.run(run())


def test_a_file_that_is_not_open_tells_its_arguments_when_it_is_served(mast: Path, tmp_path: Path):
    outside = tmp_path / "outside.xacro"
    outside.write_text(MAST)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            await opened(made, mast, side="left")
            told = await form(made, path=str(mast))
            assert (told.missing, told.path) == (("side",), str(mast))
            assert len(made.documents) == 1
            with pytest.raises(OutsideRootsError):
                await form(made, path=str(outside))

    asyncio.run(run())
