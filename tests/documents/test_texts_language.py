"""An editor's questions with real workers: the text as typed, its odd bytes, and who may ask."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import CommandError, OutsideRootsError
from studio.protocol.language import Complete, GetOutline, GetReferences, LookUp
from studio.protocol.roles import Role
from studio.protocol.texts import EditText, GetText, TextChange
from tests.support.asked import ask_document
from tests.support.open_documents import Ear, engine, opened
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document
    from studio.protocol import Command


MAST = """<?xml version="1.0"?>
<robot name="mast" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <!-- Größe 🤖 der Maße -->
  <xacro:include filename="parts.xacro"/>
  <xacro:property name="reach" value="0.4"/>
  <xacro:pole size="${reach}"/>
</robot>
"""
PARTS = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="pole" params="size">
    <link name="pole"><visual><geometry><sphere radius="${size}"/></geometry></visual></link>
  </xacro:macro>
</robot>
"""


@pytest.fixture
def mast(tmp_path: Path) -> Path:
    files = {"urdf/mast.urdf.xacro": "", "urdf/parts.xacro": PARTS, "urdf/other.xacro": PARTS}
    package = write_package(tmp_path / "mast_description", files=files)
    path = package / "urdf" / "mast.urdf.xacro"
    path.write_bytes(b"\xef\xbb\xbf" + MAST.replace("\n", "\r\n").encode())
    return path


def offset(text: str, words: str) -> int:
    """The offset of the bar in words, as a browser counts."""
    before, _, behind = words.partition("|")
    index = text.index(before + behind) + len(before)
    return len(text[:index].encode("utf-16-le")) // 2


async def asked(document: Document, command: Command, role: Role = Role.PRESENTER) -> Any:  # noqa: ANN401
    """The answer to one command."""
    ear = Ear(role)
    await ask_document(document, command, ear)
    return ear.events[-1]


def test_a_word_is_looked_up_in_the_editors_own_count(tmp_path: Path, mast: Path):
    async def story() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            command = LookUp(file=str(mast), offset=offset(MAST, "${re|ach}"), request=7)
            answer = await asked(document, command)
            assert (answer["type"], answer["request"]) == ("meaning", 7)
            meaning = answer["meaning"]
            assert (meaning["kind"], meaning["values"], meaning["unit"]) == (
                "property",
                ["0.4"],
                "m",
            )
            assert meaning["start"] == offset(MAST, "${|reach}")
            (place,) = meaning["places"]
            line = MAST.split("\n")[int(place["line"]) - 1]
            assert line[place["column"] - 1 :][: place["length"]] == "reach"

    asyncio.run(story())


def test_a_definition_lies_in_the_included_file(tmp_path: Path, mast: Path):
    async def story() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            command = LookUp(file=str(mast), offset=offset(MAST, "<xacro:po|le"))
            (place,) = (await asked(document, command))["meaning"]["places"]
            assert (place["file"], place["line"]) == (str(mast.parent / "parts.xacro"), 2)
            references = GetReferences(
                file=place["file"], offset=offset(PARTS, 'name="po|le" params')
            )
            found = (await asked(document, references))["references"]
            assert [one["place"]["line"] for one in found["references"]] == [6, 2]

    asyncio.run(story())


def test_what_was_typed_a_moment_ago_is_completed_before_its_run_has_ended(
    tmp_path: Path, mast: Path
):
    async def story() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            text = document.texts.answer(GetText(file=str(mast)), Role.PRESENTER)
            typed = '<xacro:property name="new_one" value="1"/><link name="${new'
            at = offset(MAST, "|</robot>")
            change = TextChange(start=at, end=at, text=typed)
            edit = EditText(file=str(mast), version=text.version, changes=(change,))
            editing = asyncio.create_task(document.texts.edit(edit, Role.PRESENTER))
            await asyncio.sleep(0)
            command = Complete(file=str(mast), offset=at + len(typed))
            completions = (await asked(document, command))["completions"]
            assert [one["label"] for one in completions["items"]] == ["new_one"]
            assert completions["start"] == at + typed.index("${new") + 2
            await editing
            assert document.last_run.failed

    asyncio.run(story())


def test_the_outline_is_told_to_viewers_and_files_of_the_robot_are_explained_to_them(
    tmp_path: Path, mast: Path
):
    async def story() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            answer = await asked(document, GetOutline(), Role.GUEST)
            assert [one["name"] for one in answer["outline"]["macros"]] == ["pole"]
            at = offset(PARTS, "${si|ze}")
            known = LookUp(file=str(mast.parent / "parts.xacro"), offset=at)
            assert (await asked(document, known, Role.GUEST))["meaning"]["values"] == ["0.4"]
            other = LookUp(file=str(mast.parent / "other.xacro"), offset=at)
            assert (await asked(document, other))["meaning"]["kind"] == "parameter"
            with pytest.raises(CommandError, match="no file of this document"):
                await asked(document, other, Role.GUEST)

    asyncio.run(story())


def test_no_file_outside_the_folders_is_asked_about(tmp_path: Path, mast: Path):
    async def story() -> None:
        outside = tmp_path / "outside.xacro"
        outside.write_text(PARTS)
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            for kind in (LookUp, GetReferences, Complete):
                with pytest.raises(OutsideRootsError):
                    await asked(document, kind(file=str(outside), offset=0))

    asyncio.run(story())


def test_an_offset_beyond_the_text_is_refused(tmp_path: Path, mast: Path):
    async def story() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            with pytest.raises(CommandError, match="no place"):
                await asked(document, LookUp(file=str(mast), offset=10_000))

    asyncio.run(story())
