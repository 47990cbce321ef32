"""Texts given out, typed into and followed, with real workers on real files."""

from __future__ import annotations

import asyncio
import os
from typing import TYPE_CHECKING, Any

import pytest

from studio.documents.texts import TEXT_LIMIT_BYTES
from studio.errors import (
    CommandError,
    EditError,
    OutsideRootsError,
    ReadOnlyTextError,
    StaleTextError,
)
from studio.protocol.roles import Role
from studio.protocol.texts import EditText, GetText, TextChange
from tests.support.asked import ask_document
from tests.support.open_documents import Ear, engine, opened, until
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document


MAST = """<?xml version="1.0"?>
<robot name="mast" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <!-- Größe 🤖 der Maße -->
  <xacro:property name="reach" value="0.4"/>
  <xacro:property name="width" value="0.1"/>
  <link name="base"><visual><geometry><box size="${width} 0.1 ${reach}"/></geometry></visual></link>
  <link name="tip"/>
  <joint name="hold" type="fixed">
    <parent link="base"/><child link="tip"/><origin xyz="0 0 ${reach}"/>
  </joint>
</robot>
"""
AWKWARD = b"\xef\xbb\xbf" + MAST.replace("\n", "\r\n").encode()


@pytest.fixture
def mast(tmp_path: Path) -> Path:
    package = write_package(tmp_path / "mast_description", files={"urdf/mast.urdf.xacro": ""})
    path = package / "urdf" / "mast.urdf.xacro"
    path.write_bytes(AWKWARD)
    return path


class Tab:
    """A browser tab with one text, which keeps it as the page does: by the changes it is told."""

    def __init__(self, document: Document, file: Path, role: Role = Role.PRESENTER) -> None:
        self.document, self.file, self.ear = document, str(file), Ear(role)
        document.attach(self.ear)
        told = document.texts.answer(GetText(file=self.file), role)
        self.text, self.version, self.read_only = told.text, told.version, told.read_only

    def follow(self) -> str:
        """The text after all that was told."""
        news = [event for event in self.ear.events if event["type"] == "texts_changed"]
        for event in news:
            if event["file"] == self.file and event["version"] > self.version:
                assert event["version"] == self.version + 1
                self.version = event["version"]
                self.text = _with(self.text, event["changes"])
        return self.text

    def change(self, old: str, new: str) -> TextChange:
        """The change that puts `new` where `old` stands for the first time."""
        start = _units(self.text[: self.text.index(old)])
        return TextChange(start=start, end=start + _units(old), text=new)

    async def type(self, *changes: TextChange, gesture: str = "", origin: str = "") -> None:
        """Send changes of the text as it stands here."""
        self.follow()
        command = EditText(
            file=self.file, version=self.version, changes=changes, gesture=gesture, origin=origin
        )
        await ask_document(self.document, command, self.ear)
        self.follow()


def _units(text: str) -> int:
    return len(text.encode("utf-16-le")) // 2


def _with(text: str, changes: list[dict[str, Any]]) -> str:
    units = text.encode("utf-16-le")
    for change in reversed(changes):
        new = change["text"].encode("utf-16-le")
        units = units[: 2 * change["start"]] + new + units[2 * change["end"] :]
    return units.decode("utf-16-le")


def height_of(document: Document) -> float:
    """Where the tip stands, m."""
    model = document.model
    return float(model.kinematics.wxyz_xyz(model.joints.values)[1, 6])


