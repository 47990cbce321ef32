"""Copies of a shared rover: what they begin with, what they may read, and what becomes of them."""

from __future__ import annotations

import asyncio
import shutil
from typing import TYPE_CHECKING, Any

import pytest

from studio.documents.copies import copies as module
from studio.errors import (
    CommandError,
    NotInControlError,
    OutsideRootsError,
    StudioError,
    UnknownDocumentError,
)
from studio.protocol.classroom import GiveControl, ReturnControl, SetMemberRole
from studio.protocol.copies import DiscardCopy, HandIn, OpenCopy, SendBack, ShowCopy
from studio.protocol.displays import AddDisplay, RemoveDisplay, SwitchDisplays
from studio.protocol.documents import Watch
from studio.protocol.edits import EditSite, Undo
from studio.protocol.robot import SetJoints, ZeroJoints
from studio.protocol.roles import Role, Visitor
from studio.protocol.saving import Save, UndoTo
from studio.protocol.texts import EditText, GetText, TextChange
from studio.protocol.tools import AddTool
from studio.protocol.variants import SaveVariant
from tests.support.class_room import Page, Room, run
from tests.support.open_documents import until

if TYPE_CHECKING:
    from collections.abc import Coroutine
    from pathlib import Path

    from studio.documents.document import Document


def site(document: Document, name: str) -> str:
    return next(one.id for one in document.sites.event().changed if one.name.endswith(name))


def text_of(document: Document) -> bytes:
    return document.sources.text(document.path)


async def refused(work: Coroutine[Any, Any, None]) -> str:
    with pytest.raises(StudioError) as error:
        await work
    return type(error.value).__name__


def test_a_copy_begins_with_the_unsaved_robot_and_goes_its_own_way(tmp_path: Path):
    async def work(room: Room) -> None:
        radius = site(room.shared, "wheel_radius")
        await room.ask(room.presenter, EditSite(document="rover", site=radius, text="0.15"))
        await room.ask(
            room.presenter, SetJoints(document="rover", positions={"mast_pan_joint": 0.5})
        )
        ada = await room.student("Ada")
        copy = await room.copy(ada)
        assert b'name="wheel_radius" value="0.15"' in text_of(copy)
        assert copy.sources.arguments == {"wheels": "road"}
        joints = room.shared.model.joints.by_name()
        await until(lambda: copy.model.joints.by_name() == joints)
        assert copy.mesh_files
        assert not copy.scene.missing_meshes()
        own = EditSite(document=copy.id, site=site(copy, "base_length"), text="0.7")
        await room.ask(ada, own)
        assert b'"0.7"' not in text_of(room.shared)
        await room.ask(room.presenter, EditSite(document="rover", site=radius, text="0.08"))
        assert b'name="wheel_radius" value="0.15"' in text_of(copy)
        await room.ask(ada, SaveVariant(document=copy.id, name="Mine", note=""))
        assert not list((tmp_path / "rover_description").rglob("*.variants.yaml"))
        await room.ask(ada, Undo(document=copy.id))
        assert b'"0.7"' not in text_of(copy)

    run(tmp_path, work)


def test_a_copy_made_before_the_robot_has_run_waits_for_its_files(tmp_path: Path):
    async def work(room: Room) -> None:
        ada = await room.student("Ada")
        again = shutil.copytree(tmp_path / "rover_description", tmp_path / "again")
        other = await room.engine.open_path(again / "urdf/rover.urdf.xacro", {})
        await room.ask(ada, OpenCopy(document=other))
        copy = room.engine.document(ada.last("opened")["document"])
        await copy.opened()
        assert copy.last_run.expansion is not None
        assert len(copy.sources.files) == len(room.engine.document(other).sources.files)

    run(tmp_path, work)


