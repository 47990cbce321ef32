from __future__ import annotations

import os
import subprocess
import sys
from typing import TYPE_CHECKING

from studio.packages.temporary_files import is_temporary, sweep, temporary_beside

if TYPE_CHECKING:
    from pathlib import Path


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
