"""Dropped robots, with real documents and workers."""

from __future__ import annotations

import asyncio
import io
import json
import zipfile
from typing import TYPE_CHECKING

import pytest

from studio.errors import StudioError, UploadError
from studio.packages.recent import RecentFiles
from tests.support.open_documents import Ear, engine
from tests.support.opening import ROBOT, sentences
from tests.support.recorded_arm import BEGIN_NS, write_arm_bag

if TYPE_CHECKING:
    from collections.abc import AsyncIterator
    from pathlib import Path

    from studio.documents.document import Document
    from studio.documents.engine import Engine

WITH_MESH = (
    b'<robot name="r"><link name="base"><visual><geometry>'
    b'<mesh filename="package://parts/meshes/tyre.stl"/></geometry></visual></link></robot>'
)


async def chunks(content: bytes) -> AsyncIterator[bytes]:
    for begin in range(0, len(content), 1000):
        yield content[begin : begin + 1000]


async def sent(made: Engine, files: dict[str, bytes], beside: str = "") -> Document:
    announced = [{"path": path, "size": len(content)} for path, content in files.items()]
    line, content = json.dumps(announced).encode(), b"".join(files.values())
    document = made.document(await made.uploads.take(line, chunks(content), beside))
    await document.opened()
    return document


def zipped(files: dict[str, bytes]) -> bytes:
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as writer:
        for path, content in files.items():
            writer.writestr(path, content)
    return archive.getvalue()


def test_a_robot_dropped_with_its_meshes_finds_them(tmp_path: Path, models: Path):
    mesh = (models / "rover_description" / "meshes" / "tyre.stl").read_bytes()

    async def story() -> None:
        async with engine(tmp_path) as made:
            document = await sent(made, {"r.urdf": WITH_MESH, "tyre.stl": mesh})
            assert not [one for one in sentences(document) if "Mesh" in one]
            assert any((tmp_path / "uploads").glob("*/parts/meshes/tyre.stl"))
            assert document.location.is_unpacked

    asyncio.run(story())


def test_a_robot_dropped_without_its_meshes_says_which_package_is_missing(tmp_path: Path):
    async def story() -> None:
        async with engine(tmp_path) as made:
            document = await sent(made, {"r.urdf": WITH_MESH})
            ear = Ear()
            document.attach(ear)
            problems = ear.last("problems")["problems"]
            (missing,) = [one for one in problems if one["code"] == "mesh"]
            assert '"parts"' in missing["sentence"]
            assert missing["fix"]["action"] == "choose_package"
            assert missing["fix"]["target"] == "parts"

    asyncio.run(story())


def test_a_dropped_zip_is_unpacked_and_opened(tmp_path: Path):
    manifest = b"<package><name>p</name></package>"
    content = zipped({"p/package.xml": manifest, "p/urdf/p.urdf": ROBOT})

    async def story() -> None:
        async with engine(tmp_path) as made:
            document = await sent(made, {"p.zip": content})
            assert set(document.model.robot.links) == {"base"}
            again = await sent(made, {"renamed.zip": content})
            assert again is document

    asyncio.run(story())


def test_a_broken_description_is_opened_so_that_it_can_be_mended(tmp_path: Path):
    async def story() -> None:
        async with engine(tmp_path) as made:
            document = await sent(made, {"r.urdf": b'<robot name="r"><link name="a">'})
            assert sentences(document) != []

    asyncio.run(story())


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

    asyncio.run(story())


def test_an_upload_that_is_cancelled_leaves_nothing(tmp_path: Path):
    async def breaks_off() -> AsyncIterator[bytes]:
        yield ROBOT[:5]
        raise ConnectionError

    async def story() -> None:
        async with engine(tmp_path) as made:
            line = json.dumps([{"path": "r.urdf", "size": len(ROBOT)}]).encode()
            with pytest.raises(ConnectionError):
                await made.uploads.take(line, breaks_off())
            assert list((tmp_path / "uploads").iterdir()) == []
            with pytest.raises(UploadError, match="broke off"):
                await made.uploads.take(line, chunks(ROBOT[:5]))
            assert list((tmp_path / "uploads").iterdir()) == []

    asyncio.run(story())


def test_two_people_upload_at_once(tmp_path: Path):
    async def story() -> None:
        async with engine(tmp_path) as made:
            other = ROBOT.replace(b"base", b"other")
            same = [sent(made, {"r.urdf": ROBOT}) for _ in range(2)]
            first, second, third = await asyncio.gather(*same, sent(made, {"r.urdf": other}))
            assert first.entry == second.entry
            assert set(third.model.robot.links) == {"other"}

    asyncio.run(story())


@pytest.mark.parametrize("how", ["file", "folder", "zip"])
def test_a_dropped_bag_is_opened_at_its_beginning(tmp_path: Path, how: str):
    bag = write_arm_bag(tmp_path / "run")
    files = {f"run/{one.name}": one.read_bytes() for one in bag.iterdir()}
    if how == "file":
        files = {
            name.removeprefix("run/"): data for name, data in files.items() if "yaml" not in name
        }
    elif how == "zip":
        files = {"run.zip": zipped(files)}

    async def story() -> None:
        async with engine(tmp_path / "data") as made:
            document = await sent(made, files)
            assert document.time.recording is not None
            assert document.time.at_ns == BEGIN_NS
            assert document.model.kinematics.movable == ("shoulder",)

    asyncio.run(story())


@pytest.mark.parametrize("how", ["folder", "zip"])
def test_a_bag_dropped_beside_a_robot_moves_it(tmp_path: Path, how: str):
    bag = write_arm_bag(tmp_path / "run")
    files = {f"run/{one.name}": one.read_bytes() for one in bag.iterdir()}
    if how == "zip":
        files = {"run.zip": zipped(files)}

    async def story() -> None:
        async with engine(tmp_path / "data") as made:
            robot = await sent(made, {"r.urdf": ROBOT})
            assert robot.time.recording is None
            assert await sent(made, files, robot.id) is robot
            assert robot.time.at_ns == BEGIN_NS
            with pytest.raises(StudioError):
                await sent(made, files, "nobody")
            assert len(made.documents) == 1

    asyncio.run(story())
