"""Links to a moment: the bag, the time, and how the page showed it."""

from __future__ import annotations

import asyncio
import shutil
from typing import TYPE_CHECKING

import pytest

from studio.documents.links import read_link
from studio.errors import CommandError, OutsideRootsError
from studio.protocol.documents import GetLink, Link, LinkCamera, LinkLook, LinkOpened, OpenLink
from studio.protocol.playback import GoLive, OpenBag, SeekTime
from tests.support.open_documents import Ear, engine, opened
from tests.support.packages import write_package
from tests.support.recorded_arm import BEGIN_NS, URDF, write_arm_bag

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.engine import Engine

LOOK = LinkLook(
    camera=LinkCamera(eye=(1.5, 0.0, 2.0), target=(0, 0, 0), up=(0, 0, 1), flat=False, field=0.8),
    part="link:upper",
    layout='{"parts": []}',
)


async def link_of(made: Engine, name: str) -> Link:
    ear = Ear()
    await made.execute(GetLink(document=name, look=LOOK), ear)
    return Link.model_validate(ear.last("link"))


async def follow(made: Engine, text: str) -> LinkOpened:
    ear = Ear()
    await made.execute(OpenLink(link=text), ear)
    return LinkOpened.model_validate(ear.last("link_opened"))


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A package with the arm, and a bag of it."""
    made = write_package(tmp_path / "arm_description", files={"urdf/arm.urdf": URDF})
    write_arm_bag(made / "bags" / "run")
    return made


def test_a_link_opens_the_bag_beside_the_robot_at_its_moment(package: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, package / "urdf/arm.urdf")
            bag = OpenBag(document=document.id, path=str(package / "bags" / "run"))
            await made.execute(bag, ear)
            await made.execute(SeekTime(document=document.id, at_s=7.123456789), ear)
            link = await link_of(made, document.id)
            assert (link.bag, link.at_s) == ("run", pytest.approx(7.123456789, abs=2e-9))
            at_ns = document.time.at_ns
            assert at_ns == pytest.approx(BEGIN_NS + 7_123_456_789, abs=2)
            told = await follow(made, link.text)
            other = made.document(told.document)
            assert (told.left_out, told.look) == ((), LOOK)
            assert other is not document
            assert other.time.at_ns == at_ns
            await made.execute(GoLive(document=document.id), ear)
            plain = await link_of(made, document.id)
            assert (plain.bag, plain.at_s) == ("", 0.0)
            assert read_link(plain.text).moment is None

    asyncio.run(run())


def test_a_link_to_a_bag_that_is_a_document_of_its_own_opens_that(package: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, package / "bags" / "run")
            await made.execute(SeekTime(document=document.id, at_s=3.0), ear)
            link = await link_of(made, document.id)
            await made.close_document(document, discard=False)
            told = await follow(made, link.text)
            assert told.left_out == ()
            assert made.document(told.document).time.at_ns == BEGIN_NS + 3_000_000_000

    asyncio.run(run())


def test_on_another_machine_the_bag_is_found_in_its_package_or_where_bags_are_recorded(
    package: Path, tmp_path: Path
):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, package / "urdf/arm.urdf")
            bag = OpenBag(document=document.id, path=str(package / "bags" / "run"))
            await made.execute(bag, ear)
            link = await link_of(made, document.id)
            bags = made.bags_folder
        moved = tmp_path / "elsewhere" / "arm_description"
        moved.parent.mkdir()
        package.rename(moved)
        async with engine(tmp_path / "data") as made:
            await opened(made, moved / "urdf/arm.urdf")
            told = await follow(made, link.text)
            assert told.left_out == ()
            assert made.document(told.document).time.path == str(moved / "bags" / "run")
            bags.mkdir(exist_ok=True)
            shutil.move(moved / "bags" / "run", bags / "run")
            told = await follow(made, link.text)
            assert told.left_out == ()
            assert made.document(told.document).time.path == str(bags / "run")
            shutil.rmtree(bags / "run")
            told = await follow(made, link.text)
            assert made.document(told.document).time.recording is None
            (sentence,) = told.left_out
            assert "a moment of run, which cannot be opened here" in sentence

    asyncio.run(run())


def test_a_link_opens_no_bag_that_may_not_be_opened(package: Path, tmp_path: Path):
    secret = tmp_path / "secret" / "run"
    write_arm_bag(secret)

    async def run() -> None:
        async with engine(tmp_path / "other") as made:
            theirs, _ = await opened(made, secret)
            own = await link_of(made, theirs.id)
        async with engine(tmp_path / "data") as made:
            await opened(made, package / "urdf/arm.urdf")
            with pytest.raises(OutsideRootsError):
                await made.execute(OpenBag(path=str(secret)), Ear())
            before = len(made.documents)
            with pytest.raises(CommandError, match="cannot be opened here"):
                await follow(made, own.text)
            assert len(made.documents) == before

    asyncio.run(run())
