from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

import pytest

from studio.errors import UnknownTypeError, UnreadableFileError, WireSettingsError
from studio.ros.messages import INTERFACES_VARIABLE, add_own_types
from studio.ros.types.files import texts_at
from studio.ros.types.library import TypeLibrary

if TYPE_CHECKING:
    from pathlib import Path

CELL = "own_interfaces/msg/Cell"


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A package whose folder is called otherwise."""
    folder = tmp_path / "src" / "checkout"
    (folder / "msg").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>own_interfaces</name></package>")
    (folder / "msg" / "Cell.msg").write_text("float32 voltage\n")
    return folder


def test_a_package_a_folder_of_packages_and_a_file_are_read_alike(package: Path):
    told = {CELL: "float32 voltage\n"}
    for path in (package, package.parent, package / "msg" / "Cell.msg"):
        assert texts_at(path).texts == told


@pytest.mark.skipif(sys.platform == "win32", reason="no links there")
def test_a_manifest_that_is_a_link_out_of_its_folder_is_passed_over(package: Path, tmp_path: Path):
    manifest = package / "package.xml"
    manifest.rename(tmp_path / "package.xml")
    manifest.symlink_to(tmp_path / "package.xml")
    assert texts_at(package).texts == {"checkout/msg/Cell": "float32 voltage\n"}


def test_what_holds_no_types_is_one_sentence(tmp_path: Path, package: Path):
    for path in (tmp_path / "none", tmp_path, package / "package.xml"):
        with pytest.raises(UnreadableFileError):
            texts_at(path)


def test_the_paths_of_the_environment_are_taken_up(package: Path, tmp_path: Path):
    other = tmp_path / "more_interfaces" / "msg"
    other.mkdir(parents=True)
    (other / "Pack.msg").write_text("own_interfaces/Cell[] cells\n")
    library = TypeLibrary("jazzy")
    add_own_types(
        library, {INTERFACES_VARIABLE: f"{package}{os.pathsep}{os.pathsep}{other.parent}"}
    )
    pack = library.message("more_interfaces/msg/Pack")
    cell = library.message(CELL)(voltage=1.5)
    assert pack(cells=[cell]).cells[0].voltage == 1.5


def test_without_the_variable_nothing_is_added():
    library = TypeLibrary("jazzy")
    add_own_types(library, {})
    with pytest.raises(UnknownTypeError):
        library.message(CELL)


def test_a_path_that_cannot_be_is_said_with_the_variable(tmp_path: Path, package: Path):
    for path in (tmp_path / "none", package / "package.xml"):
        with pytest.raises(WireSettingsError, match=f"^{INTERFACES_VARIABLE}: "):
            add_own_types(TypeLibrary("jazzy"), {INTERFACES_VARIABLE: str(path)})


def test_of_a_package_with_a_faulty_text_the_others_are_known(package: Path):
    bad = package / "msg" / "Bad.msg"
    bad.write_text("# Mine.\nfloat x\n")
    library = TypeLibrary("jazzy")
    add_own_types(library, {INTERFACES_VARIABLE: str(package)})
    assert library.message(CELL)(voltage=1.5).voltage == 1.5
    with pytest.raises(UnknownTypeError, match=f'{bad}:2: "float" is no type: write float32 or'):
        library.message("own_interfaces/msg/Bad")
