from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.course.lessons.files import lessons_with_files, write_files
from studio.errors import LessonError
from studio.settings import repository_or_wheel

if TYPE_CHECKING:
    from pathlib import Path

COURSE = repository_or_wheel("frontend_assets") / "lessons"


def test_each_lesson_that_names_its_files_has_some():
    named = {
        path.stem
        for path in COURSE.glob("*/*.md")
        if f"studio lesson files {path.stem}" in path.read_text(encoding="utf-8")
    }
    assert sorted(named) == lessons_with_files(COURSE)


def test_files_are_written_without_the_ending_that_hides_them(tmp_path: Path):
    written = write_files(COURSE, "mend_a_node", tmp_path / "here")
    assert written == [tmp_path / "here" / "counter.py"]
    assert "class Counter(Node)" in written[0].read_text()


def test_a_folder_that_is_there_is_left_as_it_is(tmp_path: Path):
    with pytest.raises(LessonError, match="is there already"):
        write_files(COURSE, "mend_a_node", tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_lesson_without_files_is_answered_with_those_that_have_some(tmp_path: Path):
    for name in ("talker", "../lessons", ""):
        with pytest.raises(LessonError, match="mend_a_launch, mend_a_node, mend_a_package"):
            write_files(COURSE, name, tmp_path / "here")
