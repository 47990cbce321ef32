"""The demo's copy in the data folder."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from studio.errors import DataFolderError, PackageNotFoundError
from studio.packages.examples import working_copy
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def models(tmp_path: Path) -> Path:
    folder = tmp_path / "models"
    write_package(folder / "rover", files={"urdf/rover.urdf": "shipped", "__pycache__/a.pyc": ""})
    write_package(folder / "arm")
    (folder / "README.md").touch()
    return folder


def contents(folder: Path) -> dict[str, bytes]:
    return {str(one): one.read_bytes() for one in folder.rglob("*") if one.is_file()}


def test_all_models_are_copied_side_by_side_and_the_shipped_ones_stay_as_they_are(
    models: Path, tmp_path: Path
):
    shipped = contents(models)
    copy = working_copy(models, tmp_path / "data", "rover", fresh=False)
    assert copy == tmp_path / "data" / "models" / "rover"
    assert sorted(one.name for one in copy.parent.iterdir()) == ["arm", "rover"]
    assert not (copy / "__pycache__").exists()
    (copy / "urdf" / "rover.urdf").write_text("mine")
    assert contents(models) == shipped


def test_what_was_edited_is_kept_and_new_models_are_added(models: Path, tmp_path: Path):
    data = tmp_path / "data"
    copy = working_copy(models, data, "rover", fresh=False)
    (copy / "urdf" / "rover.urdf").write_text("mine")
    write_package(models / "leg")
    working_copy(models, data, "rover", fresh=False)
    assert (copy / "urdf" / "rover.urdf").read_text() == "mine"
    assert (data / "models" / "leg" / "package.xml").exists()


def test_a_fresh_copy_is_as_shipped_and_the_old_one_is_set_aside(models: Path, tmp_path: Path):
    data = tmp_path / "data"
    for text in ("first", "second"):
        copy = working_copy(models, data, "rover", fresh=True)
        assert (copy / "urdf" / "rover.urdf").read_text() == "shipped"
        (copy / "urdf" / "rover.urdf").write_text(text)
        (data / "models" / "arm" / "mine").touch()
    working_copy(models, data, "rover", fresh=True)
    kept = data / "models_replaced" / "rover" / "urdf" / "rover.urdf"
    assert kept.read_text() == "second"
    assert (data / "models" / "arm" / "mine").exists()


@pytest.mark.skipif(os.name == "nt", reason="modes of Unix")
def test_models_that_were_installed_read_only_are_copied_writable(models: Path, tmp_path: Path):
    for path, _, names in os.walk(models, topdown=False):
        for name in names:
            (models / path / name).chmod(0o444)
        (models / path).chmod(0o555)
    copy = working_copy(models, tmp_path / "data", "rover", fresh=False)
    assert (copy / "urdf" / "rover.urdf").stat().st_mode & 0o200
    assert (copy / "urdf").stat().st_mode & 0o200
    for path, _, _ in os.walk(models):
        (models / path).chmod(0o755)  # else pytest cannot tidy up


def test_an_unknown_model_is_a_sentence(models: Path, tmp_path: Path):
    with pytest.raises(PackageNotFoundError, match="leg"):
        working_copy(models, tmp_path / "data", "leg", fresh=False)


def test_a_data_folder_that_cannot_be_written_is_a_sentence(models: Path, tmp_path: Path):
    (tmp_path / "data").touch()
    with pytest.raises(DataFolderError, match="--data-dir"):
        working_copy(models, tmp_path / "data", "rover", fresh=False)
