"""What is remembered of folders, and when it is trusted."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.packages.discovery import Discovery, discover
from studio.packages.folder_memory import FolderMemory
from studio.packages.roots import ServedRoots
from tests.support.packages import write_package


def search(root: Path, file: Path | None = None) -> Discovery:
    memory = FolderMemory(file, ServedRoots([root]))
    found = discover(root, memory)
    memory.save()
    return found


def names(found: Discovery) -> list[str]:
    return [one.name for one in found.packages]


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
    assert memory.listed == 0


def test_a_folder_that_was_changed_just_now_is_looked_at_again(tmp_path: Path):
    """It might change once more without its mtime telling."""
    write_package(tmp_path / "ws" / "rover")
    search(tmp_path / "ws", tmp_path / "memory")
    memory = FolderMemory(tmp_path / "memory", ServedRoots([tmp_path / "ws"]))
    discover(tmp_path / "ws", memory)
    assert memory.listed == 2


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


@pytest.mark.skipif(os.name == "nt", reason="names of Unix")
def test_a_root_whose_name_is_no_text_is_searched_and_merely_not_remembered(tmp_path: Path):
    root = tmp_path / os.fsdecode(b"\xff")
    write_package(root / "rover")
    assert names(search(root, tmp_path / "memory")) == ["rover"]
    assert not (tmp_path / "memory").exists()


def test_a_data_folder_that_cannot_be_written_costs_only_speed(tmp_path: Path):
    write_package(tmp_path / "ws" / "rover")
    (tmp_path / "file").touch()
    assert names(search(tmp_path / "ws", tmp_path / "file" / "memory")) == ["rover"]
