"""Where variants are kept: beside the file, or for the session where nothing may be written."""

from __future__ import annotations

from pathlib import Path

import pytest

from studio.description.editing.variants import Variant
from studio.engine.variant_shelf import VariantShelf
from studio.errors import OutsideRootsError, UnreadableFileError, VariantsFileError
from studio.packages.roots import ServedRoots

ONE, TWO = Variant("One", "first"), Variant("Two")


@pytest.fixture
def entry(tmp_path: Path) -> Path:
    path = tmp_path / "robot" / "rover.urdf.xacro"
    path.parent.mkdir()
    path.write_text("<robot/>")
    return path


def shelf_at(entry: Path, *, read_only: bool = False) -> VariantShelf:
    roots = [entry.parent]
    made = VariantShelf(entry, ServedRoots([], roots) if read_only else ServedRoots(roots))
    made.look()
    return made


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("rover.urdf.xacro", "rover.variants.yaml"),
        ("rover.xacro", "rover.variants.yaml"),
        ("my.robot.urdf", "my.robot.variants.yaml"),
        ("robot", "robot.variants.yaml"),
    ],
)
def test_the_file_is_called_like_the_robot(name: str, file: str):
    assert VariantShelf(Path("/r") / name, ServedRoots([])).path == Path("/r") / file


def test_what_is_put_is_on_the_disk_whole_and_nothing_else(entry: Path):
    shelf_at(entry).put((ONE, TWO))
    assert shelf_at(entry).variants == (ONE, TWO)
    assert sorted(one.name for one in entry.parent.iterdir()) == [
        "rover.urdf.xacro",
        "rover.variants.yaml",
    ]


def test_a_change_by_hand_is_kept_when_another_is_put(entry: Path):
    shelf = shelf_at(entry)
    shelf.put((ONE,))
    text = shelf.path.read_text()
    shelf.path.write_text(text.replace("  - name: One", "  # mine\n  - name: One"))
    assert not shelf.look()
    shelf.put((ONE, TWO))
    assert "# mine\n  - name: One" in shelf.path.read_text()


def test_a_broken_file_is_told_leaves_the_last_good_ones_and_is_not_overwritten(entry: Path):
    shelf = shelf_at(entry)
    shelf.put((ONE,))
    shelf.path.write_text("variants: 7\n")
    assert shelf.look()
    assert shelf.variants == (ONE,)
    assert "line 1 must be a list" in shelf.trouble
    with pytest.raises(VariantsFileError):
        shelf.put((ONE, TWO))
    assert shelf.path.read_text() == "variants: 7\n"
    shelf.path.unlink()
    assert shelf.look()
    assert (shelf.variants, shelf.trouble) == ((), "")


def test_a_folder_that_is_only_read_keeps_them_for_the_session(entry: Path):
    shelf = shelf_at(entry, read_only=True)
    shelf.put((ONE,))
    assert shelf.only_here == f"the folder {entry.parent} may only be read here."
    assert not shelf.look()
    assert shelf.variants == (ONE,)
    assert not shelf.path.exists()


def test_a_link_out_of_the_folders_is_neither_read_nor_written(entry: Path, tmp_path: Path):
    outside = tmp_path / "outside.yaml"
    outside.write_text("variants:\n  - name: Secret\n")
    (entry.parent / "rover.variants.yaml").symlink_to(outside)
    shelf = shelf_at(entry)
    assert (shelf.variants, "outside the opened folders" in shelf.trouble) == ((), True)
    with pytest.raises(OutsideRootsError):
        VariantShelf(entry, ServedRoots([entry.parent])).put((ONE,))
    assert "Secret" in outside.read_text()


def test_a_folder_in_its_place_is_told(entry: Path):
    shelf = shelf_at(entry)
    shelf.path.mkdir()
    assert shelf.look()
    assert shelf.trouble
    with pytest.raises(UnreadableFileError):
        shelf.put((ONE,))
