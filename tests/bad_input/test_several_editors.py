"""Two who edit one robot at once, and one who edits what is no longer open."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import UnknownDocumentError
from studio.protocol.documents import CloseDocument
from studio.protocol.edits import EditSite
from tests.support.open_documents import Ear, engine, opened

if TYPE_CHECKING:
    from pathlib import Path


ARM = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="reach" value="0.4"/>
  <xacro:property name="width" value="0.1"/>
  <link name="base"><visual><geometry><box size="1 ${width} ${reach}"/></geometry></visual></link>
</robot>
"""


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    path = tmp_path / "arm.urdf.xacro"
    path.write_text(ARM)
    return path


def test_of_two_who_turn_one_property_at_once_the_last_counts_and_both_see_it(
    arm: Path, tmp_path: Path
):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, one = await opened(made, arm)
            other = Ear()
            document.attach(other)
            site = one.site("reach")["id"]
            wishes = [
                made.execute(
                    EditSite(document=document.id, site=site, text=f"0.{n}", gesture=whose), ear
                )
                for n in range(1, 9)
                for whose, ear in (("one", one), ("other", other))
            ]
            await asyncio.gather(*wishes)
            last = document.sources.text(str(arm)).decode()
            assert last == ARM.replace("0.4", "0.8")
            assert one.site("reach")["text"] == other.site("reach")["text"] == "0.8"
            while document.sources.undo_labels:
                await document.edits.undo()
            assert document.sources.text(str(arm)).decode() == ARM

    asyncio.run(run())


def test_of_two_who_turn_two_properties_at_once_none_loses_anything(arm: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, one = await opened(made, arm)
            other = Ear()
            document.attach(other)
            reach, width = one.site("reach")["id"], one.site("width")["id"]
            await asyncio.gather(
                *(document.edits.edit_site(reach, f"0.{n}", "one") for n in range(1, 9)),
                *(document.edits.edit_site(width, f"0.{n}", "other") for n in range(1, 9)),
            )
            assert other.site("reach")["text"] == other.site("width")["text"] == "0.8"
            assert set(document.model.robot.links) == {"base"}

    asyncio.run(run())


def test_an_edit_of_a_model_that_was_closed_is_answered_and_changes_nothing(
    arm: Path, tmp_path: Path
):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, arm)
            late = EditSite(document=document.id, site=ear.site("reach")["id"], text="9")
            running = asyncio.ensure_future(made.execute(late, ear))
            await asyncio.sleep(0)
            await made.execute(CloseDocument(document=document.id, discard=True), ear)
            await asyncio.gather(running, return_exceptions=True)
            with pytest.raises(UnknownDocumentError, match="open"):
                await made.execute(late, ear)
            assert arm.read_text() == ARM
            again, ear = await opened(made, arm)
            assert ear.site("reach")["text"] == "0.4"
            assert not again.has_unsaved

    asyncio.run(run())
