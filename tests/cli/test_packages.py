from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from studio.cli.packages import ENTRIES_MAX, opened_packages
from studio.packages.recent import RecentFiles

if TYPE_CHECKING:
    from pathlib import Path

    import pytest


def packages_seen(data: Path | None = None, *, to_run: bool = False) -> frozenset[str]:
    options = argparse.Namespace(package_path=[], data_dir=data)
    return frozenset(opened_packages(options, to_run=to_run).names)


def package_at(folder: Path) -> None:
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text(f"<package><name>{folder.name}</name></package>")


def test_packages_that_lie_right_in_the_folder_are_seen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    package_at(tmp_path / "own_interfaces")
    package_at(tmp_path / "far" / "not_here")
    monkeypatch.chdir(tmp_path)
    seen = packages_seen()
    assert "own_interfaces" in seen
    assert "not_here" not in seen


def test_a_folder_of_very_many_things_is_not_looked_through(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    package_at(tmp_path / "own_interfaces")
    for number in range(ENTRIES_MAX):
        (tmp_path / f"download_{number}").touch()
    monkeypatch.chdir(tmp_path)
    assert "own_interfaces" not in packages_seen()


def test_what_came_in_a_zip_is_seen_and_not_run_though_it_was_opened_last(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    data = tmp_path / "data"
    unpacked = data / "uploads" / "0123" / "turtlesim"
    package_at(unpacked)
    (unpacked / "turtle.urdf").touch()
    RecentFiles(data).note(str(unpacked / "turtle.urdf"), "turtle", {}, 1.0)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert "turtlesim" in packages_seen(data)
    assert "turtlesim" not in packages_seen(data, to_run=True)
    monkeypatch.chdir(unpacked)  # who goes there means it
    assert "turtlesim" in packages_seen(data, to_run=True)
