from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from studio.errors import NotMadeError, OutsideRootsError
from studio.packages.edits.package_edit import PackageEdit
from studio.packages.edits.writing import write_edit
from studio.packages.roots import ServedRoots
from studio.problems import NewFile, Replacement

if TYPE_CHECKING:
    from pathlib import Path


def edit_of(folder: Path, before: str = "a") -> PackageEdit:
    change = Replacement(str(folder / "there"), 0, len(before), before, "b")
    return PackageEdit("It", "", (NewFile(str(folder / "sub" / "new"), "n"),), (change,))


def test_new_and_changed_files_are_written(tmp_path: Path):
    (tmp_path / "there").write_text("abc")
    written = write_edit(edit_of(tmp_path), ServedRoots([tmp_path]))
    assert tuple(written.after) == (tmp_path / "sub" / "new", tmp_path / "there")
    assert (tmp_path / "there").read_text() == "bbc"


def test_nothing_is_written_where_something_does_not_fit(tmp_path: Path):
    (tmp_path / "there").write_text("abc")
    with pytest.raises(NotMadeError, match="has changed meanwhile"):
        write_edit(edit_of(tmp_path, "x"), ServedRoots([tmp_path]))
    assert not (tmp_path / "sub").exists()
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "new").write_text("mine")
    with pytest.raises(NotMadeError, match="there already"):
        write_edit(edit_of(tmp_path), ServedRoots([tmp_path]))
    assert (tmp_path / "there").read_text() == "abc"
    assert (tmp_path / "sub" / "new").read_text() == "mine"


def test_what_lies_outside_is_not_written_and_what_was_made_is_taken_back(tmp_path: Path):
    inner = tmp_path / "inner"
    inner.mkdir()
    new = (NewFile(str(inner / "one"), "1"), NewFile(str(tmp_path / "two"), "2"))
    with pytest.raises(OutsideRootsError):
        write_edit(PackageEdit("It", "", new), ServedRoots([inner]))
    assert list(inner.iterdir()) == []
    assert not (tmp_path / "two").exists()


def test_what_the_system_refuses_leaves_all_as_it_was(tmp_path: Path):
    (tmp_path / "there").write_text("abc")
    (tmp_path / "there").chmod(0o755)
    # The second of the new files would lie in the first, which is no folder.
    files = (NewFile(str(tmp_path / "sub/new"), "n"), NewFile(str(tmp_path / "sub/new/more"), "m"))
    edit = replace(edit_of(tmp_path), new_files=files)
    with pytest.raises(NotMadeError, match="the system refused"):
        write_edit(edit, ServedRoots([tmp_path]))
    assert [one.name for one in tmp_path.iterdir()] == ["there"]
    assert (tmp_path / "there").read_text() == "abc"
    assert (tmp_path / "there").stat().st_mode & 0o777 == 0o755
