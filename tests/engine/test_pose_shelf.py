"""Where poses are kept: beside the file, or for the session where nothing may be written."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.poses.named_poses import NamedPose
from studio.engine.pose_shelf import PoseShelf
from studio.errors import PosesFileError, UnreadableFileError
from studio.packages.roots import ServedRoots

if TYPE_CHECKING:
    from pathlib import Path

HOME, UP = NamedPose("Home", {"a": 0.0}), NamedPose("Up", {"a": 1.0})


def names(shelf: PoseShelf) -> list[str]:
    return [pose.name for pose in shelf.poses]


def shelf_at(folder: Path, *, read_only: bool = False) -> PoseShelf:
    served = ServedRoots([], [folder]) if read_only else ServedRoots([folder])
    made = PoseShelf(folder / "arm.urdf", served)
    made.look()
    return made


def test_what_is_put_is_there_for_the_next_one(tmp_path: Path):
    shelf_at(tmp_path).put([HOME, UP])
    assert names(shelf_at(tmp_path)) == ["Home", "Up"]
    assert [one.name for one in tmp_path.iterdir()] == ["arm.poses.yaml"]


def test_a_folder_that_is_only_read_keeps_them_for_the_session(tmp_path: Path):
    shelf = shelf_at(tmp_path, read_only=True)
    shelf.put([HOME])
    shelf.look()
    assert names(shelf) == ["Home"]
    assert shelf.only_here == f"the folder {tmp_path} may only be read here."
    assert list(tmp_path.iterdir()) == []


def test_a_broken_file_is_told_leaves_the_last_good_ones_and_is_not_overwritten(tmp_path: Path):
    shelf = shelf_at(tmp_path)
    shelf.put([HOME])
    shelf.path.write_text("poses: 7\n")
    shelf.look()
    assert (names(shelf), "line 1" in shelf.trouble) == (["Home"], True)
    with pytest.raises(PosesFileError):
        shelf.put([HOME, UP])
    assert shelf.path.read_text() == "poses: 7\n"
    shelf.path.unlink()
    shelf.look()
    assert (names(shelf), shelf.trouble) == ([], "")


def test_a_folder_in_its_place_is_told(tmp_path: Path):
    shelf = shelf_at(tmp_path)
    shelf.path.mkdir()
    shelf.look()
    assert shelf.trouble
    with pytest.raises(UnreadableFileError):
        shelf.put([HOME])
