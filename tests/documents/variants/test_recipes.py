"""How a variant names files: so that they are found again, here and on another machine."""

from __future__ import annotations

import asyncio
import shutil
from typing import TYPE_CHECKING

from studio.protocol.variants import SaveVariant, UpdateVariant
from tests.support.loop_watch import calls_here
from tests.support.open_mast import open_mast
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path


ROBOT = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="$(find parts_description)/urdf/parts.xacro"/>
  <xacro:include filename="common/sizes.xacro"/>
  <link name="base">
    <visual><geometry><box size="${side} ${side} ${part}"/></geometry></visual>
  </link>
</robot>
"""
SIZE = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="{}" value="1"/>
</robot>
"""


def write(folder: Path) -> Path:
    write_package(folder / "parts_description", files={"urdf/parts.xacro": SIZE.format("part")})
    files = {"urdf/r.urdf.xacro": ROBOT, "urdf/common/sizes.xacro": SIZE.format("side")}
    return write_package(folder / "r_description", files=files) / "urdf/r.urdf.xacro"


def test_a_file_goes_by_its_place_beside_the_entry_or_by_its_package(tmp_path: Path):
    here, there = tmp_path / "here/src", tmp_path / "there/deeper/src"

    async def run() -> None:
        async with open_mast(write(here), tmp_path / "data") as at:
            await at.edit("part", "3")
            await at.edit("side", "2")
            await at.ask(SaveVariant(name="Tall"))
            told = at.ear.last("variants")["variants"][0]["texts"]
            assert [(one["file"], one["text"]) for one in told] == [
                ("common/sizes.xacro", "2"),
                ("package://parts_description/urdf/parts.xacro", "3"),
            ]
            saved = at.file
        entry = write(there)
        shutil.copy(saved, entry.parent)
        async with open_mast(entry, tmp_path / "data2") as at:
            assert await at.apply("Tall") == []
            (visual,) = at.document.model.robot.links["base"].visuals
            assert visual.geometry.size_m == (2, 2, 3)  # pyright: ignore
            await at.is_told("Tall")

    asyncio.run(run())


def test_texts_are_read_off_the_event_loop(tmp_path: Path):
    async def run() -> None:
        async with open_mast(write(tmp_path / "src"), tmp_path / "data") as at:
            with calls_here() as calls:
                await at.edit("part", "3")
                await at.ask(SaveVariant(name="Tall"))
                await at.is_told("Tall")
                await at.edit("side", "2")
                await at.ask(UpdateVariant(name="Tall"))
                assert await at.apply("") == []
                assert await at.apply("Tall") == []
                await at.is_told("Tall")
            assert calls["RecipeBook.present"]
            assert not calls["parse_source"]

    asyncio.run(run())
