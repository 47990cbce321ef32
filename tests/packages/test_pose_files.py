"""Where named poses may stand: in the robot's package and in those that configure MoveIt for it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.packages.discovery import Origin, Package
from studio.packages.index import Indexed, PackageIndex
from studio.packages.pose_files import FILE_LIMIT, pose_files
from studio.packages.roots import ServedRoots
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path


def package(folder: Path, name: str, *files: str) -> Indexed:
    made = write_package(folder / name, files=dict.fromkeys(files, ""))
    return Indexed.found(Package(name, made, Origin.SOURCE))


def names(paths: tuple[Path, ...], root: Path) -> list[str]:
    return [str(path.relative_to(root)) for path in paths]


def test_the_robots_package_comes_first_then_the_likest_moveit_package(tmp_path: Path):
    own = package(tmp_path, "arm_description", "urdf/arm.urdf", "srdf/arm.srdf", "config/x.yaml")
    moveit = [
        package(tmp_path, "zebra_moveit_config", "config/zebra.srdf"),
        package(tmp_path, "arm_moveit_config", "config/arm.srdf.xacro", "initial_positions.yaml"),
        package(tmp_path, "arm_bringup", "config/other.srdf"),
    ]
    index = PackageIndex([*moveit, own])
    found = pose_files(own.folder / "urdf/arm.urdf", index, ServedRoots([tmp_path]))
    assert names(found.srdf, tmp_path) == [
        "arm_description/srdf/arm.srdf",
        "arm_moveit_config/config/arm.srdf.xacro",
        "zebra_moveit_config/config/zebra.srdf",
    ]
    assert names(found.initial, tmp_path) == ["arm_moveit_config/initial_positions.yaml"]


def test_what_is_not_served_is_left_out_links_too(tmp_path: Path):
    own = package(tmp_path / "open", "arm_description", "urdf/arm.urdf")
    secret = package(tmp_path / "closed", "arm_moveit_config", "config/secret.srdf")
    (own.folder / "link.srdf").symlink_to(secret.folder / "config/secret.srdf")
    (own.folder / "folder").symlink_to(secret.folder)
    served = ServedRoots([tmp_path / "open"])
    found = pose_files(own.folder / "urdf/arm.urdf", PackageIndex([own, secret]), served)
    assert found[:2] == ((), ())
    assert found.folders == (own.folder, own.folder / "urdf")


def test_a_file_without_a_package_has_its_folder(tmp_path: Path):
    (tmp_path / "arm.urdf").touch()
    (tmp_path / "arm.srdf").touch()
    found = pose_files(tmp_path / "arm.urdf", PackageIndex([]), ServedRoots([tmp_path]))
    assert names(found.srdf, tmp_path) == ["arm.srdf"]


def test_of_very_many_only_the_first_are_taken(tmp_path: Path):
    many = [f"config/{number}.srdf" for number in range(FILE_LIMIT + 5)]
    own = package(tmp_path, "arm_description", "urdf/arm.urdf", *many)
    found = pose_files(own.folder / "urdf/arm.urdf", PackageIndex([own]), ServedRoots([tmp_path]))
    assert len(found.srdf) == FILE_LIMIT
