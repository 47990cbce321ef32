"""The undo list as it is used: to any step and back, and never to one of another list."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import CommandError
from studio.protocol.saving import UndoTo
from tests.support.open_documents import Ear, engine, opened
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document


BOX = """<robot name="box" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="wide" default="1"/>
  <xacro:property name="size" value="0.1"/>
  <link name="base"><visual><geometry><box size="${size} $(arg wide) 1"/></geometry></visual></link>
</robot>
"""


async def with_steps(document: Document, ear: Ear) -> list[tuple[bytes, dict[str, str], str]]:
    """Do four steps of three kinds; text, arguments and size of the box before and after each."""
    size, entry = ear.site("size")["id"], document.path

    def state() -> tuple[bytes, dict[str, str], str]:
        link = document.model.assembly.part("link:base")
        assert link is not None
        return document.sources.text(entry), document.sources.arguments, link.xml

    states = [state()]
    for work in (
        lambda: document.edits.edit_site(size, "0.2", "drag"),
        lambda: document.edits.pass_arguments({"wide": "3"}),
        lambda: document.edits.edit_site(size, "0.3", "drag"),
        lambda: document.edits.pass_arguments({"wide": None}),
    ):
        await work()
        states.append(state())
    return states


def test_every_step_is_a_place_to_go_to(tmp_path: Path):
    entry = write_package(tmp_path / "box", files={"box.urdf.xacro": BOX}) / "box.urdf.xacro"

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, entry)
            states = await with_steps(document, ear)
            for at in (0, 4, 2, 3, 1, 1, 4):
                await made.execute(UndoTo(document=document.id, position=at, of=4), ear)
                link = document.model.assembly.part("link:base")
                assert link is not None
                now = document.sources.text(str(entry)), document.sources.arguments, link.xml
                assert now == states[at]
                told = ear.last("history")
                assert (len(told["undo"]), len(told["redo"])) == (at, 4 - at)

    asyncio.run(run())


@pytest.mark.parametrize(("position", "of"), [(5, 4), (1, 3), (1, 5)])
def test_a_step_of_another_list_is_refused(position: int, of: int, tmp_path: Path):
    entry = write_package(tmp_path / "box", files={"box.urdf.xacro": BOX}) / "box.urdf.xacro"

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, entry)
            states = await with_steps(document, ear)
            wish = UndoTo(document=document.id, position=position, of=of)
            with pytest.raises(CommandError, match="choose the step again"):
                await made.execute(wish, ear)
            assert document.sources.text(str(entry)) == states[-1][0]

    asyncio.run(run())
