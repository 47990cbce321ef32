"""The texts of a document: edits, undo, saving and reloading, on real files and real sites."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from studio.description.editing.edits import apply, decode
from studio.description.editing.sources import Sources
from studio.description.session import Session
from studio.description.sites.widgets import parse_number
from studio.description.values import (
    Edit,
    EditRequest,
    Expansion,
    OpenRequest,
    ReadPolicy,
)
from studio.errors import EditError, SaveConflictError, StaleEditError, UnreadableFileError
from studio.packages.roots import ServedRoots
from tests.support.corpus_files import package_folders
from tests.support.edited_rover import ROVER, count, opened, radius

if TYPE_CHECKING:
    from pathlib import Path


def test_an_edit_changes_the_text_here_and_not_the_disk(sources: Sources, rover: Path):
    edit = sources.edit_site(radius(rover), "0.125")
    changed = ROVER.replace("0.1", "0.125").encode()
    assert sources.text(str(rover)) == apply(ROVER.encode(), [edit]) == changed
    assert rover.read_bytes() == ROVER.encode()
    assert (sources.unsaved_files, sources.unsaved_count) == ((str(rover),), 1)
    assert sources.overlay() == {str(rover): changed}


def test_saving_writes_only_the_changed_bytes_of_only_the_changed_files(
    sources: Sources, rover: Path, limits: Path
):
    before = limits.stat().st_mtime_ns
    sources.edit_site(radius(rover), "0.125")
    assert sources.save() == (str(rover),)
    assert rover.read_bytes() == ROVER.replace("0.1", "0.125").encode()
    assert limits.stat().st_mtime_ns == before
    assert (sources.unsaved_files, sources.unsaved_count, sources.save()) == ((), 0, ())


def test_a_yaml_value_is_edited_and_saved_as_well(sources: Sources, limits: Path):
    sources.edit_site(f"{limits}#pan.name", "it's π")
    sources.edit_site(f"{limits}#pan.max", "1.75")
    sources.save()
    assert limits.read_text("utf-8") == "pan: {max: 1.75, name: 'it''s π'}\n"


def test_one_drag_is_one_step_that_undo_takes_back_whole(sources: Sources, rover: Path):
    for text in ("0.11", "0.1234", "0.12"):
        sources.edit_site(radius(rover), text, gesture="drag")
    assert sources.undo_labels == ("wheel_radius 0.1 → 0.12",)
    change = sources.undo()
    assert change is not None
    assert apply(ROVER.replace("0.1", "0.12").encode(), change.edits) == ROVER.encode()
    assert (sources.unsaved_files, sources.redo_labels) == ((), ("wheel_radius 0.1 → 0.12",))


def test_a_drag_that_ends_where_it_began_leaves_no_step(sources: Sources, rover: Path):
    for text in ("0.11", "0.1"):
        sources.edit_site(radius(rover), text, gesture="drag")
    assert (sources.undo_labels, sources.unsaved_count) == ((), 0)


def test_thousands_of_edits_are_one_step_and_quick(tmp_path: Path):
    """Quick, as the time limit of each test is; it was minutes when every edit moved all others."""
    line, count = b'<link name="wheel"/>' + b" " * 180 + b"\n", 5_000
    text, file = line * count, str(tmp_path / "a.urdf")
    sources = Sources(lambda _: text, lambda path: path)
    starts = range((count - 1) * len(line) + 12, 0, -len(line))
    sources.edit_all([Edit(file, start, start + 5, b"roller") for start in starts], "Rename")
    written = text.replace(b"wheel", b"roller")
    assert (sources.text(file), sources.unsaved_count) == (written, count)
    assert sources.kept().sound() == sources.kept()
    sources.undo()
    assert (sources.text(file), sources.unsaved_count, sources.undo_labels) == (text, 0, ())
    sources.redo()
    assert (sources.text(file), sources.undo_labels) == (written, ("Rename",))


def test_redo_does_the_step_again(sources: Sources, rover: Path):
    sources.edit_site(radius(rover), "0.125")
    after = sources.text(str(rover))
    sources.undo()
    change = sources.redo()
    assert change is not None
    assert sources.text(str(rover)) == apply(ROVER.encode(), change.edits) == after


def test_arguments_are_steps_too(sources: Sources):
    sources.set_argument("arm", "true")
    sources.set_argument("lidar", "vlp16")
    assert sources.undo_labels == ("arm false → true", "lidar (empty) → vlp16")
    first, second = sources.undo(), sources.undo()
    assert first is not None
    assert second is not None
    assert (first.arguments, second.arguments) == ({"arm": "true"}, {"arm": "false"})
    sources.redo()
    sources.set_argument("arm", None)
    assert sources.arguments == {}


def test_an_empty_history_has_nothing_to_undo(sources: Sources):
    assert (sources.undo(), sources.redo()) == (None, None)


def test_undo_after_a_save_makes_the_file_unsaved_again(sources: Sources, rover: Path):
    sources.edit_site(radius(rover), "0.125")
    sources.save()
    sources.undo()
    assert sources.unsaved_files == (str(rover),)
    assert sources.saved_text(radius(rover)) == "0.125"
    sources.save()
    assert rover.read_bytes() == ROVER.encode()


def test_a_site_tells_what_the_disk_says_when_that_differs(sources: Sources, rover: Path):
    sources.edit_site(radius(rover), "0.125")
    assert sources.saved_text(radius(rover)) == "0.1"
    assert sources.saved_text(count(rover)) is None


def test_resetting_a_site_gives_it_the_bytes_of_the_disk(sources: Sources, rover: Path):
    sources.edit_site(radius(rover), "0.125")
    sources.edit_site(count(rover), "6")
    assert sources.reset_site(radius(rover)) is not None
    assert sources.text(str(rover)) == ROVER.replace("'4'", "'6'").encode()
    assert sources.reset_site(radius(rover)) is None
    assert sources.undo_labels[-1] == "wheel_radius 0.125 → 0.1"


def test_a_site_that_no_run_has_seen_is_refused(sources: Sources, rover: Path):
    with pytest.raises(StaleEditError):
        sources.edit_site(f"{rover}#99@value", "1")


def test_an_edit_of_a_file_outside_the_folders_is_refused(sources: Sources, tmp_path: Path):
    with pytest.raises(EditError, match="not in the file"):
        sources.edit(Edit(str(tmp_path / "rover.xacro"), 9000, 9001, b"x"), "x")
    with pytest.raises(UnreadableFileError):
        sources.edit(Edit(str(tmp_path / "missing.xacro"), 0, 0, b"x"), "x")
    assert sources.undo_labels == ()


def test_a_save_is_refused_when_the_disk_has_changed_and_nothing_is_lost(
    sources: Sources, rover: Path
):
    sources.edit_site(radius(rover), "0.125")
    rover.write_bytes(ROVER.replace("'4'", "'8'").encode())
    with pytest.raises(SaveConflictError):
        sources.save()
    assert sources.unsaved_files == (str(rover),)
    assert b"'8'" in rover.read_bytes()


def test_undo_brings_back_what_a_reload_gave_up(sources: Sources, rover: Path):
    sources.edit_site(radius(rover), "0.125")
    ours = sources.text(str(rover))
    sources.reload(str(rover))
    assert sources.undo_labels[-1] == "Reload rover.xacro"
    sources.undo()
    assert sources.text(str(rover)) == ours
    sources.undo()
    assert sources.text(str(rover)) == ROVER.encode()


def test_a_failed_run_may_be_followed_by_more_edits(sources: Sources, rover: Path):
    """The sites stay those of the last good run; spans follow the edits."""
    sources.edit_site(radius(rover), "${broken")
    sources.edit_site(count(rover), "12")
    sources.edit_site(radius(rover), "0.2")
    assert sources.text(str(rover)) == ROVER.replace("0.1", "0.2").replace("'4'", "'12'").encode()


WRITES = st.tuples(st.sampled_from(["#1@value", "#2@value", "#3@default"]), st.text(max_size=8))
GESTURES = st.sampled_from(["", "a", "b"])


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.tuples(WRITES, GESTURES), max_size=12), st.data())
def test_any_edits_and_undoing_them_all_leave_the_file_as_it_was(
    tmp_path: Path, rover: Path, writes: list[tuple[tuple[str, str], str]], data: st.DataObject
):
    rover.write_bytes(ROVER.encode())
    sources = opened(tmp_path, rover)
    for (place, text), gesture in writes:
        site = f"{rover}{place}"
        try:
            sources.edit_site(site, text, gesture)
        except EditError:  # a character that XML cannot hold
            continue
        assert decode(sources.text(str(rover)), sources.spans.span(site)) == text
        if data.draw(st.booleans()):
            sources.undo()
            sources.redo()
    edited = sources.text(str(rover))
    while sources.undo():
        pass
    assert sources.text(str(rover)) == ROVER.encode()
    assert (sources.unsaved_count, sources.unsaved_files) == (0, ())
    while sources.redo():
        pass
    assert sources.text(str(rover)) == edited


def in_step(sources: Sources, session: Session, edits: tuple[Edit, ...]) -> Expansion:
    """Send edits to the session that were applied here, and take over its run."""
    version = sources.spans.version
    answer = session.answer(EditRequest(edits))
    assert isinstance(answer, Expansion), answer
    sources.adopt(answer, version)
    return answer


@pytest.mark.corpus
def test_a_limit_and_a_length_of_a_real_arm_are_saved_and_only_their_bytes(
    corpus: Path, tmp_path: Path
):
    (arm,) = corpus.glob("Universal*")
    folder = tmp_path / "ur_description"
    shutil.copytree(arm, folder, ignore=shutil.ignore_patterns("meshes"))
    for path in (folder, *folder.rglob("*")):
        path.chmod(0o755 if path.is_dir() else 0o644)
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    policy = ReadPolicy((str(folder),), {"ur_description": (str(folder),)}, {})
    entry = str(folder / "urdf" / "ur.urdf.xacro")
    request = OpenRequest(entry, {"ur_type": "ur10e", "name": "ur"}, policy, {})
    session, roots = Session(request), ServedRoots([folder])
    sources = Sources(roots.read, roots.resolve, roots.may_write, request.arguments)
    opened = session.run()
    assert isinstance(opened, Expansion), opened
    sources.adopt(opened, 0)
    ids = {site.name: site.id for site in opened.changed_sites}
    for name, text in [
        ("joint_limits.elbow_joint.max_position", "170.0"),
        ("kinematics.forearm.x", "-0.75"),
    ]:
        in_step(sources, session, (sources.edit_site(ids[name], text, gesture=name),))
    assert len(sources.save()) == 2
    config = folder / "config" / "ur10e"
    after = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    changed = {path: data for path, data in after.items() if before[path] != data}
    assert set(changed) == {config / "joint_limits.yaml", config / "default_kinematics.yaml"}
    for path, data in changed.items():
        assert len(data.splitlines()) == len(before[path].splitlines())
        lines = zip(before[path].splitlines(), data.splitlines(), strict=True)
        ((old, new),) = ((old, new) for old, new in lines if old != new)
        assert new in {
            old.replace(b"180.0", b"170.0"),
            old.replace(b"-0.6127", b"-0.75"),
        }


@pytest.mark.corpus
def test_edits_of_real_robots_keep_every_span_and_undo_gives_every_site_back(corpus: Path):
    """In each robot some numbers are turned; session and sources stay in step all the way."""
    folders, turned = package_folders(corpus), 0
    for entry in sorted(corpus.rglob("*.urdf.xacro"))[::6]:
        policy = ReadPolicy((str(corpus),), folders, {})
        session = Session(OpenRequest(str(entry), {}, policy, {}))
        opened = session.run()
        if not isinstance(opened, Expansion):
            continue
        roots = ServedRoots([corpus])
        sources = Sources(roots.read, roots.resolve, roots.may_write)
        sources.adopt(opened, 0)
        numbers = [one for one in opened.changed_sites if parse_number(one.text) is not None]
        for before in numbers[:: max(1, len(numbers) // 5)]:
            text = f"{(parse_number(before.text) or 0) * 1.37 + 0.1:.9g}"
            in_step(sources, session, (sources.edit_site(before.id, text),))
            assert sources.spans.site(before.id).text == text
            assert sources.saved_text(before.id) == before.text
            for other in opened.changed_sites[:: max(1, len(opened.changed_sites) // 20)]:
                now = sources.spans.site(other.id)
                held = sources.text(now.place.file)
                assert decode(held, sources.spans.span(other.id)) == now.text, other.id
            undone = sources.undo()
            assert undone is not None
            in_step(sources, session, undone.edits)
            assert sources.spans.site(before.id) == before
            assert sources.unsaved_files == ()
            turned += 1
    assert turned > 30


def test_thousands_of_edits_move_the_sites_that_they_do_not_touch_in_a_moment(
    tmp_path: Path, rover: Path, limits: Path
):
    """Quick, as the time limit of each test is: every edit was weighed with every site."""
    sources = opened(tmp_path, rover, limits)
    site, file, before = radius(rover), str(rover), sources.spans.span(radius(rover))
    end = len(sources.text(file))
    sources.edit_all([Edit(file, end, end, b" ") for _ in range(3_000)], "Blanks behind")
    assert sources.spans.span(site) == before
    sources.edit_all([Edit(file, 0, 0, b" ") for _ in range(3_000)], "Blanks before")
    after = sources.spans.span(site)
    assert (after.start, after.end) == (before.start + 3_000, before.end + 3_000)
    assert sources.current_text(site) == "0.1"
