"""Recent files, examples, uploads and new robots, with real documents and workers."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import CommandError, NotMadeError, PackageError
from studio.packages.recent import RecentFiles
from studio.protocol.documents import (
    ForgetRecent,
    ListExamples,
    ListPlaces,
    ListRecent,
    NewRobot,
    NewUntitled,
    OpenExample,
    OpenPath,
    OpenRecent,
    SaveAs,
)
from studio.protocol.texts import EditText, GetText, TextChange
from tests.support.open_documents import Ear, engine
from tests.support.opening import ROBOT, asked, document_of, sentences
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.skeleton import Template


@pytest.mark.parametrize(("template", "joints"), [("blank", 1), ("rover", 5), ("arm", 6)])
def test_a_new_robot_is_drawn_without_a_word_of_complaint(
    tmp_path: Path, template: Template, joints: int
):
    async def story() -> None:
        async with engine(tmp_path) as made:
            command = NewRobot(template=template, name="mine_description")
            document = await document_of(made, command)
            assert document.entry == tmp_path / "robots/mine_description/urdf/mine.urdf.xacro"
            assert len(document.model.robot.joints) == joints
            assert sentences(document) == []
            assert not document.has_unsaved
            assert document.sources.text(document.path).startswith(b"<?xml")

    asyncio.run(story())


def test_a_new_robot_goes_into_a_served_folder_and_nowhere_else(tmp_path: Path):
    own, foreign = tmp_path / "ws", tmp_path / "foreign"
    write_package(own / "there", files={"urdf/r.urdf": ROBOT.decode()})
    foreign.mkdir()

    async def story() -> None:
        async with engine(tmp_path / "data") as made:
            await made.open_path(own, {})
            places = await asked(made, ListPlaces())
            assert places["folders"] == [str(tmp_path / "data" / "robots"), str(own)]
            command = NewRobot(template="arm", name="new_arm", folder=str(own))
            document = await document_of(made, command)
            assert document.entry == own / "new_arm" / "urdf" / "new_arm.urdf.xacro"
            for folder in (foreign, own / ".." / "foreign", own / "missing"):
                with pytest.raises(PackageError):
                    await asked(made, NewRobot(template="arm", name="x_y", folder=str(folder)))
            assert list(foreign.iterdir()) == []

    asyncio.run(story())


def test_a_pasted_text_is_an_untitled_document_until_it_is_saved_somewhere(tmp_path: Path):
    async def story() -> None:
        async with engine(tmp_path) as made:
            text = (
                '<link name="a"><visual><geometry><sphere radius="1"/></geometry></visual></link>'
            )
            first = await document_of(made, NewUntitled(text=text))
            second = await document_of(made, NewUntitled(text=text))
            assert [one.title for one in (first, second)] == ["Untitled 1", "Untitled 2"]
            assert set(first.model.robot.links) == {"a"}
            saved = await document_of(made, SaveAs(document=first.id, name="ball_description"))
            assert saved.entry == tmp_path / "robots/ball_description/urdf/ball.urdf.xacro"
            assert set(saved.model.robot.links) == {"a"}
            assert (tmp_path / "robots/ball_description/package.xml").is_file()
            assert first.id not in made.documents
            assert not first.entry.exists()
            assert second.entry.exists()

    asyncio.run(story())


def test_saving_elsewhere_takes_the_unsaved_edits_along(tmp_path: Path):
    async def story() -> None:
        async with engine(tmp_path) as made:
            document = await document_of(made, NewUntitled(text=ROBOT.decode()))
            edit = TextChange(start=13, end=14, text="edited")
            version = await asked(made, GetText(document=document.id, file=document.path))
            command = EditText(
                document=document.id,
                file=document.path,
                version=version["version"],
                changes=(edit,),
            )
            ear = Ear()
            await made.execute(command, ear)
            saved = await document_of(
                made, SaveAs(document=document.id, name="saved", as_package=False)
            )
            assert saved.entry == tmp_path / "robots" / "saved.urdf.xacro"
            assert b'name="edited"' in saved.entry.read_bytes()
            with pytest.raises(NotMadeError, match="there already"):
                await asked(made, SaveAs(document=saved.id, name="saved", as_package=False))

    asyncio.run(story())


def test_a_robot_of_many_files_is_not_torn_apart(tmp_path: Path):
    async def story() -> None:
        async with engine(tmp_path) as made:
            document = await document_of(made, OpenExample(name="rover_description"))
            with pytest.raises(CommandError, match="reads other files"):
                await asked(made, SaveAs(document=document.id, name="torn"))

    asyncio.run(story())


def test_what_was_opened_is_remembered_and_opens_again_in_another_run(tmp_path: Path):
    file = tmp_path / "ws" / "robot.urdf"
    file.parent.mkdir()
    file.write_bytes(ROBOT)

    async def story() -> None:
        async with engine(tmp_path / "data") as made:
            await made.open_path(file, {"a": "1"})
            await asked(made, OpenExample(name="r2d2_description"))
        async with engine(tmp_path / "data") as made:
            listed = (await asked(made, ListRecent()))["files"]
            assert [(one["title"], one["origin"]) for one in listed] == [
                ("r2d2.urdf.xacro", "example"),
                ("robot.urdf", "file"),
            ]
            document = await document_of(made, OpenRecent(path=str(file)))
            assert document.sources.arguments == {"a": "1"}
            again = await document_of(made, OpenRecent(path=str(file)))
            assert again is document

    asyncio.run(story())


def test_a_page_that_outlived_the_studio_opens_its_untitled_text_again(tmp_path: Path):
    async def story() -> None:
        async with engine(tmp_path) as made:
            path = (await document_of(made, NewUntitled(text=ROBOT.decode()))).path
        async with engine(tmp_path) as made:
            document = await document_of(made, OpenPath(path=path))
            assert document.title == "Untitled 1"
            with pytest.raises(PackageError, match="outside the opened folders"):
                await asked(made, OpenPath(path=str(tmp_path / "other.urdf")))

    asyncio.run(story())


def test_only_what_was_opened_before_opens_as_a_recent_file(tmp_path: Path):
    secret = tmp_path / "secret.urdf"
    secret.write_bytes(ROBOT)

    async def story() -> None:
        async with engine(tmp_path / "data") as made:
            with pytest.raises(CommandError, match="not among the recent files"):
                await asked(made, OpenRecent(path=str(secret)))
            assert made.documents == {}

    asyncio.run(story())


def test_a_recent_file_that_is_gone_is_marked_and_can_be_taken_out(tmp_path: Path):
    RecentFiles(tmp_path).note(str(tmp_path / "gone.urdf"), "gone.urdf", {}, 1.0)

    async def story() -> None:
        async with engine(tmp_path) as made:
            (one,) = (await asked(made, ListRecent()))["files"]
            assert not one["is_there"]
            with pytest.raises(PackageError, match="no longer there"):
                await asked(made, OpenRecent(path=one["path"]))
            assert (await asked(made, ForgetRecent(path=one["path"])))["files"] == []

    asyncio.run(story())


def test_the_examples_open_as_copies(tmp_path: Path):
    async def story() -> None:
        async with engine(tmp_path) as made:
            names = [one["name"] for one in (await asked(made, ListExamples()))["examples"]]
            assert "rover_description" in names
            document = await document_of(made, OpenExample(name="xacro_robot_description"))
            assert document.entry.is_relative_to(tmp_path / "models")
            with pytest.raises(CommandError, match="no example"):
                await asked(made, OpenExample(name="../models/rover_description"))

    asyncio.run(story())
