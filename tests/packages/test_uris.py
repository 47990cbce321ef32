"""From written names to files."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from studio.errors import OutsideRootsError, PackageNotFoundError, UnreadableFileError
from studio.packages.index import Indexed, PackageIndex, Rank
from studio.packages.roots import ServedRoots
from studio.packages.uris import resolve_uri
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path


class Place:
    """A rover package below a root, a secret beside it, and what resolves there."""

    def __init__(self, base: Path) -> None:
        self.root = base / "ws"
        self.package = write_package(
            self.root / "rover",
            files={
                "urdf/rover.urdf": "<robot/>",
                "urdf/near.stl": "",
                "meshes/base.stl": "",
                "meshes/two words.stl": "",
                "meshes/100%25.stl": "",
            },
        )
        (base / "secret.stl").touch()
        self.asking_file = self.package / "urdf" / "rover.urdf"
        self.roots = ServedRoots([self.root])
        self.index = PackageIndex([Indexed("rover", self.package, Rank.OPENED)])

    def find(self, uri: str) -> str:
        found = resolve_uri(uri, self.asking_file, self.index, self.roots)
        return str(found.relative_to(self.package))


@pytest.fixture
def place(tmp_path: Path) -> Place:
    return Place(tmp_path)


@pytest.mark.parametrize(
    ("uri", "found"),
    [
        ("package://rover/meshes/base.stl", "meshes/base.stl"),
        ("package:///rover/meshes/base.stl", "meshes/base.stl"),
        ("PACKAGE://rover//meshes/base.stl", "meshes/base.stl"),
        ("model://rover/meshes/base.stl", "meshes/base.stl"),
        ("package://rover/urdf/../meshes/base.stl", "meshes/base.stl"),
        ("package://rover/meshes/two%20words.stl", "meshes/two words.stl"),
        ("package://rover/meshes/two words.stl", "meshes/two words.stl"),
        ("package://rover/meshes/100%25.stl", "meshes/100%25.stl"),
        ("file://{package}/meshes/base.stl", "meshes/base.stl"),
        ("file://localhost{package}/meshes/base.stl", "meshes/base.stl"),
        ("file:{package}/meshes/base.stl", "meshes/base.stl"),
        ("{package}/meshes/base.stl", "meshes/base.stl"),
        ("../meshes/base.stl", "meshes/base.stl"),
        ("meshes/base.stl", "meshes/base.stl"),
        ("near.stl", "urdf/near.stl"),
        ("  near.stl ", "urdf/near.stl"),
    ],
)
def test_a_written_name_finds_its_file(place: Place, uri: str, found: str):
    assert place.find(uri.format(package=place.package)) == found


@pytest.mark.parametrize(
    "uri",
    [
        "package://rover/../../secret.stl",
        "package://rover//../../../etc/passwd",
        "model://rover/../../secret.stl",
        "../../../secret.stl",
        "file:///etc/passwd",
        "/etc/passwd",
        "package://rover/" + "../" * 30 + "etc/passwd",
    ],
)
def test_a_name_that_leads_out_of_the_roots_is_refused(place: Place, uri: str):
    with pytest.raises(OutsideRootsError):
        place.find(uri)


@pytest.mark.parametrize("steps", ["%2e%2e/%2e%2e", "%2e%2e/../.."])
def test_an_escaped_way_out_is_not_taken(place: Place, steps: str):
    with pytest.raises((OutsideRootsError, UnreadableFileError)):
        place.find(f"package://rover/{steps}/secret.stl")


@pytest.mark.skipif(os.name == "nt", reason="symlinks of Unix")
def test_a_link_that_leads_out_of_the_roots_is_refused(place: Place, tmp_path: Path):
    (place.package / "meshes" / "link.stl").symlink_to(tmp_path / "secret.stl")
    with pytest.raises(OutsideRootsError):
        place.find("package://rover/meshes/link.stl")


def test_an_unknown_package_is_named(place: Place):
    with pytest.raises(PackageNotFoundError, match='package "leg" was not found'):
        place.find("package://leg/meshes/base.stl")


@pytest.mark.parametrize(
    "uri", ["package://rover/meshes/no.stl", "no.stl", "package://rover/a%zz", "x" * 5000]
)
def test_a_missing_file_says_where_it_was_looked_for(place: Place, uri: str):
    with pytest.raises(UnreadableFileError, match=r"does not exist \(looked for /"):
        place.find(uri)


@pytest.mark.parametrize("uri", ["", "   "])
def test_an_empty_name_is_a_sentence(place: Place, uri: str):
    with pytest.raises(UnreadableFileError, match="a file name is empty"):
        place.find(uri)


@pytest.mark.parametrize("uri", ["http://host/a.stl", "https://host/a", "data:text/plain,a"])
def test_nothing_is_fetched(place: Place, uri: str):
    with pytest.raises(UnreadableFileError, match="names no file"):
        place.find(uri)


@pytest.mark.parametrize("uri", ["C:/robots/a.stl", "file:///C:/robots/a.stl", "c:\\robots\\a.stl"])
def test_a_drive_letter_is_no_scheme(place: Place, uri: str):
    with pytest.raises((OutsideRootsError, UnreadableFileError)) as caught:
        place.find(uri)
    assert "names no file" not in str(caught.value)


def test_a_name_with_a_nul_is_a_sentence(place: Place):
    with pytest.raises(UnreadableFileError):
        place.find("package://rover/a\0b.stl")
