"""What the Doctor sees of an open document."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from studio.documents.seen import seen_document
from studio.protocol.displays import AddDisplay
from studio.protocol.doctor import ExamineSystem
from tests.support.open_documents import engine, opened, until

if TYPE_CHECKING:
    from pathlib import Path

ARM = """<robot name="arm"><link name="base"/><link name="tip"/>
  <joint name="turn" type="revolute"><parent link="base"/><child link="tip"/>
    <axis xyz="0 0 0"/></joint></robot>"""


def test_links_displays_and_problems_of_a_document_are_examined(tmp_path: Path):
    async def run() -> None:
        file = tmp_path / "arm.urdf"
        file.write_text(ARM)
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, file)
            document.live.restore()
            await document.live.add(AddDisplay(kind="LaserScan", topic=""))
            await until(lambda: bool(seen_document(document).displays[0].state))
            await until(lambda: bool(seen_document(document).problems))
            seen = seen_document(document)
            assert seen.links == {"base", "tip"}
            assert seen.displays[0].name == "LaserScan"
            await made.execute(ExamineSystem(document=document.id), ear)
            found = ear.last("system_examined")
            codes = {one["code"] for one in found["findings"]}
            assert {"display", "problem"} <= codes
            await made.execute(ExamineSystem(document="elsewhere"), ear)
            assert "problem" not in {one["code"] for one in ear.last("system_examined")["findings"]}

    asyncio.run(run())
