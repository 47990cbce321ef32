from __future__ import annotations

import os
import stat
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from studio.files import is_temporary, sweep, temporary_beside, write_whole

if TYPE_CHECKING:
    from pathlib import Path

posix = pytest.mark.skipif(sys.platform == "win32", reason="files have a mode")


def test_a_file_is_written_whole_and_nothing_is_left_beside_it(tmp_path: Path):
    file = tmp_path / "kept.json"
    write_whole(file, b"one")
    write_whole(file, b"two", flush=True)
    assert file.read_bytes() == b"two"
    assert list(tmp_path.iterdir()) == [file]


def test_what_the_disk_refuses_leaves_what_was_there(tmp_path: Path):
    folder = tmp_path / "kept.json"
    folder.mkdir()
    with pytest.raises(OSError, match="kept"):
        write_whole(folder, b"one")
    assert list(tmp_path.iterdir()) == [folder]
    with pytest.raises(OSError, match="nowhere"):
        write_whole(tmp_path / "nowhere" / "kept.json", b"one")


@posix
def test_a_file_has_the_mode_that_is_asked_for_or_that_of_any_new_file(tmp_path: Path):
    other = tmp_path / "other"
    other.touch()
    for name, mode in (("private", 0o600), ("shared", 0o664), ("any", None)):
        write_whole(tmp_path / name, b"", mode=mode)
        wanted = stat.S_IMODE(other.stat().st_mode) if mode is None else mode
        assert stat.S_IMODE((tmp_path / name).stat().st_mode) == wanted


@posix
def test_a_symlink_in_the_way_is_replaced_and_not_followed(tmp_path: Path):
    theirs, file = tmp_path / "theirs", tmp_path / "file"
    theirs.write_bytes(b"")
    file.symlink_to(theirs)
    write_whole(file, b"one")
    assert theirs.read_bytes() == b""
    assert file.read_bytes() == b"one"
    assert not file.is_symlink()


def test_only_what_studios_that_run_no_more_left_is_removed(tmp_path: Path):
    handle, mine = temporary_beside(tmp_path / f"{'é' * 99}.xacro")
    os.close(handle)
    ended = subprocess.Popen([sys.executable, "-c", ""])
    ended.wait()
    left, of_others, folder = (
        tmp_path / f".a.xacro.studio-{ended.pid}-abcdefgh.tmp",
        tmp_path / ".a.xacro.abcdefgh.tmp",
        tmp_path / f".b.xacro.studio-{ended.pid}-abcdefgh.tmp",
    )
    left.touch()
    of_others.touch()
    folder.mkdir()
    sweep([tmp_path, tmp_path / "nothing"])
    assert set(tmp_path.iterdir()) == {mine, of_others, folder}
    os.utime(mine, (1, 1))
    sweep([tmp_path])
    assert not mine.exists()


def test_a_temporary_file_is_known_by_its_name():
    for name in (".a.xacro.studio-7-abcdefgh.tmp", ".a.xacro.abcd_3gh.tmp"):
        assert is_temporary(name)
    for name in ("a.xacro", ".gitignore", "a.tmp", "a.abcdefgh.tmp", ".clang-format"):
        assert not is_temporary(name)
