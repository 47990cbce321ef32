"""Where items are kept: beside the file, or for the session where nothing may be written."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import pytest

from studio.description.editing.variants import Variant, read_variants, write_variants
from studio.description.poses import NamedPose, read_poses, write_poses
from studio.documents.side_file import ItemKind, NamedItems
from studio.errors import CommandError, OutsideRootsError, UnreadableFileError, VariantsFileError
from studio.packages.roots import ServedRoots

VARIANTS: Final = ItemKind("variant", read_variants, write_variants)
ONE, TWO = Variant("One", "first"), Variant("Two")


@pytest.fixture
def entry(tmp_path: Path) -> Path:
    path = tmp_path / "robot" / "rover.urdf.xacro"
    path.parent.mkdir()
    path.write_text("<robot/>")
    return path


def shelf_at(entry: Path, *, read_only: bool = False) -> NamedItems[Variant]:
    roots = [entry.parent]
    return NamedItems(entry, ServedRoots([], roots) if read_only else ServedRoots(roots), VARIANTS)


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
    assert NamedItems(Path("/r") / name, ServedRoots([]), VARIANTS).path == Path("/r") / file


def test_what_is_put_is_on_the_disk_whole_and_nothing_else(entry: Path):
    shelf = shelf_at(entry)
    shelf.put((ONE, TWO))
    assert shelf.items == shelf_at(entry).items == (ONE, TWO)
    assert sorted(one.name for one in entry.parent.iterdir()) == [
        "rover.urdf.xacro",
        "rover.variants.yaml",
    ]


def test_poses_stand_in_a_file_of_their_own_and_know_their_lines(entry: Path):
    kind = ItemKind("pose", read_poses, write_poses)
    shelf = NamedItems(entry, ServedRoots([entry.parent]), kind)
    shelf.put([NamedPose("Home", {"a": 0.0}), NamedPose("Up", {"a": 1.0})])
    assert shelf.path.name == "rover.poses.yaml"
    assert [(one.name, one.line) for one in shelf.items] == [("Home", 5), ("Up", 8)]


def test_a_change_by_hand_is_kept_when_another_is_put(entry: Path):
    shelf = shelf_at(entry)
    shelf.put((ONE,))
    text = shelf.path.read_text()
    shelf.path.write_text(text.replace("  - name: One", "  # mine\n  - name: One"))
    shelf.put((ONE, TWO))
    assert "# mine\n  - name: One" in shelf.path.read_text()


def test_a_broken_file_is_told_leaves_the_last_good_ones_and_is_not_overwritten(entry: Path):
    shelf = shelf_at(entry)
    shelf.put((ONE,))
    shelf.path.write_text("variants: 7\n")
    shelf.refresh()
    assert shelf.items == (ONE,)
    assert "line 1 must be a list" in shelf.trouble
    with pytest.raises(VariantsFileError):
        shelf.put((ONE, TWO))
    assert shelf.path.read_text() == "variants: 7\n"
    shelf.path.unlink()
    shelf.refresh()
    assert (shelf.items, shelf.trouble) == ((), "")


def test_a_folder_that_is_only_read_keeps_them_for_the_session(entry: Path):
    shelf = shelf_at(entry, read_only=True)
    shelf.put((ONE,))
    assert shelf.only_here == f"the folder {entry.parent} may only be read here."
    shelf.refresh()
    assert shelf.items == (ONE,)
    assert not shelf.path.exists()


def test_a_link_out_of_the_folders_is_neither_read_nor_written(entry: Path, tmp_path: Path):
    outside = tmp_path / "outside.yaml"
    outside.write_text("variants:\n  - name: Secret\n")
    (entry.parent / "rover.variants.yaml").symlink_to(outside)
    shelf = shelf_at(entry)
    assert (shelf.items, "outside the opened folders" in shelf.trouble) == ((), True)
    with pytest.raises(OutsideRootsError):
        shelf.put((ONE,))
    assert "Secret" in outside.read_text()


def test_a_folder_in_its_place_is_told(entry: Path):
    shelf = shelf_at(entry)
    shelf.path.mkdir()
    shelf.refresh()
    assert shelf.trouble
    with pytest.raises(UnreadableFileError):
        shelf.put((ONE,))


def test_an_item_is_found_as_the_file_has_it_now(entry: Path):
    shelf = shelf_at(entry)
    shelf_at(entry).put((ONE,))
    assert shelf.find("One") == ONE
    with pytest.raises(CommandError, match='no variant "Two" any more'):
        shelf.find("Two")


@pytest.mark.parametrize("wanted", ["", "  ", "x" * 101, "two\nlines"])
def test_what_is_no_name_is_refused(entry: Path, wanted: str):
    with pytest.raises(CommandError, match="A variant needs a name of one line"):
        shelf_at(entry).free_name(wanted)


def test_a_name_loses_the_blanks_around_it_and_must_be_free(entry: Path):
    shelf = shelf_at(entry)
    shelf.put((ONE,))
    assert shelf.free_name("  Two ") == "Two"
    with pytest.raises(CommandError, match='a variant "One" already'):
        shelf.free_name("One ")