def test_it_is_its_owners_alone_until_it_is_shown(tmp_path: Path):
    async def work(room: Room) -> None:
        ada, bob = await room.student("Ada"), await room.student("Bob")
        copy = await room.copy(ada)
        edit = EditSite(document=copy.id, site=site(copy, "wheel_radius"), text="0.1")
        assert await refused(room.ask(bob, edit)) == "UnknownDocumentError"
        assert await refused(room.ask(bob, Watch(document=copy.id))) == "UnknownDocumentError"
        shared = edit.model_copy(update={"document": "rover"})
        with pytest.raises(NotInControlError):
            await room.ask(ada, shared)
        await room.ask(room.presenter, Watch(document=copy.id))
        await room.ask(room.presenter, ShowCopy(document=copy.id))
        await room.ask(bob, Watch(document=copy.id))
        with pytest.raises(NotInControlError):
            await room.ask(bob, edit)
        await room.ask(room.presenter, ShowCopy(document=copy.id, shown=False))
        assert await refused(room.ask(bob, Watch(document=copy.id))) == "UnknownDocumentError"

    run(tmp_path, work)


def test_one_copy_at_a_time_is_shown_and_who_may_not_look_any_more_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(module, "_LOOK_EVERY_S", 0.05)

    def looks(page: Page, copy: Document) -> bool:
        return page in copy.audience

    async def work(room: Room) -> None:
        ada, bob, eve = [await room.student(name) for name in ("Ada", "Bob", "Eve")]
        of_ada, of_bob = await room.copy(ada), await room.copy(bob)
        for owner, copy in ((ada, of_ada), (bob, of_bob)):
            await room.ask(owner, Watch(document=copy.id))
        await room.ask(room.presenter, ShowCopy(document=of_ada.id))
        await room.ask(eve, Watch(document=of_ada.id))
        await room.ask(room.presenter, ShowCopy(document=of_bob.id, shown=False))
        assert looks(eve, of_ada)  # another one was hidden
        await room.ask(room.presenter, ShowCopy(document=of_bob.id))
        assert not looks(eve, of_ada)
        assert looks(ada, of_ada)
        assert eve.last("gone")["document"] == of_ada.id
        await room.ask(room.presenter, SetMemberRole(role="helper", person=eve.person))
        await room.ask(eve, Watch(document=of_ada.id))
        await room.ask(room.presenter, SetMemberRole(role="student", person=eve.person))
        await until(lambda: not looks(eve, of_ada))
        await room.ask(bob, DiscardCopy(document=of_bob.id))
        again = await room.copy(bob)
        assert await refused(room.ask(eve, Watch(document=again.id))) == "UnknownDocumentError"

    run(tmp_path, work)


@pytest.mark.parametrize(
    "text",
    [
        '<xacro:include filename="{secret}"/>',
        '<xacro:include filename="$(find rover_description)/secret.xacro"/>',
        "<link name=\"${xacro.load_yaml('{secret}')}\"/>",
        '<xacro:include filename="../../../../../../{secret}"/>',
    ],
)
def test_it_reads_the_files_that_the_shared_run_read_and_its_own_and_no_other(
    tmp_path: Path, text: str
):
    async def work(room: Room) -> None:
        secret = tmp_path / "rover_description" / "secret.xacro"
        secret.write_text('<robot><link name="very_secret"/></robot>')
        ada = await room.student("Ada")
        copy = await room.copy(ada)
        await room.ask(ada, GetText(document=copy.id, file=copy.path))
        version = ada.last("text")["version"]
        at = text_of(copy).decode().index("<!-- Chassis")
        change = TextChange(start=at, end=at, text=text.replace("{secret}", str(secret)))
        edit = EditText(document=copy.id, file=copy.path, version=version, changes=(change,))
        await room.ask(ada, edit)
        assert copy.last_run.failed
        assert b"very_secret" not in repr(copy.last_run.expansion).encode()
        assert (
            await refused(room.ask(ada, GetText(document=copy.id, file=str(secret))))
            == OutsideRootsError.__name__
        )

    run(tmp_path, work)


