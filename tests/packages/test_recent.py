from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.packages.recent import COUNT_LIMIT, RecentFiles, last_opened

if TYPE_CHECKING:
    from pathlib import Path


def test_the_newest_comes_first_and_each_path_once(tmp_path: Path):
    recent = RecentFiles(tmp_path)
    for path, time_s in (("/a", 1.0), ("/b", 2.0), ("/a", 3.0)):
        recent.note(path, path, {}, time_s)
    assert [(one.path, one.time_s) for one in recent.all()] == [("/a", 3.0), ("/b", 2.0)]


def test_another_run_of_the_studio_remembers_names_and_arguments(tmp_path: Path):
    name = '/ws/<b>"Röver" 🤖\'s.xacro'
    RecentFiles(tmp_path).note(name, "t", {"size": "${1}"}, 1.0)
    found = RecentFiles(tmp_path).find(name)
    assert found is not None
    assert found.arguments == {"size": "${1}"}


def test_the_oldest_are_forgotten(tmp_path: Path):
    recent = RecentFiles(tmp_path)
    for number in range(COUNT_LIMIT + 5):
        recent.note(f"/{number}", "t", {}, float(number))
    assert len(recent.all()) == COUNT_LIMIT
    assert recent.all()[-1].path == "/5"


def test_an_entry_can_be_taken_out(tmp_path: Path):
    recent = RecentFiles(tmp_path)
    recent.note("/a", "t", {}, 1.0)
    recent.note("/b", "t", {}, 2.0)
    recent.forget("/a")
    recent.forget("/never")
    assert [one.path for one in recent.all()] == ["/b"]


@pytest.mark.parametrize("spoiled", [b"", b"{", b'{"files": 3}', b"\xff\xfe", b" " * (2 << 20)])
def test_a_spoiled_list_is_an_empty_one_and_is_mended_by_the_next_opening(
    tmp_path: Path, spoiled: bytes
):
    (tmp_path / "recent.json").write_bytes(spoiled)
    recent = RecentFiles(tmp_path)
    assert recent.all() == ()
    recent.note("/a", "t", {}, 1.0)
    assert len(recent.all()) == 1


def test_a_name_that_is_no_text_is_not_remembered(tmp_path: Path):
    recent = RecentFiles(tmp_path)
    recent.note("/a\udcff", "t", {}, 1.0)
    assert recent.all() == ()


def test_a_data_folder_that_is_gone_costs_only_the_memory(tmp_path: Path):
    recent = RecentFiles(tmp_path / "gone")
    recent.note("/a", "t", {}, 1.0)
    assert recent.all() == ()


def test_the_last_opened_file_is_the_newest_that_is_still_there(tmp_path: Path):
    kept = tmp_path / "kept.urdf"
    kept.touch()
    recent = RecentFiles(tmp_path)
    recent.note(str(kept), "kept", {}, 1.0)
    recent.note(str(tmp_path / "gone.urdf"), "gone", {}, 2.0)
    found = last_opened(tmp_path)
    assert found is not None
    assert found.path == str(kept)
    assert last_opened(tmp_path / "new") is None
