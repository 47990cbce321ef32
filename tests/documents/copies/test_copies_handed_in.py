"""What is handed in, downloaded and kept of copies, by students who mean no good."""

from __future__ import annotations

import asyncio
import io
import time
import zipfile
from typing import TYPE_CHECKING

import msgspec
import pytest

from studio.classroom import members
from studio.documents.copies import copies as module
from studio.errors import CommandError, StudioError
from studio.protocol.copies import DiscardCopy, HandIn, OpenCopy, SendBack, ShowCopy
from studio.protocol.documents import Watch
from studio.protocol.texts import EditText, GetText, TextChange
from tests.support.class_room import Room, run

if TYPE_CHECKING:
    from pathlib import Path


def test_a_hand_in_larger_than_a_copy_may_be_is_refused_and_nothing_of_it_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    async def work(room: Room) -> None:
        ada = await room.student("Ada")
        copy = await room.copy(ada)
        size = sum(len(copy.sources.text(file)) for file in copy.sources.files)
        monkeypatch.setattr(module, "TEXTS_MAX_BYTES", size - 1)
        with pytest.raises(CommandError, match="MB at most"):
            await room.ask(ada, HandIn(document=copy.id))
        assert room.engine.copies.handed_files() == []
        assert not list((tmp_path / "data").rglob("handed*"))

    run(tmp_path, work)


def test_a_text_that_reads_a_mesh_is_handed_in_without_the_mesh(tmp_path: Path):
    async def work(room: Room) -> None:
        ada = await room.student("Ada")
        copy = await room.copy(ada)
        await room.ask(ada, GetText(document=copy.id, file=copy.path))
        at = copy.sources.text(copy.path).decode().index("<!-- Chassis")
        reading = f'<xacro:include filename="{min(copy.mesh_files)}"/>'
        change = TextChange(start=at, end=at, text=reading)
        version = ada.last("text")["version"]
        await room.ask(
            ada, EditText(document=copy.id, file=copy.path, version=version, changes=(change,))
        )
        await room.ask(ada, HandIn(document=copy.id))
        assert {path.suffix for path in handed(room).values()} == {".xacro", ".yaml", ".json"}

    run(tmp_path, work)


def test_one_handed_in_by_two_pages_at_once_is_written_once_at_a_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    writing, together = list[object](), list[int]()
    write = module._write_handed  # pyright: ignore[reportPrivateUsage]

    def noted(folder: Path, texts: dict[str, bytes], joints: dict[str, float]) -> None:
        writing.append(folder)
        together.append(len(writing))
        write(folder, texts, joints)
        writing.pop()

    monkeypatch.setattr(module, "_write_handed", noted)

    async def work(room: Room) -> None:
        ada = await room.student("Ada")
        again, copy = room.page(ada.who), await room.copy(ada)
        hand_in = HandIn(document=copy.id)
        await asyncio.gather(room.ask(ada, hand_in), room.ask(again, hand_in))
        assert together == [1, 1]
        assert any(name.endswith("rover.urdf.xacro") for name in handed(room))

    run(tmp_path, work)


def handed(room: Room) -> dict[str, Path]:
    return dict(room.engine.copies.handed_files())


def zipped(room: Room) -> zipfile.ZipFile:
    """What the presenter downloads."""
    return zipfile.ZipFile(io.BytesIO(b"".join(room.engine.copies.download().chunks)))


def test_people_whose_names_become_one_in_a_zip_have_a_folder_each(tmp_path: Path):
    async def work(room: Room) -> None:
        for name in ("../../Ada", "..\\..\\Ada", "______Ada 2"):
            student = await room.student(name)
            await room.ask(student, HandIn(document=(await room.copy(student)).id))
        names = zipped(room).namelist()
        assert len(set(names)) == len(names)
        folders = {name.partition("/")[0] for name in names}
        assert folders == {"______Ada", "______Ada 2", "______Ada 2 2"}

    run(tmp_path, work)


