"""Edits of packages are written whole or not at all, and taken back."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.errors import CommandError, NotMadeError, PackageError
from studio.live.programs.package_edits import PackageEdits
from studio.packages.edits.package_edit import PackageEdit
from studio.problems import NewFile, Replacement

if TYPE_CHECKING:
    from pathlib import Path


def new_file(path: Path, text: str = "") -> PackageEdit:
    return PackageEdit("New", "", (NewFile(str(path), text),))


def test_an_edit_is_written_and_taken_back_with_the_folders_that_it_made(tmp_path: Path):
    kept = tmp_path / "setup.py"
    kept.write_text("one two\n")
    kept.chmod(0o755)
    edits = PackageEdits()
    new = NewFile(str(tmp_path / "a/b/new.py"), "new\n")
    change = Replacement(str(kept), 4, 7, "two", "three")
    number, files = edits.write(tmp_path, PackageEdit("New", "", (new,), (change,)))
    assert files == (tmp_path / "a/b/new.py", kept)
    assert kept.read_text() == "one three\n"
    assert kept.stat().st_mode & 0o777 == 0o755
    assert edits.undo(number) == "New"
    assert kept.read_text() == "one two\n"
    assert sorted(one.name for one in tmp_path.iterdir()) == ["setup.py"]


def test_nothing_is_written_where_a_text_is_another_one_by_now(tmp_path: Path):
    kept = tmp_path / "setup.py"
    kept.write_text("one 222\n")
    edits = PackageEdits()
    change = Replacement(str(kept), 4, 7, "two", "three")
    edit = PackageEdit("New", "", (NewFile(str(tmp_path / "new.py"), ""),), (change,))
    with pytest.raises(NotMadeError, match="has changed meanwhile"):
        edits.write(tmp_path, edit)
    assert not (tmp_path / "new.py").exists()


def test_no_file_is_written_over(tmp_path: Path):
    (tmp_path / "new.py").write_text("mine")
    with pytest.raises(NotMadeError):
        PackageEdits().write(tmp_path, new_file(tmp_path / "new.py"))
    assert (tmp_path / "new.py").read_text() == "mine"


def test_nothing_is_written_outside_of_the_package(tmp_path: Path):
    (tmp_path / "ws").mkdir()
    (tmp_path / "ws/out").symlink_to(tmp_path)
    for path in (tmp_path / "x.py", tmp_path / "ws/../x.py", tmp_path / "ws/out/x.py"):
        with pytest.raises(PackageError):
            PackageEdits().write(tmp_path / "ws", new_file(path))
    assert not (tmp_path / "x.py").exists()


def test_an_edit_stays_once_somebody_has_changed_its_files_and_what_they_added_stays(
    tmp_path: Path,
):
    edits = PackageEdits()
    number, _ = edits.write(tmp_path, new_file(tmp_path / "a/new.py", "new\n"))
    (tmp_path / "a/mine.txt").write_text("mine")
    (tmp_path / "a/new.py").write_text("changed")
    with pytest.raises(CommandError, match="changed since"):
        edits.undo(number)
    (tmp_path / "a/new.py").write_text("new\n")
    edits.undo(number)
    assert [one.name for one in (tmp_path / "a").iterdir()] == ["mine.txt"]
