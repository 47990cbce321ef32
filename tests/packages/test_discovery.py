"""Which package folders are found, over real trees."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.packages.discovery import Discovery, Origin, discover
from studio.packages.folder_memory import FolderMemory
from studio.packages.roots import ServedRoots
from tests.support.packages import write_install, write_package


def search(root: Path, file: Path | None = None) -> Discovery:
    memory = FolderMemory(file, ServedRoots([root]))
    found = discover(root, memory)
    memory.save()
    return found


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


@pytest.mark.parametrize(
    "manifest",
    [
        "",
        "<package/>",
        "no xml at all",
        "<package><name></name></package>",
        "<package><name>a b</name></package>",
        "<package><!-- <name>hidden</name> --></package>",
        "<other><name>rover</name></other>",
        f"<package><name>{'x' * 300}</name></package>",
        "<package><name>../../etc</name></package>",
    ],
)
def test_a_manifest_without_a_proper_name_is_no_package(tmp_path: Path, manifest: str):
    (tmp_path / "package.xml").write_text(manifest)
    assert search(tmp_path).packages == ()


@pytest.mark.skipif(os.name == "nt", reason="pipes of Unix")
@pytest.mark.timeout(10)
def test_a_manifest_that_is_a_pipe_or_leads_outside_is_no_package(tmp_path: Path):
    opened = tmp_path / "opened"
    for name in ("pipe", "link"):
        (opened / name).mkdir(parents=True)
    os.mkfifo(opened / "pipe" / "package.xml")
    outside = write_package(tmp_path / "outside")
    (opened / "link" / "package.xml").symlink_to(outside / "package.xml")
    assert search(opened).packages == ()


def age(root: Path) -> None:
    """Make everything look as if it had been there for a while, as it will on the next day."""
    for path, _, files in os.walk(root, topdown=False):
        for one in (*(Path(path, name) for name in files), Path(path)):
            os.utime(one, (1_600_000_000, 1_600_000_000))


def test_a_second_search_looks_into_no_folder_again(tmp_path: Path):
    write_package(tmp_path / "ws" / "rover", files={"urdf/rover.urdf": "<robot/>"})
    age(tmp_path / "ws")
    first = search(tmp_path / "ws", tmp_path / "memory")
    memory = FolderMemory(tmp_path / "memory", ServedRoots([tmp_path / "ws"]))
    assert discover(tmp_path / "ws", memory) == first
    assert memory.looks == 0


def test_a_folder_that_was_changed_just_now_is_looked_at_again(tmp_path: Path):
    """It might change once more without its mtime telling."""
    write_package(tmp_path / "ws" / "rover")
    search(tmp_path / "ws", tmp_path / "memory")
    memory = FolderMemory(tmp_path / "memory", ServedRoots([tmp_path / "ws"]))
    discover(tmp_path / "ws", memory)
    assert memory.looks == 2


def test_a_renamed_package_is_seen_though_its_folder_stayed_as_it_was(tmp_path: Path):
    package = write_package(tmp_path / "ws" / "rover")
    age(tmp_path / "ws")
    assert names(search(tmp_path / "ws", tmp_path / "memory")) == ["rover"]
    write_package(package, "rover_two")
    assert names(search(tmp_path / "ws", tmp_path / "memory")) == ["rover_two"]


@pytest.mark.parametrize("spoiled", [b"", b"\x00\xff", b"\x93\x01\x80", b"\x93\x02\x80\x80"])
def test_a_spoiled_memory_is_forgotten(tmp_path: Path, spoiled: bytes):
    write_package(tmp_path / "ws" / "rover")
    (tmp_path / "memory").write_bytes(spoiled)
    assert names(search(tmp_path / "ws", tmp_path / "memory")) == ["rover"]


steps = st.lists(
    st.tuples(
        st.sampled_from(["make", "remove", "ignore", "rename"]),
        st.integers(0, 3),
        st.integers(0, 3),
    ),
    max_size=12,
)


@settings(max_examples=40, deadline=None)
@given(steps=steps)
def test_a_remembered_search_always_equals_a_fresh_one(
    tmp_path_factory: pytest.TempPathFactory, steps: list[tuple[str, int, int]]
):
    base = tmp_path_factory.mktemp("law")
    root, memory = base / "ws", base / "memory"
    root.mkdir()
    for action, group, number in steps:
        folder = root / f"group{group}" / f"package{number}"
        if action == "make":
            write_package(folder)
        elif (folder / "package.xml").exists():
            if action == "remove":
                (folder / "package.xml").unlink()
            elif action == "ignore":
                (folder / "COLCON_IGNORE").touch()
            else:
                write_package(folder, f"renamed{number}")
        assert search(root, memory) == search(root)
