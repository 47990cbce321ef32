"""What another program writes to a file that is held: taken, merged, or left to choose."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.editing.edits import apply
from studio.description.editing.sources import FileChange
from studio.errors import UnreadableFileError
from tests.support.edited_rover import ROVER, count, radius

if TYPE_CHECKING:
    from pathlib import Path

    from studio.description.editing.merging import Side
    from studio.description.editing.sources import Sources


def test_a_change_on_disk_is_taken_when_there_is_nothing_to_lose(sources: Sources, rover: Path):
    theirs = ROVER.replace("'4'", "'8'").encode()
    rover.write_bytes(theirs)
    assert sources.refresh(str(rover)).what is FileChange.RELOADED
    assert (sources.text(str(rover)), sources.unsaved_files) == (theirs, ())
    assert sources.refresh(str(rover)).what is FileChange.NONE


def test_a_change_on_disk_beside_unsaved_edits_is_merged_and_they_stay_unsaved(
    sources: Sources, rover: Path
):
    sources.edit_site(radius(rover), "0.125")
    ours, theirs = sources.text(str(rover)), ROVER.replace("'4'", "'8'").encode()
    rover.write_bytes(b"<!-- by another -->" + theirs)
    news = sources.refresh(str(rover))
    assert (news.what, news.kept) == (FileChange.MERGED, 1)
    both = b"<!-- by another -->" + ours.replace(b"'4'", b"'8'")
    assert sources.text(str(rover)) == apply(ours, news.edits) == both
    assert sources.unsaved_count == 1
    assert (sources.saved_text(radius(rover)), sources.saved_text(count(rover))) == ("0.1", None)
    assert sources.save() == (str(rover),)
    assert rover.read_bytes() == both


def test_a_merge_and_what_was_merged_are_taken_back_one_after_the_other(
    sources: Sources, rover: Path
):
    sources.edit_site(radius(rover), "0.125")
    ours = sources.text(str(rover))
    for wheels in ("'5'", "'6'", "'8'"):
        rover.write_bytes(ROVER.replace("'4'", wheels).encode())
        sources.refresh(str(rover))
    assert sources.undo_labels == ("wheel_radius 0.1 → 0.125", "Changed on disk: rover.xacro")
    sources.undo()
    assert sources.text(str(rover)) == ours
    sources.undo()
    assert sources.text(str(rover)) == ROVER.encode()
    sources.redo()
    sources.redo()
    assert sources.text(str(rover)) == ours.replace(b"'4'", b"'8'")


def test_a_change_on_disk_of_the_very_place_that_is_edited_is_a_conflict(
    sources: Sources, rover: Path, limits: Path
):
    sources.edit_site(radius(rover), "0.125")
    sources.edit_site(f"{limits}#pan.max", "2.0")
    ours, theirs = sources.text(str(rover)), ROVER.replace('"0.1"', '"0.3"').encode()
    rover.write_bytes(theirs)
    assert sources.refresh(str(rover)).what is FileChange.CONFLICT
    assert (sources.text(str(rover)), sources.conflicts) == (ours, {str(rover)})
    sources.reload(str(rover))
    assert (sources.text(str(rover)), sources.conflicts) == (theirs, frozenset())
    assert sources.unsaved_files == (str(limits),)


@pytest.mark.parametrize(("wins", "value"), [("mine", '"0.125"'), ("theirs", '"0.3"')])
def test_who_wins_a_conflict_has_the_place_and_undo_brings_back_the_other(
    sources: Sources, rover: Path, wins: Side, value: str
):
    sources.edit_site(radius(rover), "0.125")
    sources.edit_site(count(rover), "6")
    ours = sources.text(str(rover))
    rover.write_bytes(ROVER.replace('"0.1"', '"0.3"').replace("true", "false").encode())
    sources.refresh(str(rover))
    edits = sources.resolve(str(rover), wins)
    wanted = ours.replace(b'"0.125"', value.encode()).replace(b"true", b"false")
    assert sources.text(str(rover)) == apply(ours, edits) == wanted
    assert sources.conflicts == frozenset()
    for label in reversed(sources.undo_labels[2:]):
        assert "rover.xacro" in label
        sources.undo()
        if wins == "mine":
            assert b'"0.3"' in sources.text(str(rover)) or sources.text(str(rover)) == ours
    assert sources.text(str(rover)) == ours


def test_a_half_written_file_heals_when_the_rest_of_it_comes(sources: Sources, rover: Path):
    sources.edit_site(count(rover), "6")
    ours, theirs = sources.text(str(rover)), ROVER.replace("0.1", "0.2").encode()
    for size in (0, 60, 150, len(theirs)):
        rover.write_bytes(theirs[:size])
        sources.refresh(str(rover))
    assert sources.text(str(rover)) == ours.replace(b"0.1", b"0.2")
    assert (sources.conflicts, sources.unsaved_count) == (frozenset(), 1)


def test_a_change_on_disk_that_says_what_we_say_is_none(sources: Sources, rover: Path):
    sources.edit_site(radius(rover), "0.125")
    rover.write_bytes(sources.text(str(rover)))
    assert sources.refresh(str(rover)).what is FileChange.NONE
    assert (sources.unsaved_files, sources.conflicts) == ((), frozenset())


def test_a_file_that_went_away_keeps_its_text_here(sources: Sources, rover: Path):
    rover.unlink()
    assert sources.refresh(str(rover)).what is FileChange.GONE
    assert sources.text(str(rover)) == ROVER.encode()
    with pytest.raises(UnreadableFileError):
        sources.reload(str(rover))


def test_a_file_that_nobody_holds_changes_nothing(sources: Sources, tmp_path: Path):
    assert sources.refresh(str(tmp_path / "other")).what is FileChange.NONE
