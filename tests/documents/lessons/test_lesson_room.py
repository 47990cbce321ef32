"""Lessons read in a class: what turns green for whom, what is kept, and what the teacher sees."""

from __future__ import annotations

import asyncio
import threading
from typing import TYPE_CHECKING, Any

import pytest

from studio.course.lessons.shelf import Shelf
from studio.documents.lessons import lesson_room as module
from studio.errors import CommandError, LessonError, StudioError
from studio.protocol.classroom import EndClass
from studio.protocol.copies import ShowCopy
from studio.protocol.documents import Watch
from studio.protocol.edits import EditSite, Undo
from studio.protocol.lessons import (
    CloseLesson,
    DeleteLesson,
    GetLessons,
    GetLessonTable,
    GetLessonText,
    OpenLesson,
    ReadLesson,
    SaveLesson,
    SawPanel,
)
from studio.protocol.texts import EditText, GetText, TextChange
from tests.support.class_room import Page, Room, run
from tests.support.open_documents import until

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from studio.course.lessons.shelf import Lesson
    from studio.documents.document import Document
    from studio.documents.lessons.verdict import Verdict

WHEEL = """# The wheel

check: property wheel_radius is 0.15
check: no errors

## Then

check: opened origin

check: node /talker runs
"""
MODEL = """# Checks of a model

check: argument wheels is road
check: argument nothing is road
check: property mast_height is 0.5
check: link mast is there
check: link tail is there
check: link base_link has 7 children
check: link base_link has 1 child
check: joint mast_pan_joint is revolute
check: joint mast_pan_joint is fixed
check: no errors
"""


@pytest.fixture(autouse=True)
def look_often(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(module, "_LOOK_EVERY_S", 0.02)


def given(tmp_path: Path, text: str = WHEEL, name: str = "wheel") -> Path:
    folder = tmp_path / "lessons" / name
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "lesson.md").write_text(text, encoding="utf-8")
    return tmp_path / "lessons"


def site(document: Document, name: str) -> str:
    return next(one.id for one in document.sites.event().changed if one.name.endswith(name))


def steps(page: Page) -> list[dict[str, Any]]:
    """How the steps stand, as the page was told last; none before."""
    told = [one for one in page.events if one["type"] == "lesson_state"]
    return told[-1]["steps"] if told else []


def done(page: Page) -> list[bool]:
    return [step["done_s"] is not None for step in steps(page)]


def codes(page: Page) -> list[str]:
    return [check["code"] for step in steps(page) for check in step["checks"]]


def is_told(page: Page) -> bool:
    """Whether nothing has to be waited for."""
    return bool(steps(page)) and "checks.waiting" not in codes(page)


def test_a_step_turns_green_on_a_copy_for_its_owner_alone_and_the_teacher_sees_it(tmp_path: Path):
    async def work(room: Room) -> None:
        ada, bob = await room.student("Ada"), await room.student("Bob")
        copy = await room.copy(ada)
        await room.ask(ada, OpenLesson(document=copy.id, lesson="wheel"))
        await room.ask(bob, OpenLesson(document=room.shared.id, lesson="wheel"))
        await until(lambda: is_told(ada) and is_told(bob))
        assert codes(ada) == codes(bob) == ["property.other", "", "opened.none", "ros.none"]
        assert steps(ada)[0]["checks"][0]["found"] == {"value": "0.105"}
        radius = site(copy, "wheel_radius")
        await room.ask(ada, EditSite(document=copy.id, site=radius, text="0.15"))
        await until(lambda: done(ada)[0])
        await room.ask(ada, SawPanel(panel="origin"))
        await until(lambda: done(ada) == [True, True, False])
        assert done(bob) == [False, False, False]
        await room.ask(room.presenter, GetLessonTable(lesson="wheel"))
        rows = {row["name"]: row for row in room.presenter.last("lesson_table")["rows"]}
        assert [one is not None for one in rows["Ada"]["done_s"]] == [True, True, False]
        assert rows["Bob"]["done_s"] == [None, None, None]
        assert (rows["Ada"]["reads"], rows["Bob"]["here"]) == (True, True)
        with pytest.raises(StudioError):
            await room.ask(ada, GetLessonTable(lesson="wheel"))

    run(tmp_path, work, lesson_folders=(given(tmp_path),))


