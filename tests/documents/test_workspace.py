"""What a document's files may see: the environment only when trusted, in an archive never."""

from __future__ import annotations

import zipfile
from typing import TYPE_CHECKING

from studio.documents.workspace import read_policy
from studio.packages.workspace import open_location
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

ROBOT = '<robot name="r"><link name="a"/></robot>'


def test_a_trusted_file_sees_the_whole_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("STUDIO_SECRET", "s")
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    package = write_package(tmp_path / "ws" / "r_description", files={"r.urdf": ROBOT})
    location = open_location(package / "r.urdf", (), tmp_path / "data", {})
    hidden = read_policy(location, trusted=False)
    shown = read_policy(location, trusted=True)
    assert "STUDIO_SECRET" not in hidden.environment
    assert hidden.environment["ROS_DISTRO"] == "jazzy"
    assert shown.environment["STUDIO_SECRET"] == "s"
    assert shown.roots == hidden.roots


def test_what_came_in_an_archive_is_never_trusted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("STUDIO_SECRET", "s")
    package = write_package(tmp_path / "ws" / "r_description", files={"r.urdf": ROBOT})
    archive = tmp_path / "r.zip"
    with zipfile.ZipFile(archive, "w") as out:
        for file in package.rglob("*"):
            out.write(file, file.relative_to(package.parent))
    location = open_location(archive, (), tmp_path / "data", {})
    assert location.is_unpacked
    policy = read_policy(location, trusted=True)
    assert not policy.trusted
    assert "STUDIO_SECRET" not in policy.environment
