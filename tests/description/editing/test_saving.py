"""Saving: all files or none, nothing else changed, nothing lost."""

from __future__ import annotations

import os
import stat
import sys
from pathlib import Path

import pytest

from studio.description.editing.saving import FileToSave, save_files
from studio.errors import NotSavedError, OutsideRootsError, SaveConflictError
from studio.packages.roots import ServedRoots

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="modes and symlinks of Unix")


def save(root: Path, *files: tuple[Path, bytes, bytes], read_only: Path | None = None) -> list[str]:
    roots = ServedRoots([root], [read_only] if read_only else [])
    saved: list[str] = []
    wanted = [FileToSave(str(path), old, new) for path, old, new in files]
    save_files(wanted, roots.resolve, roots.may_write, lambda one: saved.append(one.file))
    return saved


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "a.xacro"
    path.write_bytes(b"old\r\n")
    return path


def test_the_new_bytes_stand_on_the_disk_and_nothing_beside_them(file: Path):
    assert save(file.parent, (file, b"old\r\n", b"new\r\n")) == [str(file)]
    assert file.read_bytes() == b"new\r\n"
    assert [one.name for one in file.parent.iterdir()] == ["a.xacro"]


@pytest.mark.parametrize("mode", [0o640, 0o600, 0o755, 0o664])
def test_the_mode_stays(file: Path, mode: int):
    file.chmod(mode)
    save(file.parent, (file, b"old\r\n", b"new"))
    assert stat.S_IMODE(file.stat().st_mode) == mode


def test_a_symlink_stays_and_its_target_is_written(tmp_path: Path):
    source, install = tmp_path / "src", tmp_path / "install"
    source.mkdir()
    install.mkdir()
    (source / "a.xacro").write_bytes(b"old")
    (install / "a.xacro").symlink_to("../src/a.xacro")
    save(tmp_path, (install / "a.xacro", b"old", b"new"))
    assert (install / "a.xacro").readlink() == Path("../src/a.xacro")
    assert (source / "a.xacro").read_bytes() == b"new"


def test_a_symlink_that_leads_out_of_the_folders_is_not_written(tmp_path: Path):
    inside, outside = tmp_path / "in", tmp_path / "out.xacro"
    inside.mkdir()
    outside.write_bytes(b"old")
    (inside / "a.xacro").symlink_to(outside)
    with pytest.raises(OutsideRootsError):
        save(inside, (inside / "a.xacro", b"old", b"new"))
    assert outside.read_bytes() == b"old"


def test_a_file_that_changed_on_disk_is_not_overwritten(file: Path):
    file.write_bytes(b"theirs")
    with pytest.raises(SaveConflictError, match="changed on disk"):
        save(file.parent, (file, b"old\r\n", b"new"))
    assert file.read_bytes() == b"theirs"


def test_when_one_file_cannot_be_saved_none_is(file: Path):
    other = file.with_name("b.xacro")
    other.write_bytes(b"theirs")
    with pytest.raises(SaveConflictError):
        save(file.parent, (file, b"old\r\n", b"new"), (other, b"ours", b"new"))
    assert file.read_bytes() == b"old\r\n"
    assert sorted(one.name for one in file.parent.iterdir()) == ["a.xacro", "b.xacro"]


def test_a_file_that_is_gone_is_not_made_again(file: Path):
    file.unlink()
    with pytest.raises(NotSavedError, match="deleted on disk"):
        save(file.parent, (file, b"old\r\n", b"new"))
    assert not file.exists()


def test_a_read_only_file_is_left_alone(file: Path):
    file.chmod(0o444)
    with pytest.raises(NotSavedError, match="the file is read-only"):
        save(file.parent, (file, b"old\r\n", b"new"))
    assert file.read_bytes() == b"old\r\n"


def test_a_read_only_folder_is_left_alone(file: Path):
    file.parent.chmod(0o555)
    try:
        with pytest.raises(NotSavedError, match="its folder is read-only"):
            save(file.parent, (file, b"old\r\n", b"new"))
    finally:
        file.parent.chmod(0o755)
    assert file.read_bytes() == b"old\r\n"


def test_a_folder_that_was_opened_for_reading_is_left_alone(tmp_path: Path):
    ros = tmp_path / "ros"
    ros.mkdir()
    (ros / "a.xacro").write_bytes(b"old")
    with pytest.raises(NotSavedError, match="opened for reading only"):
        save(tmp_path, (ros / "a.xacro", b"old", b"new"), read_only=ros)
    assert (ros / "a.xacro").read_bytes() == b"old"


def test_what_took_the_place_of_a_file_is_not_read(tmp_path: Path):
    """A pipe in its place would block the reader for ever."""
    pipe = tmp_path / "a.xacro"
    os.mkfifo(pipe)
    with pytest.raises(SaveConflictError):
        save(tmp_path, (pipe, b"old", b"new"))


def test_a_full_disk_leaves_the_old_file_and_no_other(file: Path, monkeypatch: pytest.MonkeyPatch):
    def full(_handle: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(NotSavedError, match="No space left on device"):
        save(file.parent, (file, b"old\r\n", b"new"))
    assert [one.read_bytes() for one in file.parent.iterdir()] == [b"old\r\n"]