def test_what_was_done_stays_done_and_how_it_stands_now_is_said(tmp_path: Path):
    async def work(room: Room) -> None:
        page, name = room.presenter, room.shared.id
        await room.ask(page, OpenLesson(document=name, lesson="wheel"))
        radius = site(room.shared, "wheel_radius")
        await room.ask(page, EditSite(document=name, site=radius, text="0.150"))
        await until(lambda: done(page)[:1] == [True])
        await room.ask(page, Undo(document=name))
        await until(lambda: codes(page)[0] == "property.other")
        assert done(page)[0]
        await room.ask(page, GetLessons())
        listed = {one["name"]: one for one in page.last("lessons")["lessons"]}
        assert (listed["wheel"]["done"], listed["wheel"]["steps"]) == (1, 3)
        assert (listed["wheel"]["own"], listed["wheel"]["writable"]) == (True, False)
        assert listed["talker"]["node"] == "/topic_helloworld_pub"

    run(tmp_path, work, lesson_folders=(given(tmp_path),))


def test_the_model_is_looked_at_as_it_is_now(tmp_path: Path):
    async def work(room: Room) -> None:
        page, shared = room.presenter, room.shared
        await room.ask(page, OpenLesson(document=shared.id, lesson="model"))
        await until(lambda: is_told(page))
        joints = shared.model.assembly.robot.joints
        children = sum(one.parent == "base_link" for one in joints.values())
        assert codes(page) == [
            "",
            "argument.none",
            "property.other",
            "",
            "link.none",
            "" if children == 7 else "children.other",
            "children.other",
            "",
            "joint.other",
            "",
        ]
        await room.ask(page, GetText(document=shared.id, file=shared.path))
        version = page.last("text")["version"]
        broken = (TextChange(start=0, end=0, text="<"),)
        edit = EditText(document=shared.id, file=shared.path, version=version, changes=broken)
        await room.ask(page, edit)
        await until(lambda: codes(page)[-1] == "errors.some")
        assert set(codes(page)[:-1]) == {"run.failed"}

    run(tmp_path, work, lesson_folders=(given(tmp_path, MODEL, "model"),))


def test_ticks_and_people_are_back_after_a_restart_and_end_class_deletes_them(tmp_path: Path):
    kept: dict[str, Any] = {}

    async def before(room: Room) -> None:
        ada = await room.student("Ada")
        await room.ask(ada, OpenLesson(document=room.shared.id, lesson="wheel"))
        await room.ask(ada, SawPanel(panel="origin"))
        await until(lambda: done(ada)[1:2] == [True])
        kept["cookie"] = room.classroom.members.cookie_of(ada.who)  # type: ignore[arg-type]

    async def after(room: Room) -> None:
        ada = room.classroom.member_of_cookie(kept["cookie"])
        assert ada is not None
        page = room.page(ada)
        await room.ask(page, OpenLesson(document=room.shared.id, lesson="wheel"))
        await until(lambda: done(page) == [False, True, False])
        assert ada.ticks
        await room.ask(room.presenter, EndClass())
        await room.ask(room.presenter, GetLessonTable(lesson="wheel"))
        assert room.presenter.last("lesson_table")["rows"] == []

    run(tmp_path, before, lesson_folders=(given(tmp_path),))
    run(tmp_path, after, lesson_folders=(given(tmp_path),))