@pytest.mark.parametrize("name", ["secret.xacro", "secret.yaml", "run.py"])
def test_who_was_given_control_makes_it_read_no_other_files_until_the_presenter_saves(
    tmp_path: Path, name: str
):
    async def work(room: Room) -> None:
        secret = tmp_path / "rover_description" / name
        secret.write_text('<robot><link name="very_secret"/></robot>')
        ada = await room.student("Ada")
        give = GiveControl(person=ada.person, document="rover")
        await room.ask(room.presenter, give)
        shared = room.shared
        ask = GetText(document="rover", file=str(secret))
        await room.ask(ada, GetText(document="rover", file=shared.path))
        version = ada.last("text")["version"]
        reading = (
            f'<xacro:include filename="{secret}"/>'
            if name.endswith(".xacro")
            else f"<link name=\"${{xacro.load_yaml('{secret}')}}\"/>"
        )
        at = text_of(shared).decode().index("<!-- Chassis")
        change = TextChange(start=at, end=at, text=reading)
        edit = EditText(document="rover", file=shared.path, version=version, changes=(change,))
        await room.ask(ada, edit)
        assert shared.last_run.failed
        assert await refused(room.ask(ada, ask)) == "CommandError"
        await room.ask(ada, ReturnControl())
        radius = site(shared, "wheel_radius")
        await room.ask(room.presenter, EditSite(document="rover", site=radius, text="0.15"))
        assert shared.last_run.failed
        guest = room.page(Visitor(Role.GUEST, "g", room.classroom.control))
        assert await refused(room.ask(guest, ask)) == "CommandError"
        await room.ask(room.presenter, UndoTo(document="rover", position=0, of=2))
        await room.ask(room.presenter, Save(document="rover", files=None))
        await until(lambda: not shared.last_run.failed)

    run(tmp_path, work)


def test_what_a_student_wrote_reads_no_more_files_after_a_restart_either(tmp_path: Path):
    async def before(room: Room) -> None:
        secret = tmp_path / "rover_description" / "secret.xacro"
        secret.write_text('<robot><link name="very_secret"/></robot>')
        ada = await room.student("Ada")
        await room.ask(room.presenter, GiveControl(person=ada.person, document="rover"))
        await room.ask(ada, GetText(document="rover", file=room.shared.path))
        at = text_of(room.shared).decode().index("<!-- Chassis")
        reading = f'<xacro:include filename="{secret}"/>'
        edit = EditText(
            document="rover",
            file=room.shared.path,
            version=ada.last("text")["version"],
            changes=(TextChange(start=at, end=at, text=reading),),
        )
        await room.ask(ada, edit)
        await until(lambda: room.shared.last_run.failed)

    async def after(room: Room) -> None:
        shared = room.shared
        assert shared.has_unsaved
        assert shared.last_run.failed
        assert b"very_secret" not in repr(shared.last_run.expansion).encode()
        await room.ask(room.presenter, Save(document="rover", files=None))
        await until(lambda: not shared.last_run.failed)

    run(tmp_path, before)
    run(tmp_path, after)


def test_control_given_while_a_copy_is_looked_at_is_of_what_it_was_made_of(tmp_path: Path):
    async def work(room: Room) -> None:
        ada, bob = await room.student("Ada"), await room.student("Bob")
        copy = await room.copy(ada)
        await room.ask(room.presenter, GiveControl(person=bob.person, document=copy.id))
        assert room.classroom.control.document == room.shared.id
        zero = ZeroJoints(document=copy.id)
        assert await refused(room.ask(bob, zero)) == "UnknownDocumentError"

    run(tmp_path, work)


def test_control_is_of_the_document_that_it_was_given_for_alone(tmp_path: Path):
    async def work(room: Room) -> None:
        other_entry = tmp_path / "other" / "other.urdf"
        other_entry.parent.mkdir()
        other_entry.write_text('<robot name="o"><link name="base"/></robot>')
        other = await room.engine.open_path(other_entry, {})
        ada = await room.student("Ada")
        await room.ask(room.presenter, GiveControl(person=ada.person, document="rover"))
        for who, document, is_allowed in (
            (ada, "rover", True),
            (ada, other, False),
            (room.presenter, "rover", False),
            (room.presenter, other, True),
        ):
            save = Save(document=document, files=None)
            if is_allowed:
                await room.ask(who, save)
            else:
                assert await refused(room.ask(who, save)) == "NotInControlError"

    run(tmp_path, work)


