from __future__ import annotations

from typing import TYPE_CHECKING

from tests.support.command_line import studio

if TYPE_CHECKING:
    from pathlib import Path

GOOD = "# A wheel\n\ncheck: opened origin\ncheck: property wheel_radius is 0.1\n"


def lesson(folder: Path, text: str, name: str = "lesson.md") -> None:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_text(text, encoding="utf-8")


def test_a_lesson_without_faults(tmp_path: Path):
    lesson(tmp_path / "wheel", GOOD)
    lesson(tmp_path / "wheel", GOOD.replace("A wheel", "Ein Rad"), "lesson.de.md")
    for folder in (tmp_path, tmp_path / "wheel"):
        ran = studio("lesson", "check", str(folder))
        assert (ran.code, ran.out) == (0, "Lessons: 1, steps: 1, faults: 0\n")


def test_each_fault_is_named_with_its_file_and_line(tmp_path: Path):
    lesson(tmp_path / "wheel", "Wheel\nneeds: nobody\n\ncheck: node talker runs\n")
    lesson(tmp_path / "panel", "# P\n\ncheck: opened nothing\n")
    lesson(tmp_path / "panel", "# P\n\ncheck: opened origin\n", "lesson.de.md")
    lesson(tmp_path / "empty", "# Nothing to do\n")
    ran = studio("lesson", "check", str(tmp_path))
    assert ran.code == 1
    lines = ran.out.splitlines()
    assert lines[-1] == "Lessons: 3, steps: 2, faults: 6"
    for path, words in (
        ("wheel/lesson.md:1:", "write `# Title` in the first line"),
        ("wheel/lesson.md:2:", "No demo is called nobody"),
        ("wheel/lesson.md:4:", "write it as `node /NAME runs`"),
        ("panel/lesson.md:3:", "No panel is called nothing: they are actions, "),
        ("panel/lesson.md:1:", "not those of the other language"),
        ("empty/lesson.md:1:", "write a line `check: ...`"),
    ):
        assert any(path in line and words in line for line in lines), (path, ran.out)


def test_a_folder_without_a_lesson_is_said(tmp_path: Path):
    ran = studio("lesson", "check", str(tmp_path))
    assert ran.code == 1
    assert "a lesson is a folder with a file lesson.md" in ran.err


def test_the_files_of_a_lesson_are_written_and_never_twice(tmp_path: Path):
    assert "mend_a_package\n" in studio("lesson", "files").out
    ran = studio("lesson", "files", "mend_a_package", str(tmp_path))
    assert ran.code == 0
    assert "mend_a_package/src/harbor/setup.py\n" in ran.out
    again = studio("lesson", "files", "mend_a_package", str(tmp_path))
    assert (again.code, again.out) == (2, "")
    assert "is there already" in again.err
