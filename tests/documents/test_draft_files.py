"""Drafts as files: whole, one for each open document, and never a broken one taken for whole."""

from __future__ import annotations

import errno
import os
from contextlib import ExitStack, closing
from typing import TYPE_CHECKING, TypeAlias

import pytest

from studio.description.editing.undo import ArgumentChange, KeptSources, KeptText, Splice, Step
from studio.documents.draft_files import Draft, draft_file, forget_drafts, left_drafts
from studio.errors import DraftError
from tests.support.permissions import open_folder, unprivileged

if TYPE_CHECKING:
    from collections.abc import Callable, Generator
    from pathlib import Path

    from studio.documents.draft_files import DraftFile

Taken: TypeAlias = "Callable[[Path, Path], DraftFile]"
STEP = Step("reach", (Splice("/p/a", 0, b"\xff1", b"2"),), (ArgumentChange("x", None, "é"),))
KEPT = KeptSources((KeptText("/p/a", b"\xff1", b"2"),), {"x": "é"}, (STEP,))


@pytest.fixture
def taken() -> Generator[Taken]:
    """Takes places for drafts, which are left with the test."""
    with ExitStack() as places:

        def take(folder: Path, entry: Path) -> DraftFile:
            return places.enter_context(closing(draft_file(folder, entry)))

        yield take


def draft_of(entry: Path, kept: KeptSources = KEPT) -> Draft:
    return Draft(str(entry), "2026-01-02T03:04:05+00:00", {"name": "ur"}, kept)


def test_a_draft_is_read_as_it_was_written(tmp_path: Path, taken: Taken):
    place = taken(tmp_path, tmp_path / "a.xacro")
    assert place.read() is None
    place.write(draft_of(tmp_path / "a.xacro"))
    place.close()
    assert taken(tmp_path, tmp_path / "a.xacro").read() == draft_of(tmp_path / "a.xacro")


def test_two_documents_of_one_file_keep_drafts_of_their_own(tmp_path: Path, taken: Taken):
    entry = tmp_path / "a.xacro"
    first, second = taken(tmp_path, entry), taken(tmp_path, entry)
    first.write(draft_of(entry))
    assert second.read() is None
    second.write(draft_of(entry, KeptSources((), {})))
    assert first.read() == draft_of(entry)
    first.close()
    assert taken(tmp_path, entry).read() == draft_of(entry)


def test_a_draft_that_was_removed_is_none(tmp_path: Path, taken: Taken):
    place = taken(tmp_path, tmp_path / "a.xacro")
    place.write(draft_of(tmp_path / "a.xacro"))
    place.remove()
    assert place.read() is None


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"{",
        b"[]",
        b"\xff\xfe",
        b'{"version": 9}',
        b'{"entry": "/a", "at": "", "opened_with": {}, "kept": {"texts": 1, "arguments": {}}}',
        b'{"entry": "", "at": "", "opened_with": {}, "kept": {"texts": [], "arguments": {}},'
        b' "version": 2}',
        b'{"entry": "/a", "at": "", "opened_with": {}, "kept": {"arguments": {}, "texts":'
        b' [{"file": "/a", "disk": "no base64!", "now": ""}]}}',
        b'{"x": ' + b"[" * 100_000,
    ],
)
def test_what_is_no_draft_is_put_aside_with_a_sentence(data: bytes, tmp_path: Path, taken: Taken):
    entry = tmp_path / "a.xacro"
    place = taken(tmp_path, entry)
    place.write(draft_of(entry))
    (file,) = (tmp_path / "drafts").glob("*.json")
    file.write_bytes(data)
    with pytest.raises(DraftError, match="broken/"):
        place.read()
    assert (tmp_path / "drafts" / "broken" / file.name).read_bytes() == data
    assert place.read() is None


def test_steps_that_do_not_fit_are_left_out_and_the_texts_stay(tmp_path: Path, taken: Taken):
    entry = tmp_path / "a.xacro"
    place = taken(tmp_path, entry)
    texts = (KeptText("/p/a", b"1", b"other"),)
    place.write(draft_of(entry, KeptSources(texts, {}, (STEP,))))
    draft = place.read()
    assert draft is not None
    assert draft.kept == KeptSources(texts, {})


def test_a_full_disk_leaves_the_draft_before_and_no_other_file(
    tmp_path: Path, taken: Taken, monkeypatch: pytest.MonkeyPatch
):
    entry = tmp_path / "a.xacro"
    place = taken(tmp_path, entry)
    place.write(draft_of(entry))

    def full(_handle: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(DraftError, match="No space left on device; save what matters"):
        place.write(draft_of(entry, KeptSources((), {})))
    assert place.read() == draft_of(entry)
    assert {one.suffix for one in (tmp_path / "drafts").iterdir()} == {".json", ".lock"}


def test_a_folder_that_cannot_be_written_is_said():
    with (
        open_folder() as folder,
        unprivileged(),
        pytest.raises(DraftError, match="Permission denied"),
    ):
        draft_file(folder, folder / "a.xacro")


def test_a_file_in_the_way_of_the_folder_is_said(tmp_path: Path):
    (tmp_path / "drafts").write_text("")
    with pytest.raises(DraftError, match="save what matters"):
        draft_file(tmp_path, tmp_path / "a.xacro")


def test_drafts_are_forgotten_but_for_those_of_open_documents(tmp_path: Path, taken: Taken):
    held, left = tmp_path / "held.xacro", tmp_path / "left.xacro"
    kept, given_up = taken(tmp_path, held), taken(tmp_path, left)
    kept.write(draft_of(held))
    given_up.write(draft_of(left))
    given_up.close()
    forget_drafts(tmp_path, [held, left])
    assert kept.read() == draft_of(held)
    assert taken(tmp_path, left).read() is None


def test_a_name_that_no_draft_can_hold_is_said(tmp_path: Path, taken: Taken):
    entry = tmp_path / "a.xacro"
    place = taken(tmp_path, entry)
    odd = KeptSources((KeptText(os.fsdecode(b"/p/\xff"), b"1", b"2"),), {})
    with pytest.raises(DraftError, match="a name that is no text"):
        place.write(draft_of(entry, odd))
    assert place.read() is None


def test_a_look_at_what_was_left_passes_over_broken_drafts(tmp_path: Path):
    entry = tmp_path / "a.xacro"
    with closing(draft_file(tmp_path, entry)) as place:
        place.write(draft_of(entry))
    (tmp_path / "drafts/deep-1.json").write_bytes(b'{"x": ' + b"[" * 100_000)
    (tmp_path / "drafts/text-1.json").write_bytes(b"no draft")
    assert left_drafts(tmp_path) == [draft_of(entry)]
