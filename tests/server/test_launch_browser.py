from __future__ import annotations

import os
import queue
import stat
from typing import TYPE_CHECKING
from urllib.parse import urlsplit
from urllib.request import url2pathname

import pytest

from studio.server.launch import Window, readable_folder

if TYPE_CHECKING:
    from pathlib import Path

ADDRESS = "http://127.0.0.1:8765/?code=one-time&theme=dark"


def test_the_browser_is_given_a_file_that_only_its_owner_reads_and_not_the_address(tmp_path: Path):
    opened: queue.Queue[str] = queue.Queue()
    window = Window(tmp_path)
    window.show(ADDRESS, opened.put)
    given = opened.get(timeout=60)
    assert given.startswith("file://")
    assert "one-time" not in given
    (file,) = tmp_path.iterdir()
    assert url2pathname(urlsplit(given).path) == str(file)
    if os.name == "posix":
        assert stat.S_IMODE(file.stat().st_mode) == 0o600
    leads_to = '<meta http-equiv="refresh" content="0;url=http://127.0.0.1:8765/?code=one-time&amp;'
    assert leads_to in file.read_text()
    window.close()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(os.name != "posix", reason="links")
def test_the_file_is_written_through_no_link_of_somebody_else(tmp_path: Path):
    theirs, folder = tmp_path / "theirs", tmp_path / "data"
    folder.mkdir()
    theirs.write_text("")
    (folder / f"robot-description-studio-{os.getpid()}.html").symlink_to(theirs)
    opened: queue.Queue[str] = queue.Queue()
    Window(folder).show(ADDRESS, opened.put)
    opened.get(timeout=60)
    assert theirs.read_text() == ""


def test_a_browser_from_a_snap_finds_the_file_where_it_can_read(tmp_path: Path):
    home, data = tmp_path / "home", tmp_path / "data"
    common = home / "snap" / "firefox" / "common"
    assert readable_folder("firefox_firefox.desktop", home, data) == data
    common.mkdir(parents=True)
    assert readable_folder("firefox_firefox.desktop", home, data) == common
    assert readable_folder("firefox.desktop", home, data) == data
    assert readable_folder("", home, data) == data
