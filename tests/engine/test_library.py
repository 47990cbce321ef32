"""Recent files, examples, uploads and new robots, with real documents and workers."""

from __future__ import annotations

import asyncio
import io
import json
import zipfile
from typing import TYPE_CHECKING, Any

import pytest

from studio.engine import messages as m
from studio.errors import CommandError, NotMadeError, PackageError, StudioError, UploadError
from studio.packages.recent import RecentFiles
from tests.support.open_documents import Ear, engine
from tests.support.packages import write_package

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Coroutine
    from pathlib import Path

    from studio.engine.document import Document
    from studio.engine.engine import Engine
    from studio.packages.skeleton import Template

ROBOT = b'<robot name="r"><link name="base"/></robot>'
WITH_MESH = (
    b'<robot name="r"><link name="base"><visual><geometry>'
    b'<mesh filename="package://parts/meshes/tyre.stl"/></geometry></visual></link></robot>'
)


def run(story: Coroutine[Any, Any, None]) -> None:
    asyncio.run(story)


async def asked(made: Engine, command: m.Command) -> dict[str, Any]:
    """The answer of a command, before its `done`."""
    ear = Ear()
    await made.execute(command, ear)
    assert ear.events[-1]["type"] == "done"
    return next(event for event in reversed(ear.events[:-1]) if "request" in event)


async def document_of(made: Engine, command: m.Command) -> Document:
    """The document that a command opened, once its robot and meshes are there."""
    document = made.document((await asked(made, command))["document"])
    await document.opened()
    return document


async def chunks(content: bytes) -> AsyncIterator[bytes]:
    for begin in range(0, len(content), 1000):
        yield content[begin : begin + 1000]


async def sent(made: Engine, files: dict[str, bytes]) -> Document:
    announced = [{"path": path, "size": len(content)} for path, content in files.items()]
    line, content = json.dumps(announced).encode(), b"".join(files.values())
    document = made.document(await made.library.take_upload(line, chunks(content)))
    await document.opened()
    return document


def zipped(files: dict[str, bytes]) -> bytes:
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as writer:
        for path, content in files.items():
            writer.writestr(path, content)
    return archive.getvalue()


def codes(document: Document) -> list[str]:
    ear = Ear()
    document.board.attach(ear)
    return [one["sentence"] for one in ear.last("problems")["problems"]]


@pytest.mark.parametrize(("template", "joints"), [("blank", 1), ("rover", 5), ("arm", 6)])
def test_a_new_robot_is_drawn_without_a_word_of_complaint(
    tmp_path: Path, template: Template, joints: int
):
    async def story() -> None:
        async with engine(tmp_path) as made:
            command = m.NewRobot(template=template, name="mine_description")
            document = await document_of(made, command)
            assert document.entry == tmp_path / "robots/mine_description/urdf/mine.urdf.xacro"
            assert len(document.model.robot.joints) == joints
            assert codes(document) == []
            assert not document.has_unsaved
            assert document.sources.text(document.path).startswith(b"<?xml")

    run(story())


def test_a_new_robot_goes_into_a_served_folder_and_nowhere_else(tmp_path: Path):
    own, foreign = tmp_path / "ws", tmp_path / "foreign"
    write_package(own / "there", files={"urdf/r.urdf": ROBOT.decode()})
    foreign.mkdir()

    async def story() -> None:
        async with engine(tmp_path / "data") as made:
            await made.open_path(own, {})
            places = await asked(made, m.ListPlaces())
            assert places["folders"] == [str(tmp_path / "data" / "robots"), str(own)]
            command = m.NewRobot(template="arm", name="new_arm", folder=str(own))
            document = await document_of(made, command)
            assert document.entry == own / "new_arm" / "urdf" / "new_arm.urdf.xacro"
            for folder in (foreign, own / ".." / "foreign", own / "missing"):
                with pytest.raises(PackageError):
                    await asked(made, m.NewRobot(template="arm", name="x_y", folder=str(folder)))
            assert list(foreign.iterdir()) == []

    run(story())


def test_a_pasted_text_is_an_untitled_document_until_it_is_saved_somewhere(tmp_path: Path):
    async def story() -> None:
        async with engine(tmp_path) as made:
            text = (
                '<link name="a"><visual><geometry><sphere radius="1"/></geometry></visual></link>'
            )
            first = await document_of(made, m.NewUntitled(text=text))
            second = await document_of(made, m.NewUntitled(text=text))
            assert [one.title for one in (first, second)] == ["Untitled 1", "Untitled 2"]
            assert set(first.model.robot.links) == {"a"}
            saved = await document_of(made, m.SaveAs(document=first.id, name="ball_description"))
            assert saved.entry == tmp_path / "robots/ball_description/urdf/ball.urdf.xacro"
            assert set(saved.model.robot.links) == {"a"}
            assert (tmp_path / "robots/ball_description/package.xml").is_file()
            assert first.id not in made.documents
            assert not first.entry.exists()
            assert second.entry.exists()

    run(story())