def test_typing_moves_the_robot_touches_only_its_bytes_and_is_one_step(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            tab = Tab(document, mast)
            assert tab.text == MAST
            await tab.type(tab.change('0.4"', '0."'), gesture="g")
            await tab.type(tab.change('0."', '0.5"'), gesture="g", origin="here")
            assert height_of(document) == pytest.approx(0.5)
            assert tab.ear.last("texts_changed")["origin"] == "here"
            late = document.texts.answer(GetText(file=tab.file), Role.PRESENTER)
            assert (late.text, late.saved) == (MAST.replace("0.4", "0.5"), MAST)
            assert document.sources.text(str(mast)) == AWKWARD.replace(b'"0.4"', b'"0.5"')
            assert tab.ear.last("history")["undo"] == ["Edit mast.urdf.xacro"]
            await document.edits.undo()
            assert tab.follow() == MAST
            assert document.sources.text(str(mast)) == AWKWARD
            assert height_of(document) == pytest.approx(0.4)

    asyncio.run(run())


def test_several_places_are_changed_at_once_and_undone_as_one_step(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            tab = Tab(document, mast)
            await tab.type(tab.change("der Maße", "dér 🤖\nMaße"), tab.change('"0.4"', '"0.75"'))
            assert tab.text == MAST.replace("der Maße", "dér 🤖\nMaße").replace("0.4", "0.75")
            assert height_of(document) == pytest.approx(0.75)
            assert "dér 🤖\r\nMaße".encode() in document.sources.text(str(mast))
            assert len(ear.last("history")["undo"]) == 1
            await document.edits.undo()
            assert document.sources.text(str(mast)) == AWKWARD

    asyncio.run(run())


def test_an_open_text_follows_sliders_undo_saving_and_the_disk(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            tab = Tab(document, mast)
            await document.edits.edit_site(ear.site("reach")["id"], "0.45", "drag")
            await document.edits.edit_site(ear.site("width")["id"], "0.2", "drag")
            assert tab.follow() == MAST.replace("0.4", "0.45").replace('"0.1"', '"0.2"')
            await document.edits.undo()
            assert tab.follow() == MAST
            mast.write_bytes(AWKWARD.replace(b'"0.4"', b'"0.9"'))
            await until(lambda: tab.follow() == MAST.replace("0.4", "0.9"))

    asyncio.run(run())


def test_an_edit_of_a_text_that_has_changed_since_is_refused(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            one, two = Tab(document, mast), Tab(document, mast)
            seen = two.change('"0.1"', '"0.3"')
            await one.type(one.change('"0.4"', '"0.123"'))
            stale = EditText(file=two.file, version=two.version, changes=(seen,))
            with pytest.raises(StaleTextError, match="was changed meanwhile"):
                await document.texts.edit(stale, Role.PRESENTER)
            assert two.follow() == one.text
            await two.type(two.change('"0.1"', '"0.3"'))
            assert (
                one.follow() == two.text == MAST.replace("0.4", "0.123").replace('"0.1"', '"0.3"')
            )
            await document.edits.edit_site(ear.site("reach")["id"], "0.2", "")
            with pytest.raises(StaleTextError):
                await document.texts.edit(
                    stale.model_copy(update={"version": one.version}), Role.PRESENTER
                )

    asyncio.run(run())


def test_broken_text_keeps_the_model_and_names_its_line_until_it_is_mended(
    mast: Path, tmp_path: Path
):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            tab = Tab(document, mast)
            whole = '<xacro:property name="reach" value="0.4"/>'
            await tab.type(tab.change(whole, ""), gesture="g")
            problems = tab.ear.last("problems")
            assert problems["showing_last_good"]
            assert problems["problems"][0]["place"]["file"] == str(mast)
            assert height_of(document) == pytest.approx(0.4)
            await tab.type(
                tab.change(
                    '  \n  <xacro:property name="w', f'  {whole}<\n  <xacro:property name="w'
                )
            )
            assert tab.ear.last("problems")["problems"][0]["place"]["line"] in {4, 5}
            await tab.type(tab.change(f"{whole}<", whole.replace("0.4", "0.6")))
            assert not tab.ear.last("problems")["showing_last_good"]
            assert height_of(document) == pytest.approx(0.6)

    asyncio.run(run())


def test_a_robot_that_never_opened_is_mended_by_typing(mast: Path, tmp_path: Path):
    mast.write_bytes(AWKWARD.replace(b"</robot>", b"${nothing}</robot>"))

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            assert document.last_run.phase == "failed"
            tab = Tab(document, mast)
            await tab.type(tab.change("${nothing}", ""))
            assert ear.last("document")["phase"] == "ready"
            assert height_of(document) == pytest.approx(0.4)

    asyncio.run(run())


def test_letters_that_come_during_a_run_all_count(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, mast)
            tab = Tab(document, mast)
            start = tab.change('0.4"', "").start
            tasks = [
                asyncio.ensure_future(
                    document.texts.edit(
                        EditText(
                            file=tab.file,
                            version=tab.version + number,
                            changes=(TextChange(start=start + 3, end=start + 3, text="1"),),
                            gesture="g",
                        ),
                        Role.PRESENTER,
                    )
                )
                for number in range(6)
            ]
            slider = document.edits.edit_site(ear.site("width")["id"], "0.25", "")
            await asyncio.gather(*tasks, slider)
            assert height_of(document) == pytest.approx(0.4111111)
            assert '"0.25"' in tab.follow()

    asyncio.run(run())


def test_a_file_that_no_run_has_read_is_edited_and_counts_once_it_is_included(
    mast: Path, tmp_path: Path
):
    part = mast.with_name("part.xacro")
    part.write_text('<robot><link name="one"/></robot>')

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            beside = Tab(document, part)
            await beside.type(beside.change('"one"', '"two"'))
            tab = Tab(document, mast)
            include = '<xacro:include filename="part.xacro"/></robot>'
            joint = '<joint name="j" type="fixed"><parent link="tip"/><child link="two"/></joint>'
            await tab.type(tab.change("</robot>", joint + include))
            assert "two" in document.model.robot.links
            await document.edits.undo()
            await document.edits.undo()
            assert beside.follow() == part.read_text()
            assert height_of(document) == pytest.approx(0.4)

    asyncio.run(run())


def test_texts_that_are_none_or_not_ours_are_refused_in_words(mast: Path, tmp_path: Path):
    mesh = mast.with_name("wheel.stl")
    mesh.write_bytes(b"solid\0\0\0")
    large = mast.with_name("large.xacro")
    large.write_bytes(b" " * (TEXT_LIMIT_BYTES + 1))
    outside = tmp_path / "outside.xacro"
    outside.write_text("<robot/>")
    way_out = mast.with_name("way_out.xacro")
    way_out.symlink_to(outside)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            for file, error, words in [
                (mesh, CommandError, "is no text"),
                (large, CommandError, "larger than 4 MB"),
                (outside, OutsideRootsError, "outside the opened folders"),
                (way_out, OutsideRootsError, "outside the opened folders"),
                ("mast.urdf.xacro", CommandError, "is no whole path"),
            ]:
                with pytest.raises(error, match=words):
                    document.texts.answer(GetText(file=str(file)), Role.PRESENTER)
            with pytest.raises(CommandError, match="is no file of this document"):
                document.texts.answer(GetText(file=str(mesh)), Role.GUEST)
            never_asked = EditText(
                file=str(mast), version=1, changes=(TextChange(start=0, end=0, text="x"),)
            )
            with pytest.raises(StaleTextError):
                await document.texts.edit(never_asked, Role.PRESENTER)

    asyncio.run(run())


def test_a_text_cannot_be_made_larger_than_an_editor_holds(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            tab = Tab(document, mast)
            with pytest.raises(EditError, match="would grow beyond 4 MB"):
                await tab.type(TextChange(start=0, end=0, text=" " * TEXT_LIMIT_BYTES))
            assert document.sources.text(str(mast)) == AWKWARD

    asyncio.run(run())


@pytest.mark.parametrize("places", [[(5, 9), (7, 8)], [(9, 10), (1, 2)], [(0, 10_000)], [(5, 4)]])
def test_changes_that_fit_no_text_change_nothing(
    mast: Path, tmp_path: Path, places: list[tuple[int, int]]
):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            tab = Tab(document, mast)
            changes = [TextChange(start=start, end=end, text="x") for start, end in places]
            with pytest.raises(EditError):
                await tab.type(*changes)
            assert document.sources.text(str(mast)) == AWKWARD

    asyncio.run(run())


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write every file")
def test_a_file_that_the_system_forbids_to_write_opens_read_only(mast: Path, tmp_path: Path):
    mast.chmod(0o444)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            tab = Tab(document, mast)
            assert "may only read" in tab.read_only
            with pytest.raises(ReadOnlyTextError):
                await tab.type(tab.change("0.4", "0.5"))

    asyncio.run(run())


def test_a_file_of_a_read_only_package_opens_with_the_reason_and_is_not_edited(
    mast: Path, tmp_path: Path
):
    shared = write_package(tmp_path / "elsewhere" / "parts", files={"part.xacro": "<robot/>"})
    include = b'<xacro:include filename="$(find parts)/part.xacro"/></robot>'
    mast.write_bytes(AWKWARD.replace(b"</robot>", include))

    async def run() -> None:
        async with engine(tmp_path / "data", tmp_path / "elsewhere") as made:
            document, _ = await opened(made, mast)
            tab = Tab(document, shared / "part.xacro", Role.GUEST)
            assert tab.text == "<robot/>"
            assert "it lies where the studio may only read" in tab.read_only
            with pytest.raises(ReadOnlyTextError, match="cannot be edited"):
                await tab.type(tab.change("<robot/>", "<robot></robot>"))
            assert Tab(document, mast).read_only == ""

    asyncio.run(run())


def test_letters_that_came_to_mean_others_with_the_encoding_are_told(mast: Path, tmp_path: Path):
    data = '<?xml version="1.0" encoding="iso-8859-1"?>\n<robot name="Maß"><link name="a"/></robot>'
    mast.write_bytes(data.encode("latin-1"))

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, mast)
            tab = Tab(document, mast)
            assert "Maß" in tab.text
            await tab.type(tab.change("iso-8859-1", "koi8-r"))
            assert tab.text == document.sources.text(str(mast)).decode("koi8-r")
            await document.edits.undo()
            assert tab.follow() == data

    asyncio.run(run())