def test_a_lesson_is_written_in_the_page_and_who_reads_it_sees_the_change(tmp_path: Path):
    async def work(room: Room) -> None:
        page = room.presenter
        text = "# Mine\n\n<script>alert(1)</script>\n\ncheck: link mast is there\n"
        await room.ask(page, SaveLesson(lesson="mine", text=text))
        ada = await room.student("Ada")
        await room.ask(ada, GetLessonText(lesson="mine", language="de"))
        assert ada.last("lesson_text")["text"] == text
        await room.ask(ada, OpenLesson(document=room.shared.id, lesson="mine"))
        await until(lambda: done(ada) == [True])
        more = text + "\ncheck: link tail is there\n"
        await room.ask(page, SaveLesson(lesson="mine", text=more))
        await until(lambda: done(ada) == [True, False])
        for command in (SaveLesson(lesson="x", text="# X\n"), DeleteLesson(lesson="mine")):
            with pytest.raises(StudioError):
                await room.ask(ada, command)
        await room.ask(ada, CloseLesson())
        await room.ask(page, DeleteLesson(lesson="mine"))
        with pytest.raises(LessonError):
            await room.ask(ada, GetLessonText(lesson="mine"))

    run(tmp_path, work)


def test_the_faults_of_a_text_are_told_before_it_is_saved(tmp_path: Path):
    async def work(room: Room) -> None:
        text = "No title\n\ncheck: node talker runs\ncheck: no errors\n\ncheck: opened nothing\n"
        await room.ask(room.presenter, ReadLesson(text=text))
        read = room.presenter.last("lesson_read")
        assert [one["line"] for one in read["faults"]] == [1, 3, 6]
        assert "No panel is called nothing" in read["faults"][-1]["sentence"]
        step, _ = read["steps"]
        assert [(one["kind"], one["line"], one["code"]) for one in step["checks"]] == [
            ("no_errors", "no errors", ""),
            ("", "node talker runs", "check.faulty"),
        ]

    run(tmp_path, work)


@pytest.mark.parametrize("name", ["../../etc", "a/../../b", "..", "wheel/../wheel"])
def test_no_name_leads_out_of_the_folder_of_lessons(tmp_path: Path, name: str):
    async def work(room: Room) -> None:
        for command in (SaveLesson(lesson=name, text="# T\n"), OpenLesson(lesson=name)):
            with pytest.raises(LessonError):
                await room.ask(room.presenter, command)
        with pytest.raises(LessonError):
            await room.ask(room.presenter, DeleteLesson(lesson=name))

    run(tmp_path, work)


