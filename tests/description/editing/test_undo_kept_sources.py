"""Edits that outlast the process: put back as they were, and no steps that do not fit."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from hypothesis import given
from hypothesis import strategies as st

from studio.description.editing.sources import Sources
from studio.description.editing.undo import KeptSources
from studio.description.values import Edit

if TYPE_CHECKING:
    from pathlib import Path

FILE = "/p/a.xacro"
DISK = b"0123456789"


def sources_of(disk: bytes = DISK) -> Sources:
    def read(_: Path) -> bytes:
        return disk

    return Sources(read, lambda path: path, arguments={"side": "left"})


CUTS = st.tuples(st.integers(0, 9), st.integers(0, 3), st.binary(max_size=4))


def edited(cuts: list[tuple[int, int, bytes]]) -> tuple[Sources, list[bytes]]:
    """Sources after these edits, and the text after each of them."""
    sources, texts = sources_of(), [DISK]
    for start, length, new in cuts:
        text = sources.text(FILE)
        at = min(start, len(text))
        sources.edit(Edit(FILE, at, min(at + length, len(text)), new), "cut")
        if sources.text(FILE) != texts[-1]:
            texts.append(sources.text(FILE))
    return sources, texts


@given(st.lists(CUTS, max_size=12), st.lists(st.integers(0, 12), max_size=6))
def test_any_step_and_back_again_is_the_same_to_the_byte(
    cuts: list[tuple[int, int, bytes]], visits: list[int]
):
    sources, texts = edited(cuts)
    assert len(sources.undo_labels) == len(texts) - 1
    for visit in visits:
        count = min(visit, len(texts) - 1)
        sources.undo_to(count)
        assert sources.text(FILE) == texts[count]
    sources.undo_to(len(texts) - 1)
    assert sources.text(FILE) == texts[-1]


@given(st.lists(CUTS, max_size=8), st.integers(0, 8))
def test_what_is_kept_is_put_back_with_its_steps_in_both_directions(
    cuts: list[tuple[int, int, bytes]], count: int
):
    before, texts = edited(cuts)
    before.undo_to(min(count, len(texts) - 1))
    after = sources_of()
    after.put(before.kept().sound())
    assert after.text(FILE) == before.text(FILE)
    assert (after.undo_labels, after.redo_labels) == (before.undo_labels, before.redo_labels)
    after.undo_to(len(texts) - 1)
    assert after.text(FILE) == texts[-1]
    after.undo_to(0)
    assert after.text(FILE) == DISK
    assert after.unsaved_files == ()


def test_a_change_on_disk_since_is_merged_and_can_be_undone():
    before = sources_of(b"a = 1\nb = 2\n")
    before.edit(Edit(FILE, 4, 5, b"9"), "a")
    after = sources_of(b"a = 1\nb = 5\n")
    after.put(before.kept())
    after.refresh(FILE)
    assert after.text(FILE) == b"a = 9\nb = 5\n"
    after.undo_to(0)
    assert after.text(FILE) == b"a = 1\nb = 2\n"


def test_steps_that_do_not_fit_the_texts_are_left_out():
    sources, _ = edited([(0, 1, b"x"), (3, 1, b"y")])
    kept = sources.kept()
    (text,) = kept.texts
    wrong = replace(kept, texts=(replace(text, now=b"something else"),))
    assert wrong.sound() == KeptSources(wrong.texts, {"side": "left"})
    assert kept.sound() == kept


def test_a_step_given_up_leaves_what_could_be_redone():
    sources, _ = edited([(0, 1, b"x"), (3, 1, b"y")])
    sources.undo()
    before = sources.kept()
    sources.set_argument("side", "right")
    assert sources.redo_labels == ()
    change = sources.give_up(before)
    assert change is not None
    assert change.arguments == {"side": "left"}
    assert sources.redo_labels == ("cut 3 → y",)


def test_a_step_behind_which_others_came_is_not_given_up():
    sources, _ = edited([(0, 1, b"x")])
    before = sources.kept()
    sources.set_argument("side", "right")
    sources.edit(Edit(FILE, 5, 6, b"z"), "cut")
    assert sources.give_up(before) is None
    assert sources.arguments == {"side": "right"}