def test_links_in_a_copy_are_neither_zipped_nor_followed(tmp_path: Path):
    secret = tmp_path / "secret" / "secret.txt"
    secret.parent.mkdir()
    secret.write_text("very secret")

    async def work(room: Room) -> None:
        ada, bob = await room.student("Ada"), await room.student("Bob")
        for student in (ada, bob):
            await room.ask(student, HandIn(document=(await room.copy(student)).id))
        before = zipped(room).namelist()
        copy = f"rover~{ada.person}"
        folder = tmp_path / "data/class-1" / ada.person / "rover"
        theirs = tmp_path / "data/class-1" / bob.person / "rover/handed/joints.json"
        for name, target in {"file": secret, "folder": secret.parent, "theirs": theirs}.items():
            (folder / "handed" / name).symlink_to(target)
            (folder / "src" / name).symlink_to(target)
        after = zipped(room)
        assert after.namelist() == before
        assert not any(b"secret" in after.read(name) for name in before)
        await room.ask(ada, HandIn(document=copy))
        assert zipped(room).namelist() == before
        await room.ask(ada, DiscardCopy(document=copy))
        assert not folder.exists()
        assert secret.read_text() == "very secret"
        assert theirs.exists()

    run(tmp_path, work)


IDS_THAT_LEAD_OUT = [
    "rover~../../x",
    "rover~..",
    "rover~../bob/rover",
    "../../x~ada",
    "..~..",
    "rover~/etc",
    "rover~",
    "rover~ada~../x",
    "rover~\0",
]


def test_no_id_leads_out_of_the_folder_of_copies(tmp_path: Path):
    async def work(room: Room) -> None:
        ada = await room.student("Ada")
        await room.ask(ada, HandIn(document=(await room.copy(ada)).id))
        (tmp_path / "data" / "x").mkdir()
        (tmp_path / "data" / "x" / "copy.json").write_text("{}")
        before = sorted(tmp_path.rglob("*"))
        for name in IDS_THAT_LEAD_OUT:
            for asker in (ada, room.presenter):
                for command in (
                    OpenCopy(document=name),
                    Watch(document=name),
                    HandIn(document=name),
                    SendBack(document=name, remark="x"),
                    ShowCopy(document=name),
                    DiscardCopy(document=name),
                ):
                    with pytest.raises(StudioError):
                        await room.ask(asker, command)
                    room.engine._rates._left.clear()  # pyright: ignore[reportPrivateUsage]
        assert sorted(tmp_path.rglob("*")) == before

    run(tmp_path, work)


def test_a_record_that_leads_out_is_left_out(tmp_path: Path):
    folder = tmp_path / "class-1"
    good = module.CopyRecord(
        of="rover",
        person="ada",
        title="rover",
        entry="src/rover.urdf",
        arguments={},
        meshes=(),
        joints={},
        made_s=1.0,
    )
    path = folder / "ada" / "rover" / "copy.json"
    path.parent.mkdir(parents=True)
    for changed, found in (
        ({}, ["rover~ada"]),
        ({"of": "../../x"}, []),
        ({"of": ".."}, []),
        ({"person": ".."}, []),
        ({"person": "bob"}, []),
        ({"entry": "src/../../../../x.urdf"}, []),
    ):
        path.write_bytes(msgspec.json.encode(msgspec.structs.replace(good, **changed)))
        read = module._read_all(folder)  # pyright: ignore[reportPrivateUsage]
        assert [name for name, _ in read] == found


def test_what_is_newer_stays_newer_though_the_clock_is_set_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    """The page compares both times, to tell whether a copy is with its owner again."""
    clock = Clock()
    monkeypatch.setattr(members, "time", clock)

    async def work(room: Room) -> None:
        ada = await room.student("Ada")
        copy = await room.copy(ada)
        times: list[float] = []
        for days in (0, -1, -2, 1, -400):
            clock.days = days
            await room.ask(ada, HandIn(document=copy.id))
            times.append(ada.last("my_copies")["copies"][0]["handed_s"])
            clock.days = -days
            await room.ask(room.presenter, SendBack(document=copy.id, remark="again"))
            times.append(ada.last("my_copies")["copies"][0]["remarked_s"])
            room.engine._rates._left.clear()  # pyright: ignore[reportPrivateUsage]
        assert times == sorted(set(times))

    run(tmp_path, work)


class Clock:
    """The system's clock, which somebody set forth or back by some days."""

    def __init__(self) -> None:
        self.days = 0

    def time_ns(self) -> int:
        return time.time_ns() + self.days * 86_400 * 10**9