def test_what_belongs_to_all_is_not_for_a_copy(tmp_path: Path):
    async def work(room: Room) -> None:
        ada = await room.student("Ada")
        copy = await room.copy(ada)
        for command in (
            Save(document=copy.id, files=None),
            AddDisplay(document=copy.id, kind="Axes", topic=""),
        ):
            with pytest.raises(CommandError, match="hand it in"):
                await room.ask(ada, command)
        for asker in (room.presenter, room.page(Visitor(Role.GUEST, "g"))):
            with pytest.raises(StudioError):
                await room.ask(asker, OpenCopy(document="rover"))

    run(tmp_path, work)


def test_it_shows_the_displays_that_the_class_has_whenever_they_change(tmp_path: Path):
    def names(document: Document) -> list[str]:
        return [one.name for one in document.live.kept.displays]

    async def work(room: Room) -> None:
        shared, add = room.shared, AddDisplay(document="rover", kind="Axes")
        await room.ask(room.presenter, add)
        ada = await room.student("Ada")
        copy = await room.copy(ada)
        assert names(copy) == names(shared) == ["Axes"]
        own = copy.live.kept.displays[0].id
        await room.ask(ada, SwitchDisplays(document=copy.id, display=own, enabled=False))
        await room.ask(room.presenter, AddDisplay(document="rover", kind="TF"))
        assert names(copy) == names(shared) == ["Axes", "TF"]
        assert [one.enabled for one in copy.live.kept.displays] == [False, True]
        first = shared.live.kept.displays[0].id
        await room.ask(room.presenter, RemoveDisplay(document="rover", display=first))
        assert names(copy) == names(shared) == ["TF"]

    run(tmp_path, work)


def test_it_has_the_tools_that_the_class_has_whenever_they_change(tmp_path: Path):
    async def work(room: Room) -> None:
        ada = await room.student("Ada")
        copy = await room.copy(ada)
        before = [one.id for one in copy.live.tools.kept]
        await room.ask(room.presenter, AddTool(document="rover", kind="SetGoal", name="Second"))
        tools = copy.live.tools.kept
        assert [one.id for one in tools[:-1]] == before  # one of them may be in hand
        assert (tools[-1].kind, tools[-1].name) == ("SetGoal", "Second")

    run(tmp_path, work)


def test_two_pages_that_ask_at_once_get_one_copy(tmp_path: Path):
    async def work(room: Room) -> None:
        ada = await room.student("Ada")
        again = room.page(ada.who)
        ask = OpenCopy(document="rover")
        await asyncio.gather(room.ask(ada, ask), room.ask(again, ask))
        assert ada.last("opened")["document"] == again.last("opened")["document"]

    run(tmp_path, work)


def test_it_is_handed_in_as_it_is_then_and_sent_back_with_a_remark(tmp_path: Path):
    async def work(room: Room) -> None:
        ada, bob = await room.student("Ada <b>"), await room.student("Bob")
        copy = await room.copy(ada)
        radius = site(copy, "wheel_radius")
        await room.ask(ada, EditSite(document=copy.id, site=radius, text="0.09"))
        await room.ask(ada, HandIn(document=copy.id))
        await room.ask(ada, EditSite(document=copy.id, site=radius, text="0.2"))
        (told,) = room.presenter.last("copies")["copies"]
        assert (told["name"], told["changes"], told["remark"]) == ("Ada <b>", 1, "")
        assert not [one for one in bob.events if one["type"] in {"copies", "my_copies"}]
        files = dict(room.engine.copies.handed_files())
        entry = files["Ada _b_/rover/rover_description/urdf/rover.urdf.xacro"]
        assert b'name="wheel_radius" value="0.09"' in entry.read_bytes()
        assert not any(".." in name or name.startswith("/") for name in files)
        remark = "Well done <script>alert(1)</script>"
        await room.ask(room.presenter, SendBack(document=copy.id, remark=remark))
        (own,) = ada.last("my_copies")["copies"]
        assert own["remark"] == remark
        with pytest.raises(StudioError):
            await room.ask(bob, SendBack(document=copy.id, remark="x"))

    run(tmp_path, work)


