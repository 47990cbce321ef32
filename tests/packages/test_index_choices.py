"""Folders that were chosen for packages."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.errors import PackageNotFoundError, UnreadableFileError
from studio.packages.index import folder_of_choice, load_choices, save_choices
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path


def test_choices_are_kept_for_each_workspace(tmp_path: Path):
    arm, leg = (write_package(tmp_path / name) for name in ("arm", "leg"))
    save_choices(tmp_path / "data", tmp_path / "ws1", {"arm": arm, "leg": leg})
    save_choices(tmp_path / "data", tmp_path / "ws2", {"arm": leg})
    assert load_choices(tmp_path / "data", tmp_path / "ws1") == {"arm": arm, "leg": leg}
    assert load_choices(tmp_path / "data", tmp_path / "ws2") == {"arm": leg}
    assert load_choices(tmp_path / "data", tmp_path / "ws3") == {}


@pytest.mark.parametrize("spoiled", [b"", b"{", b"[1]", b'{"a": 1}', b"\xff"])
def test_a_spoiled_file_of_choices_is_forgotten(tmp_path: Path, spoiled: bytes):
    save_choices(tmp_path, tmp_path / "ws", {"arm": tmp_path})
    (file,) = (tmp_path / "chosen_packages").iterdir()
    file.write_bytes(spoiled)
    assert load_choices(tmp_path, tmp_path / "ws") == {}


def test_a_folder_means_the_package_of_that_name_in_it(tmp_path: Path):
    inner = write_package(tmp_path / "repo" / "folder", "arm")
    write_package(tmp_path / "repo" / "leg")
    assert folder_of_choice("arm", tmp_path / "repo") == inner
    assert folder_of_choice("arm", inner) == inner


def test_a_folder_without_any_manifest_is_taken_at_its_word(tmp_path: Path):
    (tmp_path / "arm_description").mkdir()
    chosen = folder_of_choice("arm", tmp_path / "arm_description")
    assert chosen == tmp_path / "arm_description"


def test_a_package_of_another_name_is_refused(tmp_path: Path):
    with pytest.raises(PackageNotFoundError, match='"arm"'):
        folder_of_choice("arm", write_package(tmp_path / "leg"))


def test_a_file_is_refused(tmp_path: Path):
    (tmp_path / "arm").touch()
    with pytest.raises(UnreadableFileError, match="is no folder"):
        folder_of_choice("arm", tmp_path / "arm")
