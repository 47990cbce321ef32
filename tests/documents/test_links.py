"""Links that open the same robot again, and links that nobody should be harmed by."""

from __future__ import annotations

import asyncio
import base64
import hashlib
import json
import zlib
from typing import TYPE_CHECKING, Any

import pytest

from studio.documents.links import read_link
from studio.errors import CommandError
from studio.protocol.documents import GetLink, Link, OpenLink
from tests.support.open_documents import Ear, engine, opened
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.engine import Engine


MAST = """<robot name="mast" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <!-- Größe -->
  <xacro:arg name="flag" default="false"/>
  <xacro:property name="reach" value="0.4"/>
  <link name="base"/>
  <link name="tip"/>
  <joint name="hold" type="fixed">
    <parent link="base"/><child link="tip"/><origin xyz="0 0 ${reach}"/>
  </joint>
  <xacro:if value="$(arg flag)"><link name="flag"/></xacro:if>
</robot>
"""


@pytest.fixture
def mast(tmp_path: Path) -> Path:
    files = {"urdf/mast.urdf.xacro": MAST}
    return write_package(tmp_path / "mast_description", files=files) / "urdf/mast.urdf.xacro"


def packed(value: Any) -> str:  # noqa: ANN401 - whatever a stranger may put there
    data = zlib.compress(json.dumps(value).encode())
    return "1" + base64.urlsafe_b64encode(data).decode().rstrip("=")


async def link_of(made: Engine, name: str) -> Link:
    ear = Ear()
    await made.execute(GetLink(document=name), ear)
    return Link.model_validate(ear.last("link"))


async def follow(made: Engine, text: str) -> tuple[str, tuple[str, ...]]:
    ear = Ear()
    await made.execute(OpenLink(link=text), ear)
    told = ear.last("link_opened")
    return told["document"], tuple(told["left_out"])


def test_a_link_opens_the_same_robot_as_a_document_of_its_own(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast, flag="true")
            await document.edits.edit_site(ear.site("reach")["id"], "0.75", "")
            link = await link_of(made, document.id)
            assert (link.arguments, link.files, link.edits) == (1, (str(mast),), 1)
            assert len(link.text) < 600
            name, left_out = await follow(made, link.text)
            other = made.document(name)
            assert (name != document.id, left_out) == (True, ())
            assert (await other.urdf.text()) == (await document.urdf.text())
            assert other.sources.unsaved_count == 1
            assert other.sources.undo_labels == ("Edits of a link",)
            await other.edits.undo()
            assert (other.has_unsaved, document.has_unsaved) == (False, True)
            assert mast.read_text() == MAST

    asyncio.run(run())


def test_an_edit_finds_its_place_in_a_file_that_has_moved_on(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            await document.edits.edit_site(ear.site("reach")["id"], "0.75", "")
            text = (await link_of(made, document.id)).text
            await document.edits.undo()
            mast.write_text(MAST.replace("<link", "<!-- new --><link", 1))
            name, left_out = await follow(made, text)
            assert left_out == ()
            assert b'value="0.75"' in made.document(name).sources.text(str(mast))
            mast.write_text(MAST.replace('"0.4"', '"0.6"'))
            name, left_out = await follow(made, text)
            assert "found no place" in left_out[0]
            assert not made.document(name).has_unsaved

    asyncio.run(run())


@pytest.mark.parametrize(
    "text",
    [
        "",
        "1",
        "2abc",
        "1!!!!",
        packed([]),
        packed({"entry": {"path": "/x"}, "more": 1}),
        packed({"entry": {"path": "/x"}, "arguments": {"": "1"}}),
        packed({"entry": {"path": "/x"}, "arguments": {"a" * 201: "1"}}),
    ],
)
def test_what_is_no_link_is_refused_in_words(text: str):
    with pytest.raises(CommandError):
        read_link(text)


def test_a_link_that_unpacks_to_gigabytes_is_refused():
    bomb = base64.urlsafe_b64encode(zlib.compress(b" " * (50 << 20))).decode()
    with pytest.raises(CommandError, match="too large"):
        read_link(f"1{bomb}")


def test_a_link_reaches_no_file_outside_of_what_is_served(mast: Path, tmp_path: Path):
    outside = tmp_path / "outside.urdf.xacro"
    outside.write_text(MAST)
    edit = {"at": 0, "old": "", "new": "x"}

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            await opened(made, mast)
            with pytest.raises(CommandError):
                await follow(made, packed({"entry": {"path": str(outside)}}))
            inside = {"file": {"path": str(outside)}, "digest": "", "edits": [edit]}
            shared = {"entry": {"path": str(mast)}, "files": [inside]}
            name, left_out = await follow(made, packed(shared))
            assert "not in the opened folders" in left_out[0]
            assert not made.document(name).has_unsaved
            assert outside.read_text() == MAST

    asyncio.run(run())


def test_edits_of_a_link_that_overlap_are_left_out_together(mast: Path, tmp_path: Path):
    data = MAST.encode()
    at, digest = data.index(b'value="0.4"'), hashlib.sha256(data).hexdigest()[:32]
    edits = [
        {"at": at, "old": 'value="0.4"', "new": "v"},
        {"at": at + 7, "old": "0.4", "new": "0.5"},
    ]

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            shared = {"file": {"path": str(mast)}, "digest": digest, "edits": edits}
            robot = {"entry": {"path": str(mast)}, "files": [shared]}
            await opened(made, mast)
            name, left_out = await follow(made, packed(robot))
            assert left_out == (f"{mast}: the link's edits overlap; they were left out.",)
            assert not made.document(name).has_unsaved
            shared["edits"] = edits[1:]
            name, left_out = await follow(made, packed(robot))
            assert left_out == ()
            assert b'value="0.5"' in made.document(name).sources.text(str(mast))

    asyncio.run(run())