def test_saving_elsewhere_takes_the_unsaved_edits_along(tmp_path: Path):
    async def story() -> None:
        async with engine(tmp_path) as made:
            document = await document_of(made, m.NewUntitled(text=ROBOT.decode()))
            edit = m.TextChange(start=13, end=14, text="edited")
            version = await asked(made, m.GetText(document=document.id, file=document.path))
            command = m.EditText(
                document=document.id,
                file=document.path,
                version=version["version"],
                changes=(edit,),
            )
            ear = Ear()
            await made.execute(command, ear)
            saved = await document_of(
                made, m.SaveAs(document=document.id, name="saved", as_package=False)
            )
            assert saved.entry == tmp_path / "robots" / "saved.urdf.xacro"
            assert b'name="edited"' in saved.entry.read_bytes()
            with pytest.raises(NotMadeError, match="there already"):
                await asked(made, m.SaveAs(document=saved.id, name="saved", as_package=False))

    run(story())


def test_a_robot_of_many_files_is_not_torn_apart(tmp_path: Path):
    async def story() -> None:
        async with engine(tmp_path) as made:
            document = await document_of(made, m.OpenExample(name="rover_description"))
            with pytest.raises(CommandError, match="reads other files"):
                await asked(made, m.SaveAs(document=document.id, name="torn"))

    run(story())


def test_what_was_opened_is_remembered_and_opens_again_in_another_run(tmp_path: Path):
    file = tmp_path / "ws" / "robot.urdf"
    file.parent.mkdir()
    file.write_bytes(ROBOT)

    async def story() -> None:
        async with engine(tmp_path / "data") as made:
            await made.open_path(file, {"a": "1"})
            await asked(made, m.OpenExample(name="r2d2_description"))
        async with engine(tmp_path / "data") as made:
            listed = (await asked(made, m.ListRecent()))["files"]
            assert [(one["title"], one["origin"]) for one in listed] == [
                ("r2d2.urdf.xacro", "example"),
                ("robot.urdf", "file"),
            ]
            document = await document_of(made, m.OpenRecent(path=str(file)))
            assert document.sources.arguments == {"a": "1"}
            again = await document_of(made, m.OpenRecent(path=str(file)))
            assert again is document

    run(story())


def test_a_page_that_outlived_the_studio_opens_its_untitled_text_again(tmp_path: Path):
    async def story() -> None:
        async with engine(tmp_path) as made:
            path = (await document_of(made, m.NewUntitled(text=ROBOT.decode()))).path
        async with engine(tmp_path) as made:
            document = await document_of(made, m.OpenPath(path=path))
            assert document.title == "Untitled 1"
            with pytest.raises(PackageError, match="outside the opened folders"):
                await asked(made, m.OpenPath(path=str(tmp_path / "other.urdf")))

    run(story())


def test_only_what_was_opened_before_opens_as_a_recent_file(tmp_path: Path):
    secret = tmp_path / "secret.urdf"
    secret.write_bytes(ROBOT)

    async def story() -> None:
        async with engine(tmp_path / "data") as made:
            with pytest.raises(CommandError, match="not among the recent files"):
                await asked(made, m.OpenRecent(path=str(secret)))
            assert made.documents == {}

    run(story())


def test_a_recent_file_that_is_gone_is_marked_and_can_be_taken_out(tmp_path: Path):
    RecentFiles(tmp_path).note(str(tmp_path / "gone.urdf"), "gone.urdf", {}, 1.0)

    async def story() -> None:
        async with engine(tmp_path) as made:
            (one,) = (await asked(made, m.ListRecent()))["files"]
            assert not one["is_there"]
            with pytest.raises(PackageError, match="no longer there"):
                await asked(made, m.OpenRecent(path=one["path"]))
            assert (await asked(made, m.ForgetRecent(path=one["path"])))["files"] == []

    run(story())


def test_the_examples_open_as_copies(tmp_path: Path):
    async def story() -> None:
        async with engine(tmp_path) as made:
            names = [one["name"] for one in (await asked(made, m.ListExamples()))["examples"]]
            assert "rover_description" in names
            document = await document_of(made, m.OpenExample(name="xacro_robot_description"))
            assert document.entry.is_relative_to(tmp_path / "models")
            with pytest.raises(CommandError, match="no example"):
                await asked(made, m.OpenExample(name="../models/rover_description"))

    run(story())


