"""Looks that never fail."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from studio.files import is_file, is_folder, is_there, stamp_of
from tests.support.permissions import open_folder, unprivileged

if TYPE_CHECKING:
    from pathlib import Path


def test_files_and_folders_are_told_apart(tmp_path: Path):
    (tmp_path / "file").touch()
    assert is_file(tmp_path / "file")
    assert not is_folder(tmp_path / "file")
    assert is_folder(tmp_path)
    assert not is_file(tmp_path)
    assert is_there(tmp_path)


@pytest.mark.parametrize("name", ["nothing", "x" * 5000, "a\0b"])
def test_what_is_not_there_or_cannot_be_is_not_there(tmp_path: Path, name: str):
    for look in (is_there, is_file, is_folder):
        assert not look(tmp_path / name)
    assert stamp_of(tmp_path / name) is None


@pytest.mark.skipif(os.name == "nt", reason="modes of Unix")
def test_what_lies_in_a_closed_folder_is_not_there():
    with open_folder() as folder:
        (folder / "closed").mkdir()
        (folder / "closed" / "file").touch()
        (folder / "closed").chmod(0o600)
        with unprivileged():
            assert is_folder(folder / "closed")
            assert not is_there(folder / "closed" / "file")
