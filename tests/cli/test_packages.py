from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from studio.cli.packages import ENTRIES_MAX, opened_packages

if TYPE_CHECKING:
    from pathlib import Path

    import pytest


def packages_seen() -> frozenset[str]:
    options = argparse.Namespace(package_path=[], data_dir=None)
    return frozenset(opened_packages(options).names)


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
