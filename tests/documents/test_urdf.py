"""What the unsaved edits make of the URDF, with real workers."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from studio.protocol.roles import Role
from studio.protocol.texts import EditText, GetText, GetUrdf, GetUrdfChanges, TextChange
from tests.support.asked import ask_document
from tests.support.loop_watch import calls_here
from tests.support.open_documents import Ear, engine, opened

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document


ROBOT = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="tail" default="false"/>
  <xacro:property name="size" value="1"/>
  <link name="base"><visual><geometry><sphere radius="${size}"/></geometry></visual></link>
  <xacro:if value="$(arg tail)"><link name="tail"/>
    <joint name="j" type="fixed"><parent link="base"/><child link="tail"/></joint></xacro:if>
</robot>
"""


async def changes(document: Document) -> dict[str, Any]:
    ear = Ear()
    await ask_document(document, GetUrdfChanges(request=4), ear)
    return ear.events[-1]


def lines(answer: dict[str, Any], kind: str) -> list[str]:
    return [
        line["text"].strip() for hunk in answer["hunks"] for line in hunk if line["kind"] == kind
    ]


async def write(document: Document, size: str) -> None:
    site = next(one for one in document.sites.sites.values() if one.name == "size")
    await document.edits.edit_site(site.id, size, "")


def test_edits_are_told_line_by_line_against_the_disk(tmp_path: Path):
    file = tmp_path / "r" / "r.xacro"
    file.parent.mkdir()
    file.write_text(ROBOT)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, file)
            assert (await changes(document))["hunks"] == []
            await write(document, "2")
            answer = await changes(document)
            assert lines(answer, "old") == ['<sphere radius="1" />']
            assert lines(answer, "new") == ['<sphere radius="2" />']
            assert (answer["added"], answer["removed"], answer["fault"]) == (1, 1, "")
            await document.saving.save()
            assert (await changes(document))["hunks"] == []
            await write(document, "3")
            assert lines(await changes(document), "old") == ['<sphere radius="2" />']

    asyncio.run(run())


def test_arguments_passed_since_the_opening_are_changes_too(tmp_path: Path):
    file = tmp_path / "r" / "r.xacro"
    file.parent.mkdir()
    file.write_text(ROBOT)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, file)
            await document.edits.pass_arguments({"tail": "true"})
            assert '<link name="tail" />' in lines(await changes(document), "new")

    asyncio.run(run())


def test_files_on_disk_that_do_not_run_are_said(tmp_path: Path):
    file = tmp_path / "r" / "r.xacro"
    file.parent.mkdir()
    file.write_text(ROBOT.replace('value="1"', 'value="${nothing}"'))

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, file)
            text = file.read_bytes()
            at = text.index(b"${nothing}")
            edit = type_edit(document, file, at, at + len(b"${nothing}"))
            await document.texts.edit(edit, Role.PRESENTER)
            assert (await changes(document))["fault"].startswith("The files on disk do not run")

    asyncio.run(run())


def type_edit(document: Document, file: Path, start: int, end: int) -> Any:  # noqa: ANN401
    told = document.texts.answer(GetText(file=str(file)), Role.PRESENTER)
    change = TextChange(start=start, end=end, text="1")
    return EditText(file=str(file), version=told.version, changes=(change,))


def test_the_urdf_is_written_off_the_event_loop(tmp_path: Path):
    file = tmp_path / "r" / "r.xacro"
    file.parent.mkdir()
    file.write_text(ROBOT)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, file)
            ear = Ear()
            with calls_here() as calls:
                await ask_document(document, GetUrdf(request=1), ear)
            assert '<link name="base">' in ear.last("urdf")["text"]
            assert calls["Commands.carry_out"]
            assert not calls["urdf_text"]

    asyncio.run(run())