def test_all_who_read_the_same_cost_one_look(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    looked: list[str] = []
    real = module.model_verdict

    def counted(kind: str, values: Mapping[str, str], document: Document) -> Verdict:
        looked.append(kind)
        return real(kind, values, document)

    monkeypatch.setattr(module, "model_verdict", counted)

    async def work(room: Room) -> None:
        pages = [await room.student(f"Student {number}") for number in range(30)]
        for page in pages:
            await room.ask(page, OpenLesson(document=room.shared.id, lesson="wheel"))
        monkeypatch.setattr(module, "_LOOK_EVERY_S", 60.0)
        await until(lambda: all(map(steps, pages)))
        await room.engine.lessons.look()
        looked.clear()
        await room.engine.lessons.look()
        assert sorted(looked) == ["no_errors", "property"]
        sent = [len(page.events) for page in pages]
        await room.engine.lessons.look()  # nothing changed, so nothing is sent
        assert [len(page.events) for page in pages] == sent

    run(tmp_path, work, lesson_folders=(given(tmp_path),))


def test_of_a_copy_that_is_shown_all_see_how_it_stands_and_only_its_owner_has_done_it(
    tmp_path: Path,
):
    async def work(room: Room) -> None:
        ada, bob = await room.student("Ada"), await room.student("Bob")
        copy = await room.copy(ada)
        await room.ask(ada, Watch(document=copy.id))
        radius = site(copy, "wheel_radius")
        await room.ask(ada, EditSite(document=copy.id, site=radius, text="0.15"))
        open_it = OpenLesson(document=copy.id, lesson="wheel")
        await room.ask(room.presenter, ShowCopy(document=copy.id))
        for page in (ada, bob):
            await room.ask(page, open_it)
        await until(lambda: codes(bob)[:2] == ["", ""] and done(ada)[0])
        assert done(bob) == [False, False, False]
        await room.ask(room.presenter, ShowCopy(document=copy.id, shown=False))
        await until(lambda: codes(bob)[0] == "document.none")
        assert codes(ada)[0] == ""

    run(tmp_path, work, lesson_folders=(given(tmp_path),))


def test_a_copy_that_rests_is_not_woken_by_who_reads(tmp_path: Path):
    async def work(room: Room) -> None:
        ada = await room.student("Ada")
        copy = await room.copy(ada)
        await room.ask(ada, OpenLesson(document=copy.id, lesson="wheel"))
        await until(lambda: codes(ada)[:1] == ["property.other"])
        await room.engine.copies._rest(copy.id)  # pyright: ignore[reportPrivateUsage]
        await until(lambda: codes(ada)[0] == "document.none")
        assert room.engine.copies.awake(copy.id) is None

    run(tmp_path, work, lesson_folders=(given(tmp_path),))


def test_the_lesson_that_was_opened_last_is_read_though_another_is_found_later(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    given(tmp_path, "# Slow\n\ncheck: link mast is there\n", "slow")

    async def work(room: Room) -> None:
        ada = await room.student("Ada")
        find, may_find = Shelf.find, threading.Event()

        def slowly(shelf: Shelf, name: str) -> Lesson:
            assert name != "slow" or may_find.wait(60)
            return find(shelf, name)

        monkeypatch.setattr(Shelf, "find", slowly)
        slow = OpenLesson(document=room.shared.id, lesson="slow")
        for newer in (OpenLesson(document=room.shared.id, lesson="wheel"), CloseLesson()):
            may_find.clear()
            opening = asyncio.create_task(room.ask(ada, slow))
            await asyncio.sleep(0)  # it is under way
            await room.ask(ada, newer)
            may_find.set()
            await opening
            await until(lambda: len(steps(ada)) == 3)
        ada.events.clear()
        await room.engine.lessons.look()
        assert ada.events == []

    run(tmp_path, work, lesson_folders=(given(tmp_path),))


def test_a_step_with_a_line_that_is_no_check_is_never_done_and_says_so(tmp_path: Path):
    async def work(room: Room) -> None:
        ada = await room.student("Ada")
        await room.ask(ada, OpenLesson(document=room.shared.id, lesson="faulty"))
        await until(lambda: len(codes(ada)) == 2 and is_told(ada))
        assert codes(ada) == ["", "check.faulty"]
        assert done(ada) == [False]

    text = "# Faulty\n\ncheck: link mast is there\ncheck: link mast is here\n"
    run(tmp_path, work, lesson_folders=(given(tmp_path, text, "faulty"),))


def test_one_whose_system_cannot_be_found_keeps_nobody_else_waiting(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(module, "_LINK_S", 0.1)

    async def work(room: Room) -> None:
        ada, bob, eve = [await room.student(name) for name in ("Ada", "Bob", "Eve")]

        async def system_of(person: str) -> tuple[None, bool]:
            if person == ada.person:
                await asyncio.Event().wait()
            if person == bob.person:
                raise RuntimeError
            return None, False

        monkeypatch.setattr(room.engine.lessons, "_link_of", system_of)
        for page in (ada, bob, eve):
            await room.ask(page, OpenLesson(document=room.shared.id, lesson="wheel"))
        await until(lambda: all(map(is_told, (ada, bob, eve))))
        assert [codes(one)[-1] for one in (ada, bob, eve)] == [
            *("answer.waiting", "answer.waiting"),
            "ros.none",
        ]

    run(tmp_path, work, lesson_folders=(given(tmp_path),))


def test_who_asks_too_often_is_refused(tmp_path: Path):
    async def work(room: Room) -> None:
        ada = await room.student("Ada")
        for _ in range(10):
            await room.ask(ada, SawPanel(panel="origin"))
        with pytest.raises(CommandError, match="at most 10 times per second"):
            await asyncio.gather(*(room.ask(ada, SawPanel(panel="origin")) for _ in range(10)))

    run(tmp_path, work)