def test_a_robot_dropped_with_its_meshes_finds_them(tmp_path: Path, models: Path):
    mesh = (models / "rover_description" / "meshes" / "tyre.stl").read_bytes()

    async def story() -> None:
        async with engine(tmp_path) as made:
            document = await sent(made, {"r.urdf": WITH_MESH, "tyre.stl": mesh})
            assert not [one for one in codes(document) if "Mesh" in one]
            assert any((tmp_path / "uploads").glob("*/parts/meshes/tyre.stl"))
            assert document.location.is_unpacked

    run(story())


def test_a_robot_dropped_without_its_meshes_says_which_package_is_missing(tmp_path: Path):
    async def story() -> None:
        async with engine(tmp_path) as made:
            document = await sent(made, {"r.urdf": WITH_MESH})
            ear = Ear()
            document.board.attach(ear)
            problems = ear.last("problems")["problems"]
            (missing,) = [one for one in problems if one["code"] == "mesh"]
            assert '"parts"' in missing["sentence"]
            assert missing["fix"]["action"] == "choose_package"
            assert missing["fix"]["target"] == "parts"

    run(story())


def test_a_dropped_zip_is_unpacked_and_opened(tmp_path: Path):
    manifest = b"<package><name>p</name></package>"
    content = zipped({"p/package.xml": manifest, "p/urdf/p.urdf": ROBOT})

    async def story() -> None:
        async with engine(tmp_path) as made:
            document = await sent(made, {"p.zip": content})
            assert set(document.model.robot.links) == {"base"}
            again = await sent(made, {"renamed.zip": content})
            assert again is document

    run(story())


def test_a_broken_description_is_opened_so_that_it_can_be_mended(tmp_path: Path):
    async def story() -> None:
        async with engine(tmp_path) as made:
            document = await sent(made, {"r.urdf": b'<robot name="r"><link name="a">'})
            assert codes(document) != []

    run(story())


HOSTILE = {
    "no robot": ({"notes.xml": b"<notes/>", "a.stl": b"solid"}, "no robot description"),
    "a link in a zip": ({"evil.zip": b""}, "is a link"),
    "a way out of a zip": ({"evil.zip": zipped({"../out.urdf": ROBOT})}, "leads outside"),
    "no zip": ({"evil.zip": b"not a zip"}, "it is no zip"),
    "a zip without a robot": ({"a.zip": zipped({"a.txt": b"a"})}, "no robot description"),
}


def zip_with_link() -> bytes:
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as writer:
        link = zipfile.ZipInfo("r.urdf")
        link.external_attr = 0o120777 << 16
        writer.writestr(link, "/etc/passwd")
    return archive.getvalue()


@pytest.mark.parametrize("what", HOSTILE)
def test_what_cannot_be_opened_is_said_and_leaves_no_document(tmp_path: Path, what: str):
    files, sentence = HOSTILE[what]
    if what == "a link in a zip":
        files = {"evil.zip": zip_with_link()}

    async def story() -> None:
        async with engine(tmp_path) as made:
            with pytest.raises(StudioError, match=sentence):
                await sent(made, files)
            assert made.documents == {}
            assert RecentFiles(tmp_path).all() == ()
            uploads = tmp_path / "uploads"
            assert not uploads.exists() or list(uploads.iterdir()) == []

    run(story())


def test_an_upload_that_is_cancelled_leaves_nothing(tmp_path: Path):
    async def breaks_off() -> AsyncIterator[bytes]:
        yield ROBOT[:5]
        raise ConnectionError

    async def story() -> None:
        async with engine(tmp_path) as made:
            line = json.dumps([{"path": "r.urdf", "size": len(ROBOT)}]).encode()
            with pytest.raises(ConnectionError):
                await made.library.take_upload(line, breaks_off())
            assert list((tmp_path / "uploads").iterdir()) == []
            with pytest.raises(UploadError, match="broke off"):
                await made.library.take_upload(line, chunks(ROBOT[:5]))
            assert list((tmp_path / "uploads").iterdir()) == []

    run(story())


def test_two_people_upload_at_once(tmp_path: Path):
    async def story() -> None:
        async with engine(tmp_path) as made:
            other = ROBOT.replace(b"base", b"other")
            same = [sent(made, {"r.urdf": ROBOT}) for _ in range(2)]
            first, second, third = await asyncio.gather(*same, sent(made, {"r.urdf": other}))
            assert first.entry == second.entry
            assert set(third.model.robot.links) == {"other"}

    run(story())
