"""What the page's file browser is told."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from studio.errors import OutsideRootsError, UnreadableFileError
from studio.packages.listing import list_folder
from studio.packages.roots import ServedRoots
from tests.support.packages import write_package
from tests.support.permissions import open_folder, unprivileged

if TYPE_CHECKING:
    from pathlib import Path

ROBOT = "<robot name='r'><link name='l'/></robot>"


def test_a_folder_lists_its_entries_with_their_kinds_folders_first(tmp_path: Path):
    write_package(tmp_path / "rover")
    (tmp_path / "docs").mkdir()
    for name, text in {
        "b.urdf": ROBOT,
        "a.xacro": "<gazebo/>",
        "c.zip": "",
        "notes.txt": "",
        "go.xml": "<launch/>",
        ".hidden": "",
    }.items():
        (tmp_path / name).write_text(text)
    listing = list_folder(str(tmp_path), ServedRoots([tmp_path]))
    assert [(one.name, one.kind, one.openable) for one in listing.entries] == [
        ("docs", "folder", True),
        ("rover", "package", True),
        ("b.urdf", "robot", True),
        ("c.zip", "zip", True),
        ("a.xacro", "robot", False),
        ("go.xml", "file", False),
        ("notes.txt", "file", False),
    ]
    reasons = {one.name: one.reason for one in listing.entries}
    assert reasons["a.xacro"] == "root is <gazebo>"
    assert reasons["b.urdf"] == ""


def test_bags_are_told_from_folders_and_files_and_can_be_opened(tmp_path: Path):
    (tmp_path / "drive").mkdir()
    (tmp_path / "drive" / "metadata.yaml").write_text("rosbag2_bagfile_information: {}")
    for name in ("one.mcap", "two.DB3", "three.db3.txt"):
        (tmp_path / name).write_text("")
    listing = list_folder(str(tmp_path), ServedRoots([tmp_path]))
    assert [(one.name, one.kind, one.openable) for one in listing.entries] == [
        ("drive", "bag", True),
        ("one.mcap", "bag", True),
        ("two.DB3", "bag", True),
        ("three.db3.txt", "file", False),
    ]


def test_an_empty_path_lists_the_served_roots(tmp_path: Path):
    rover = write_package(tmp_path / "rover")
    (tmp_path / "alone.urdf").write_text(ROBOT)
    (tmp_path / "system").mkdir()
    served = ServedRoots([rover, tmp_path / "alone.urdf"], read_only=[tmp_path / "system"])
    listing = list_folder("", served)
    assert (listing.path, listing.parent) == ("", None)
    assert [(one.name, one.kind) for one in listing.entries] == [
        (str(rover), "package"),
        (str(tmp_path / "alone.urdf"), "robot"),
        (str(tmp_path / "system"), "folder"),
    ]


def test_the_way_up_ends_at_the_list_of_roots(tmp_path: Path):
    (tmp_path / "a" / "b").mkdir(parents=True)
    served = ServedRoots([tmp_path / "a"])
    assert list_folder(str(tmp_path / "a" / "b"), served).parent == str(tmp_path / "a")
    assert list_folder(str(tmp_path / "a"), served).parent == ""


def test_a_folder_outside_is_refused(tmp_path: Path):
    (tmp_path / "a").mkdir()
    for path in (tmp_path, tmp_path / "a" / "..", "/etc"):
        with pytest.raises(OutsideRootsError):
            list_folder(str(path), ServedRoots([tmp_path / "a"]))


def test_a_file_or_nothing_is_no_folder(tmp_path: Path):
    (tmp_path / "a.urdf").touch()
    for name in ("a.urdf", "nothing"):
        with pytest.raises(UnreadableFileError, match="cannot be listed as a folder"):
            list_folder(str(tmp_path / name), ServedRoots([tmp_path]))


@pytest.mark.skipif(os.name == "nt", reason="symlinks and pipes of Unix")
def test_pipes_broken_links_and_links_outwards_cannot_be_opened(tmp_path: Path):
    opened = tmp_path / "opened"
    opened.mkdir()
    os.mkfifo(opened / "pipe.urdf")
    (opened / "out.urdf").symlink_to(tmp_path / "secret.urdf")
    (opened / "up").symlink_to(tmp_path)
    (opened / "broken.urdf").symlink_to(opened / "nothing.urdf")
    listing = list_folder(str(opened), ServedRoots([opened]))
    assert {one.name: one.openable for one in listing.entries} == dict.fromkeys(
        ("pipe.urdf", "out.urdf", "up", "broken.urdf"), False
    )
    assert all(one.reason for one in listing.entries)


@pytest.mark.skipif(os.name == "nt", reason="modes of Unix")
def test_closed_folders_and_files_are_listed_and_say_so_when_they_are_entered():
    with open_folder() as folder:
        (folder / "closed").mkdir()
        (folder / "a.urdf").touch()
        for one in folder.iterdir():
            one.chmod(0)
        served = ServedRoots([folder])
        with unprivileged():
            entries = {one.name: one for one in list_folder(str(folder), served).entries}
            with pytest.raises(UnreadableFileError, match="Permission denied"):
                list_folder(str(folder / "closed"), served)
    assert entries["closed"].kind == "folder"
    assert not entries["a.urdf"].openable
    assert "permissions forbid it" in entries["a.urdf"].reason


def test_a_root_inside_another_one_is_not_listed_twice(tmp_path: Path):
    outer, inner, beside = (tmp_path / name for name in ("ws", "ws/inner", "ws2"))
    for one in (outer, inner, beside):
        one.mkdir()
    listed = list_folder("", ServedRoots([outer, inner, beside]))
    assert [one.path for one in listed.entries] == [str(outer), str(beside)]
