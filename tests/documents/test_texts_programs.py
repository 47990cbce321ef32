"""Programs in Source: the owner's alone, only by --allow-run, and saved as other texts are."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import (
    CommandError,
    NotAllowedError,
    NotSavedError,
    PackageError,
    ReadOnlyTextError,
)
from studio.protocol.edits import EditSite, Redo, Undo
from studio.protocol.roles import Role
from studio.protocol.saving import Reload, Save, SaveCopy, UndoTo
from studio.protocol.texts import EditText, GetText, ReplaceTexts, TextChange
from tests.support.open_documents import Ear, until
from tests.support.run_studio import run_studio, workspace

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document
    from tests.support.run_studio import RunStudio


async def opened(studio: RunStudio, ws: Path) -> Document:
    document = studio.engine.document(await studio.engine.open_path(ws, {}))
    document.attach(studio.ear)
    await document.opened()
    return document


def typed(file: Path, version: int = 1, text: str = "# typed\n") -> EditText:
    change = TextChange(start=0, end=0, text=text)
    return EditText(document="ws", file=str(file), version=version, changes=(change,))


def test_an_empty_folder_opens_where_it_may_be_run_for_its_first_package_is_made_there(
    tmp_path: Path,
):
    async def run() -> None:
        ws, other = tmp_path / "ws", tmp_path / "other"
        ws.mkdir()
        other.mkdir()
        async with run_studio(tmp_path / "data", ws) as studio:
            await opened(studio, ws)
            assert studio.ear.last("document")["is_bare"]
            with pytest.raises(CommandError, match="holds no robot description"):
                await opened(studio, other)

    asyncio.run(run())


def test_a_folder_of_packages_without_a_robot_opens_with_its_texts(tmp_path: Path):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        node = ws / "src/talk/talk/speaker.py"
        async with run_studio(tmp_path / "data", ws) as studio:
            document = await opened(studio, ws)
            state = studio.ear.last("document")
            assert (state["title"], state["is_bare"], state["root"]) == ("ws", True, str(ws))
            assert document.last_run.phase == "ready"
            await studio.ask(GetText(document="ws", file=str(node)))
            await studio.ask(typed(node))
            assert studio.ear.last("history")["unsaved_files"] == [str(node)]
            await studio.ask(Save(document="ws"))
            assert node.read_text().startswith("# typed\n")
            again = await studio.engine.open_at(ws, {}, None)
            assert again == "ws"  # the same, not a second one

    asyncio.run(run())


def test_a_folder_that_holds_nothing_is_not_opened(tmp_path: Path):
    async def run() -> None:
        (tmp_path / "empty").mkdir()
        async with run_studio(tmp_path / "data") as studio:
            with pytest.raises(CommandError, match="no robot description"):
                await studio.engine.open_path(tmp_path / "empty", {})

    asyncio.run(run())


def test_it_is_among_the_recent_ones_by_its_folder(tmp_path: Path):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        async with run_studio(tmp_path / "data", ws) as studio:
            await opened(studio, ws)
            assert studio.engine.library.may_reopen(str(ws))

    asyncio.run(run())


def test_what_another_editor_writes_into_a_program_is_taken_over(tmp_path: Path):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        node = ws / "src/talk/talk/speaker.py"
        async with run_studio(tmp_path / "data", ws) as studio:
            await opened(studio, ws)
            await studio.ask(GetText(document="ws", file=str(node)))
            node.write_text(node.read_text() + "# elsewhere\n")
            await until(lambda: any(one["type"] == "texts_changed" for one in studio.ear.events))
            assert studio.ear.last("texts_changed")["changes"][0]["text"] == "# elsewhere\n"
            await studio.ask(typed(node, version=2))
            node.write_text("# all anew\n")
            await until(lambda: _codes(studio) == ["changed-on-disk"])

    asyncio.run(run())


def _codes(studio: RunStudio) -> list[str]:
    problems = studio.ear.last("problems")["problems"]
    return [one["code"] for one in problems if one["code"] == "changed-on-disk"]


def test_without_the_option_a_program_can_be_read_and_nothing_else(tmp_path: Path):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        node, manifest = ws / "src/talk/talk/speaker.py", ws / "src/talk/package.xml"
        async with run_studio(tmp_path / "data") as studio:
            await opened(studio, ws)
            told = await studio.ask(GetText(document="ws", file=str(node)))
            assert "--allow-run" in told["read_only"]
            with pytest.raises(ReadOnlyTextError, match="--allow-run"):
                await studio.ask(typed(node))
            told = await studio.ask(GetText(document="ws", file=str(manifest)))
            assert told["read_only"] == ""
            copy = ws / "src/talk/talk/copied.py"
            with pytest.raises(NotSavedError, match="program"):
                await studio.ask(SaveCopy(document="ws", file=str(manifest), path=str(copy)))

    asyncio.run(run())


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("CMakeLists.txt", "project(talk)\n"),
        ("scripts/node", "#!/usr/bin/env python3\n"),
        ("bringup/more.xml", "<!-- with a word before -->\n<launch/>\n"),
        ("bringup/more.yaml", "launch: []\n"),
        ("bringup/more.launch", "<launch/>\n"),
    ],
)
def test_without_the_option_no_program_is_edited_whatever_its_name(
    tmp_path: Path, name: str, text: str
):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        file = ws / "src" / "talk" / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(text)
        async with run_studio(tmp_path / "data") as studio:
            await opened(studio, ws)
            await studio.ask(GetText(document="ws", file=str(file)))
            with pytest.raises(ReadOnlyTextError, match="--allow-run"):
                await studio.ask(typed(file))
        async with run_studio(tmp_path / "data", ws) as studio:
            await opened(studio, ws)
            await studio.ask(GetText(document="ws", file=str(file)))
            await studio.ask(typed(file))
            await studio.ask(Save(document="ws"))
            assert file.read_text() == f"# typed\n{text}"

    asyncio.run(run())


def test_who_has_control_and_owns_nothing_touches_no_program(tmp_path: Path):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        node = ws / "src/talk/talk/speaker.py"
        async with run_studio(tmp_path / "data", ws) as studio:
            await opened(studio, ws)
            await studio.ask(GetText(document="ws", file=str(node)))
            await studio.ask(typed(node))
            before = node.read_bytes()
            student = Ear(Role.STUDENT)
            asked = [
                GetText(document="ws", file=str(node)),
                typed(node, version=2),
                Undo(document="ws"),
                UndoTo(document="ws", position=0, of=1),
                Reload(document="ws"),
                Save(document="ws", files=(str(node),)),
            ]
            for command in asked:
                with pytest.raises((NotAllowedError, CommandError, PackageError)):
                    await studio.engine.execute(command, student)
            await studio.engine.execute(Save(document="ws"), student)  # all that is theirs
            assert node.read_bytes() == before
            await studio.ask(Undo(document="ws"))
            with pytest.raises(NotAllowedError):
                await studio.engine.execute(Redo(document="ws"), student)

    asyncio.run(run())


@pytest.mark.parametrize("name", ["launch/more.launch.xml", "bringup/more.xml"])
def test_no_value_and_no_replacement_writes_into_a_launch_file_that_a_robot_includes(
    tmp_path: Path, name: str
):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        launch = ws / "src" / "talk" / name
        launch.parent.mkdir(exist_ok=True)
        xacro = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
        text = (
            f'<launch {xacro}><xacro:property name="p" value="1"/>'
            '<node pkg="talk" exec="speaker"/></launch>\n'
        )
        launch.write_text(text)
        robot = ws / "src" / "talk" / "r.urdf.xacro"
        robot.write_text(
            f'<robot {xacro} name="r"><link name="base"/>'
            f'<xacro:include filename="{name}"/></robot>\n'
        )
        async with run_studio(tmp_path / "data", ws) as studio:
            document = await opened(studio, robot)
            assert str(launch) in document.workspace.sources.files
            student = Ear(Role.STUDENT)
            site = studio.ear.site("p")["id"]
            await studio.ask(GetText(document=document.id, file=str(launch)))
            change = TextChange(start=0, end=0, text="<!-- typed -->")
            edit = EditText(document=document.id, file=str(launch), version=1, changes=(change,))
            with pytest.raises(NotAllowedError):
                await studio.engine.execute(edit, student)
            for command in (
                EditSite(document=document.id, site=site, text="2"),
                ReplaceTexts(
                    document=document.id, text='exec="speaker"', replacement='exec="evil"', count=1
                ),
            ):
                with pytest.raises(ReadOnlyTextError, match="it is a program"):
                    await studio.engine.execute(command, student)
            assert document.workspace.sources.unsaved_files == ()
        assert launch.read_text() == text

    asyncio.run(run())
