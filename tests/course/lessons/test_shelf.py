from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.course.demos import LESSONS
from studio.course.lessons.shelf import Shelf
from studio.course.lessons.text import TEXT_MAX
from studio.errors import DataFolderError, LessonError
from studio.settings import repository_or_wheel
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from pathlib import Path

COURSE = repository_or_wheel("frontend_assets") / "lessons"


def shelf(tmp_path: Path, *folders: Path) -> Shelf:
    return Shelf(COURSE, folders, tmp_path / "written")


def lesson(folder: Path, text: str, name: str = "lesson.md") -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_text(text, encoding="utf-8")
    return folder


def test_every_demo_of_the_course_has_a_lesson(tmp_path: Path):
    course = [one for one in shelf(tmp_path).lessons() if one.chapter != "exercises"]
    assert [one.name for one in course] == list(LESSONS)
    assert not any(one.own or one.writable for one in course)


def test_a_teachers_folder_is_a_lesson_or_has_one_in_each_folder(tmp_path: Path):
    lesson(tmp_path / "given" / "Arm", "# The arm\n")
    lesson(tmp_path / "given" / "wheel", "# The wheel\n", "lesson.de.md")
    (tmp_path / "given" / "notes.md").write_text("# No lesson\n")
    many = shelf(tmp_path, tmp_path / "given")
    assert [one.name for one in many.lessons() if one.own] == ["arm", "wheel"]
    alone = shelf(tmp_path, tmp_path / "given" / "Arm")
    assert alone.find("arm").read().title == "The arm"
    assert many.find("wheel").text("en") == many.find("wheel").text("de") == "# The wheel\n"


def test_a_folder_is_looked_through_anew_each_time(tmp_path: Path):
    given = lesson(tmp_path / "given", "# One\n")
    one = shelf(tmp_path, given)
    assert one.find("given").read().title == "One"
    lesson(given, "# Another\n")
    assert one.find("given").read().title == "Another"
    (given / "lesson.md").unlink()
    wait_until("it is gone", lambda: not any(each.own for each in one.lessons()))
    with pytest.raises(LessonError, match="No lesson is called 'given'"):
        one.find("given")


def test_what_lies_outside_of_a_lessons_folder_is_not_read(tmp_path: Path):
    secret = tmp_path / "secret.md"
    secret.write_text("# Secret\n")
    given = tmp_path / "given"
    given.mkdir()
    (given / "lesson.md").symlink_to(secret)
    assert not [one for one in shelf(tmp_path, given).lessons() if one.own]


def test_a_lesson_is_written_read_and_deleted(tmp_path: Path):
    here = shelf(tmp_path)
    here.write("my-wheel", "", "# Mine\n")
    here.write("my-wheel", "de", "# Meine\n")
    written = here.find("my-wheel")
    assert (written.own, written.writable) == (True, True)
    assert (written.text("de"), written.text("en")) == ("# Meine\n", "# Mine\n")
    here.delete("my-wheel")
    with pytest.raises(LessonError):
        here.find("my-wheel")


@pytest.mark.parametrize("name", ["../up", "a/b", "", ".hidden", "CON:", "ä", "x" * 61])
def test_a_name_leads_to_no_other_folder(tmp_path: Path, name: str):
    with pytest.raises(LessonError, match="is no name of a lesson"):
        shelf(tmp_path).write(name, "", "# T\n")
    assert list(tmp_path.rglob("*.md")) == []


def test_a_lesson_of_the_course_or_of_a_folder_is_neither_replaced_nor_deleted(tmp_path: Path):
    here = shelf(tmp_path, lesson(tmp_path / "given", "# One\n"))
    for name in ("talker", "given"):
        with pytest.raises(LessonError, match="There is a lesson"):
            here.write(name, "", "# Mine\n")
        with pytest.raises(LessonError, match="was not written here"):
            here.delete(name)
    assert (tmp_path / "given" / "lesson.md").read_text() == "# One\n"


def test_a_disk_that_refuses_is_said(tmp_path: Path):
    (tmp_path / "written").write_text("a file in the place of the folder")
    with pytest.raises(DataFolderError):
        shelf(tmp_path).write("mine", "", "# T\n")


def test_a_text_that_is_too_long_is_neither_written_nor_read_to_its_end(tmp_path: Path):
    here = shelf(tmp_path, lesson(tmp_path / "given", "# T\n" + "x" * (9 * TEXT_MAX)))
    with pytest.raises(LessonError, match="characters at most"):
        here.write("mine", "", "# T\n" + "x" * TEXT_MAX)
    assert not (tmp_path / "written").exists()
    given = here.find("given")
    assert len(given.text()) <= 4 * TEXT_MAX + 1
    assert "characters at most" in given.read().faults[0].sentence
