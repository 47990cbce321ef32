"""Names and words changed in all files at once, with real workers: one step, or a refusal."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import CommandError, EditError, ReadOnlyTextError
from studio.protocol.roles import Role
from studio.protocol.texts import FindTexts, GetRenaming, Rename, ReplaceTexts
from tests.support.asked import ask_document
from tests.support.open_documents import Ear, engine, opened
from tests.support.packages import write_package

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable
    from pathlib import Path

    from studio.documents.document import Document
    from studio.protocol import Command


MAST = """<robot name="mast" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="parts.xacro"/>
  <xacro:arg name="high" default="2"/>
  <xacro:property name="reach" value="0.4"/>
  <xacro:pole size="${reach * $(arg high)}"/>
</robot>
"""
PARTS = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="pole" params="size">
    <link name="pole"><visual><geometry><sphere radius="${size}"/></geometry></visual></link>
    <link name="foot"><visual><geometry><sphere radius="${reach}"/></geometry></visual></link>
    <joint name="j" type="fixed"><parent link="pole"/><child link="foot"/></joint>
  </xacro:macro>
</robot>
"""


def told(tmp_path: Path, story: Callable[[Document, Path, Path], Awaitable[None]]) -> None:
    """Have a story told of an open document and its two files."""
    files = {"urdf/mast.urdf.xacro": MAST, "urdf/parts.xacro": PARTS, "urdf/other.xacro": "reach"}
    package = write_package(tmp_path / "mast_description", files=files)
    mast, parts = package / "urdf" / "mast.urdf.xacro", package / "urdf" / "parts.xacro"

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            await story(document, mast, parts)

    asyncio.run(run())


async def asked(document: Document, command: Command, role: Role = Role.PRESENTER) -> Any:  # noqa: ANN401
    """What the asker was told."""
    ear = Ear(role)
    await ask_document(document, command, ear)
    return ear.events[-1] if ear.events else None


def text(document: Document, file: Path) -> str:
    return document.sources.text(str(file)).decode()


def test_a_property_is_renamed_in_two_files_as_one_step(tmp_path: Path):
    async def story(document: Document, mast: Path, parts: Path) -> None:
        place: dict[str, Any] = {"file": str(mast), "offset": MAST.index("reach")}
        answer = await asked(document, GetRenaming(**place, name="span", request=3))
        assert (answer["type"], answer["request"]) == ("renaming", 3)
        assert (answer["count"], answer["files"], answer["kind"]) == (3, 2, "property")
        urdf = await document.urdf.text()
        await asked(document, Rename(**place, name="span", count=3))
        assert text(document, mast) == MAST.replace("reach", "span")
        assert text(document, parts) == PARTS.replace("reach", "span")
        assert (await document.urdf.text()) == urdf
        assert document.sources.undo_labels == ("Rename reach → span",)
        await document.edits.undo()
        assert (text(document, mast), text(document, parts)) == (MAST, PARTS)
        assert document.sources.unsaved_files == ()

    told(tmp_path, story)


def test_an_arg_that_was_passed_is_passed_under_its_new_name(tmp_path: Path):
    async def story(document: Document, mast: Path, _parts: Path) -> None:
        await document.edits.pass_arguments({"high": "5"})
        urdf = await document.urdf.text()
        place: dict[str, Any] = {"file": str(mast), "offset": MAST.index("high")}
        await asked(document, Rename(**place, name="tall", count=2))
        assert document.sources.arguments == {"tall": "5"}
        assert (await document.urdf.text()) == urdf
        assert len(document.sources.undo_labels) == 2
        await document.edits.undo()
        assert document.sources.arguments == {"high": "5"}
        assert text(document, mast) == MAST

    told(tmp_path, story)


def test_a_renaming_is_refused_with_other_places_or_none(tmp_path: Path):
    async def story(document: Document, mast: Path, _parts: Path) -> None:
        place: dict[str, Any] = {"file": str(mast), "offset": MAST.index("reach")}
        with pytest.raises(CommandError, match="changed since"):
            await asked(document, Rename(**place, name="span", count=2))
        with pytest.raises(CommandError, match="is no name"):
            await asked(document, GetRenaming(**place, name="a-b"))
        assert text(document, mast) == MAST

    told(tmp_path, story)


def test_words_are_found_in_the_files_of_the_robot_alone(tmp_path: Path):
    async def story(document: Document, mast: Path, parts: Path) -> None:
        answer = await asked(document, FindTexts(text="REACH"), Role.GUEST)
        found = [(one["place"]["file"], one["place"]["line"]) for one in answer["places"]]
        assert found == [(str(mast), 4), (str(mast), 5), (str(parts), 4)]
        assert (answer["count"], answer["files"]) == (3, 2)

    told(tmp_path, story)


def test_words_are_replaced_as_one_step(tmp_path: Path):
    async def story(document: Document, mast: Path, parts: Path) -> None:
        command = ReplaceTexts(text="reach", replacement="r1", count=3, match_case=True)
        await asked(document, command)
        assert text(document, mast) == MAST.replace("reach", "r1")
        assert text(document, parts) == PARTS.replace("reach", "r1")
        assert document.sources.undo_labels == ("Replace reach → r1",)
        with pytest.raises(CommandError, match="changed since"):
            await asked(document, command)
        await document.edits.undo()
        assert text(document, parts) == PARTS

    told(tmp_path, story)


def test_a_text_does_not_grow_without_end(tmp_path: Path):
    async def story(document: Document, mast: Path, _parts: Path) -> None:
        for _ in range(2):
            count = text(document, mast).count("e") + text(document, _parts).count("e")
            command = ReplaceTexts(text="e", replacement="e" * 30, count=count, match_case=True)
            await asked(document, command)
        count = sum(text(document, file).count("e") for file in (mast, _parts))
        command = ReplaceTexts(text="e", replacement="e" * 1000, count=count, match_case=True)
        with pytest.raises((CommandError, EditError), match=r"too large|more than"):
            await asked(document, command)

    told(tmp_path, story)


def test_where_the_studio_may_only_read_nothing_is_written(tmp_path: Path):
    files = {"urdf/mast.urdf.xacro": MAST.replace("parts.xacro", "$(find parts)/parts.xacro")}
    package = write_package(tmp_path / "ws" / "mast_description", files=files)
    write_package(tmp_path / "ro" / "parts", files={"parts.xacro": PARTS})
    mast = package / "urdf" / "mast.urdf.xacro"

    async def run() -> None:
        async with engine(tmp_path / "data", tmp_path / "ro") as made:
            document, _ = await opened(made, mast)
            place: dict[str, Any] = {"file": str(mast), "offset": mast.read_text().index("reach")}
            with pytest.raises(ReadOnlyTextError):
                await asked(document, Rename(**place, name="span", count=3))
            assert not document.sources.undo_labels

    asyncio.run(run())


def test_commands_of_an_impossible_size_are_refused_at_the_door():
    with pytest.raises(ValueError, match="at most"):
        FindTexts(text="x" * 2000)
    with pytest.raises(ValueError, match="at least"):
        FindTexts(text="")
