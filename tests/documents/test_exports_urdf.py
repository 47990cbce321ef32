"""Meshes of an exported URDF: named by path, or copied beside it under names of their own."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree

from studio.documents.exports import with_absolute_paths, with_copied_meshes
from studio.packages.workspace import open_location
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.workspace import Location


def urdf(*names: str) -> str:
    links = "".join(
        f'<link name="l{at}"><visual><geometry><mesh filename="{name}"/></geometry></visual></link>'
        for at, name in enumerate(names)
    )
    return f'<robot name="r">{links}</robot>'


def names_in(text: str) -> list[str]:
    return [one.get("filename", "") for one in ElementTree.fromstring(text).iter("mesh")]


def location_of(tmp_path: Path, text: str) -> Location:
    files = {"r.urdf": text, "meshes/a b.stl": "solid", "a.stl": "solid"}
    package = write_package(tmp_path / "ws/src/r", files=files)
    write_package(tmp_path / "ws/src/other", files={"r/a.stl": "solid"})
    return open_location(package / "r.urdf", (), tmp_path / "data", {})


def test_a_mesh_that_is_not_found_stays_as_it_is_written(tmp_path: Path):
    text = urdf("package://r/meshes/a b.stl", "package://gone/x.stl", "http://x/y.stl", "")
    location = location_of(tmp_path, text)
    found, *kept = names_in(with_absolute_paths(text, location))
    assert found == (tmp_path / "ws/src/r/meshes/a b.stl").as_uri()
    assert kept == ["package://gone/x.stl", "http://x/y.stl", ""]


def test_one_file_under_two_names_is_copied_once_and_two_of_one_name_twice(tmp_path: Path):
    text = urdf("package://r/a.stl", "a.stl", "package://other/r/a.stl")
    changed, files = with_copied_meshes(text, location_of(tmp_path, text))
    assert names_in(changed) == ["meshes/r/a.stl", "meshes/r/a.stl", "meshes/other/r/a.stl"]
    assert {one.name for one in files} == {"meshes/r/a.stl", "meshes/other/r/a.stl"}
