"""Which package folders are found, over real trees."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from studio.packages import discovery
from studio.packages.discovery import Discovery, Origin, discover, robot_files
from studio.packages.folder_memory import FolderMemory
from studio.packages.roots import ServedRoots
from tests.support.packages import write_install, write_package

if TYPE_CHECKING:
    from pathlib import Path


def search(root: Path) -> Discovery:
    return discover(root, FolderMemory(None, ServedRoots([root])))


def names(found: Discovery, origin: Origin = Origin.SOURCE) -> list[str]:
    return [one.name for one in found.packages if one.origin is origin]


def test_packages_are_found_at_any_depth_and_named_by_their_manifest(tmp_path: Path):
    write_package(tmp_path / "group" / "repo" / "folder_name", "rover_description")
    write_package(tmp_path / "arm")
    assert sorted(names(search(tmp_path))) == ["arm", "rover_description"]


def test_the_opened_folder_may_be_a_package_itself(tmp_path: Path):
    write_package(tmp_path, "rover")
    assert names(search(tmp_path)) == ["rover"]


def test_packages_inside_packages_are_found_and_known_as_such(tmp_path: Path):
    write_package(tmp_path / "outer" / "templates" / "inner")
    write_package(tmp_path / "outer")
    found = search(tmp_path)
    assert names(found) == ["outer"]
    assert names(found, Origin.NESTED) == ["inner"]


@pytest.mark.parametrize("marker", ["COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE"])
def test_a_folder_that_is_ignored_is_no_source_with_all_below_it(tmp_path: Path, marker: str):
    write_package(tmp_path / "kept")
    write_package(tmp_path / "old" / "gone")
    (tmp_path / "old" / marker).touch()
    write_package(tmp_path / "also_gone")
    (tmp_path / "also_gone" / marker).touch()
    assert names(search(tmp_path)) == ["kept"]


@pytest.mark.parametrize("name", ["build", "install", "log", "devel"])
def test_what_a_build_leaves_is_no_source(tmp_path: Path, name: str):
    write_package(tmp_path / "src" / "rover")
    write_package(tmp_path / name / "rover")
    found = search(tmp_path)
    assert [one.folder for one in found.packages] == [tmp_path / "src" / "rover"]
    assert found.generated == (tmp_path / name,)


def test_a_package_that_is_called_like_a_build_folder_is_a_package(tmp_path: Path):
    write_package(tmp_path / "src" / "log")
    assert names(search(tmp_path)) == ["log"]


def test_a_folder_that_merely_happens_to_be_called_log_stays_writable(tmp_path: Path):
    write_package(tmp_path / "rover", files={"log/robot.urdf": "<robot/>"})
    assert search(tmp_path).generated == ()


@pytest.mark.parametrize("isolated", [True, False])
def test_an_install_space_serves_its_packages_as_installed(tmp_path: Path, isolated: bool):
    write_install(tmp_path / "install", ["rover", "arm"], isolated=isolated)
    found = search(tmp_path)
    assert sorted(names(found, Origin.INSTALLED)) == ["arm", "rover"]
    assert names(found) == []
    assert found.generated == (tmp_path / "install",)


@pytest.mark.parametrize("folder", [".hidden", "node_modules", "__pycache__"])
def test_folders_that_hold_no_sources_are_not_entered(tmp_path: Path, folder: str):
    write_package(tmp_path / folder / "rover")
    assert search(tmp_path).packages == ()


@pytest.mark.skipif(os.name == "nt", reason="symlinks of Unix")
def test_links_to_folders_are_not_followed_so_that_a_loop_ends(tmp_path: Path):
    write_package(tmp_path / "rover")
    (tmp_path / "rover" / "again").symlink_to(tmp_path)
    assert len(search(tmp_path).packages) == 1


@pytest.mark.skipif(os.name == "nt", reason="pipes of Unix")
def test_a_manifest_that_is_a_pipe_or_leads_outside_is_no_package(tmp_path: Path):
    opened = tmp_path / "opened"
    for name in ("pipe", "link"):
        (opened / name).mkdir(parents=True)
    os.mkfifo(opened / "pipe" / "package.xml")
    outside = write_package(tmp_path / "outside")
    (opened / "link" / "package.xml").symlink_to(outside / "package.xml")
    assert search(opened).packages == ()


@pytest.mark.skipif(os.name == "nt", reason="names of Unix")
def test_a_name_that_is_no_text_is_passed_over(tmp_path: Path):
    write_package(tmp_path / "rover")
    (tmp_path / os.fsdecode(b"\xff")).mkdir()
    assert names(search(tmp_path)) == ["rover"]


def test_robot_files_are_those_of_the_sources(tmp_path: Path):
    write_package(tmp_path / "rover", files={"urdf/A.URDF": "", "b.xacro": "", "c.txt": ""})
    write_package(tmp_path / "build" / "rover", files={"d.urdf": ""})
    write_install(tmp_path / "prefix", ["rover"])
    (tmp_path / "prefix" / "e.urdf").touch()
    memory = FolderMemory(None, ServedRoots([tmp_path]))
    assert sorted(one.name for one in robot_files(tmp_path, memory)) == ["A.URDF", "b.xacro"]
    installed = robot_files(tmp_path / "prefix", memory)
    assert [one.name for one in installed] == ["e.urdf"]


def test_a_search_that_would_never_end_is_cut_and_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    for number in range(5):
        write_package(tmp_path / f"package{number}")
    monkeypatch.setattr(discovery, "FOLDER_LIMIT", 3)
    found = search(tmp_path)
    assert not found.complete
    assert len(found.packages) == 2
