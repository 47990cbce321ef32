from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.packages.index import PackageIndex
from studio.packages.roots import ServedRoots
from studio.packages.uris import near_file

if TYPE_CHECKING:
    from pathlib import Path

SUFFIXES = frozenset({".stl", ".dae"})


def near(folder: Path, uri: str, *there: str, taken: tuple[str, ...] = ()) -> str:
    meshes = folder / "robots" / "meshes"
    meshes.mkdir(parents=True, exist_ok=True)
    for name in there:
        (meshes / name).write_text("")
    asking = folder / "robots" / "arm.urdf"
    roots = ServedRoots((folder / "robots",))
    return near_file(uri, asking, PackageIndex((), {}), roots, SUFFIXES, taken)


@pytest.mark.parametrize(
    ("written", "there"),
    [
        ("base.stl", "Base.STL"),
        ("base.stl", "base.dae"),
        ("BASE.obj", "base.stl"),
        ("forarm.stl", "forearm.stl"),
        ("baselink.stl", "base_link.stl"),
    ],
)
def test_another_case_ending_or_a_typing_error_is_what_was_meant(
    tmp_path: Path, written: str, there: str
):
    names = (there, "gripper.stl", "notes.txt")
    assert near(tmp_path, f"meshes/{written}", *names) == there


@pytest.mark.parametrize(
    ("written", "there"),
    [
        ("link_1.stl", ["link_2.stl"]),
        ("fl_wheel.stl", ["fr_wheel.stl"]),
        ("left_wheel.stl", ["right_wheel.stl"]),
        ("base.obj", ["base.stl", "base.dae"]),
        ("base.stl", ["base.txt"]),
        ("forarm.stl", ["forearm.stl", "forearm.dae"]),
        ("", ["base.stl"]),
    ],
)
def test_where_it_could_be_another_nothing_is_guessed(
    tmp_path: Path, written: str, there: list[str]
):
    assert near(tmp_path, f"meshes/{written}", *there) == ""


def test_what_the_robot_names_itself_is_no_typing_error(tmp_path: Path):
    taken = ("meshes/forearm.stl",)
    assert near(tmp_path, "meshes/forarm.stl", "forearm.stl", taken=taken) == ""
    assert near(tmp_path, "meshes/Forearm.stl", "forearm.stl", taken=taken) == "forearm.stl"


def test_names_beyond_the_served_folders_are_not_told(tmp_path: Path):
    (tmp_path / "secret.stl").write_text("")
    for uri in ("../Secret.stl", str(tmp_path / "Secret.stl"), "package://no/Secret.stl"):
        assert near(tmp_path, uri) == ""


def test_a_file_that_is_there_is_no_other_one(tmp_path: Path):
    assert near(tmp_path, "meshes/e.dae", "e.dae", "e.stl") == ""
