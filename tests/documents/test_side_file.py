"""A file beside the robot's: named after it, written whole or not at all, never outside."""

from __future__ import annotations

from pathlib import Path

import pytest

from studio.documents.side_file import SideFile
from studio.errors import NotSavedError, OutsideRootsError, UnreadableFileError
from studio.packages.roots import ServedRoots
from tests.support.permissions import open_folder, unprivileged


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("arm.urdf.xacro", "arm.poses.yaml"),
        ("arm.xml", "arm.poses.yaml"),
        ("arm", "arm.poses.yaml"),
    ],
)
def test_it_is_called_like_the_robot(name: str, file: str):
    assert SideFile(Path("/r") / name, "poses", ServedRoots([])).path == Path("/r") / file


def test_it_is_empty_until_it_is_written_and_keeps_its_mode(tmp_path: Path):
    side = SideFile(tmp_path / "arm.urdf", "poses", ServedRoots([tmp_path]))
    assert (side.read(10), side.only_here) == (b"", "")
    side.write(b"one")
    side.path.chmod(0o600)
    side.write(b"two")
    assert side.read(10) == b"two"
    assert side.path.stat().st_mode & 0o777 == 0o600
    assert [one.name for one in tmp_path.iterdir()] == ["arm.poses.yaml"]


def test_what_is_too_large_is_not_read(tmp_path: Path):
    side = SideFile(tmp_path / "arm.urdf", "poses", ServedRoots([tmp_path]))
    side.write(b"x" * 11)
    with pytest.raises(UnreadableFileError):
        side.read(10)


def test_a_link_out_of_the_folders_is_neither_read_nor_written(tmp_path: Path):
    inside = tmp_path / "robot"
    inside.mkdir()
    secret = tmp_path / "secret.yaml"
    secret.write_text("secret")
    side = SideFile(inside / "arm.urdf", "poses", ServedRoots([inside]))
    side.path.symlink_to(secret)
    with pytest.raises(OutsideRootsError):
        side.read(100)
    with pytest.raises(OutsideRootsError):
        side.write(b"x")
    assert secret.read_text() == "secret"
    assert side.only_here


def test_a_folder_that_cannot_be_written_leaves_nothing():
    with open_folder() as folder, unprivileged():
        side = SideFile(folder / "arm.urdf", "poses", ServedRoots([folder]))
        assert side.only_here
        with pytest.raises(NotSavedError):
            side.write(b"x")
        assert list(folder.iterdir()) == []