def test_what_nobody_looks_at_rests_and_is_back_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(module, "_LOOK_EVERY_S", 0.05)
    monkeypatch.setattr(module, "_REST_AFTER_S", 0.1)

    async def work(room: Room) -> None:
        ada = await room.student("Ada")
        copy = await room.copy(ada)
        await room.ask(ada, EditSite(document=copy.id, site=site(copy, "mast_height"), text="0.9"))
        joints = SetJoints(document=copy.id, positions={"mast_pan_joint": 0.25})
        await room.ask(ada, joints)
        expected, name = text_of(copy), copy.id
        room.engine.detach(ada)
        awake = room.engine.copies._awake  # pyright: ignore[reportPrivateUsage]
        await until(lambda: not awake)  # while it is being closed, another page comes
        back = await room.copy(room.page(ada.who))
        assert (back is copy, back.id, text_of(back)) == (False, name, expected)
        await until(lambda: back.model.joints.by_name()["mast_pan_joint"] == 0.25)

    run(tmp_path, work)


def test_copies_and_what_was_handed_in_are_there_after_the_studio_was_killed(tmp_path: Path):
    kept: dict[str, Any] = {}

    async def before(room: Room) -> None:
        ada = await room.student("Ada")
        copy = await room.copy(ada)
        await room.ask(ada, EditSite(document=copy.id, site=site(copy, "mast_height"), text="0.9"))
        await room.ask(ada, HandIn(document=copy.id))
        kept.update(text=text_of(copy), cookie=room.classroom.members.cookie_of(ada.who))  # type: ignore[arg-type]

    async def after(room: Room) -> None:
        ada = room.classroom.member_of_cookie(kept["cookie"])
        assert ada is not None
        page = room.page(ada)
        (own,) = page.last("my_copies")["copies"]
        assert own["changes"] == 1
        copy = await room.copy(page)
        await until(lambda: text_of(copy) == kept["text"])
        await room.classroom.end()
        assert not list((tmp_path / "data").glob("class-1*"))
        drafts = [one for one in (tmp_path / "data" / "drafts").rglob("*") if one.is_file()]
        assert all(one.suffix == ".lock" for one in drafts)
        with pytest.raises(UnknownDocumentError):
            room.engine.document(copy.id)

    run(tmp_path, before)
    run(tmp_path, after)


def test_a_copy_that_was_given_up_is_gone_and_the_next_begins_anew(tmp_path: Path):
    async def work(room: Room) -> None:
        ada = await room.student("Ada")
        copy = await room.copy(ada)
        await room.ask(ada, EditSite(document=copy.id, site=site(copy, "mast_height"), text="0.9"))
        await room.ask(ada, DiscardCopy(document=copy.id))
        again = await room.copy(ada)
        assert b'"0.9"' not in text_of(again)
        assert not again.has_unsaved

    run(tmp_path, work)


def test_the_texts_of_a_person_have_a_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    async def work(room: Room) -> None:
        ada, bob = await room.student("Ada"), await room.student("Bob")
        copy = await room.copy(ada)
        size = sum(len(copy.sources.text(file)) for file in copy.sources.files)
        monkeypatch.setattr(module, "TEXTS_MAX_BYTES", size)
        radius = site(copy, "wheel_radius")
        await room.ask(ada, EditSite(document=copy.id, site=radius, text="0.0123456789"))
        with pytest.raises(CommandError, match="at most"):
            await room.ask(ada, EditSite(document=copy.id, site=radius, text="0.2"))
        await room.ask(ada, Undo(document=copy.id))
        monkeypatch.setattr("studio.documents.copies.folder.TEXTS_MAX_BYTES", 1000)
        with pytest.raises(CommandError, match="at most"):
            await room.ask(bob, OpenCopy(document="rover"))

    run(tmp_path, work)
