"""Bookmarks: beside the bag where that is possible, and nothing of others is written over."""

from __future__ import annotations

import asyncio
import json
import os
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from pydantic import ValidationError

from studio.errors import CommandError
from studio.live.time.bookmarks import BookmarkFile, Bookmarks, Mark
from studio.protocol.listeners import Audience
from studio.protocol.playback import BOOKMARKS_MAX, Bookmark, SetBookmarks
from studio.protocol.roles import Role
from tests.support.open_documents import Ear

if TYPE_CHECKING:
    from collections.abc import Callable

ZERO_NS = 1_700_000_000_123_456_789
START, END = Mark(ZERO_NS, "start"), Mark(ZERO_NS + 5_000_000_001, "the end 😀")


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    made = tmp_path / "run"
    made.mkdir()
    return made


@pytest.fixture
def data(tmp_path: Path) -> Path:
    made = tmp_path / "data"
    made.mkdir()
    return made


def reopened(bag: Path, data: Path) -> tuple[list[Mark], str]:
    """What a studio that begins now reads."""
    marks, trouble = BookmarkFile(bag, data).read()
    return list(marks), trouble


# Files


def test_they_lie_in_the_folder_of_the_bag_in_the_order_of_time(bag: Path, data: Path):
    assert BookmarkFile(bag, data).write([END, START]) == ((START, END), "")
    assert json.loads((bag / "bookmarks.json").read_text())["bookmarks"][0] == {
        "at_ns": ZERO_NS,
        "name": "start",
    }
    assert reopened(bag, data) == ([START, END], "")
    assert list(data.iterdir()) == []


def test_those_of_a_single_file_have_its_name_and_without_any_there_is_no_file(
    tmp_path: Path, data: Path
):
    file = tmp_path / "a.mcap"
    file.touch()
    made = BookmarkFile(file, data)
    made.write([START])
    assert (tmp_path / "a.mcap.bookmarks.json").is_file()
    made.write([])
    assert not (tmp_path / "a.mcap.bookmarks.json").exists()
    assert reopened(file, data) == ([], "")


def make_loop(path: Path) -> None:
    path.symlink_to(path)


FOREIGN: list[Callable[[Path], object]] = [
    lambda path: path.write_text("[]"),
    lambda path: path.write_text('{"bookmarks": [{"at_ns": 1, "name": "x"}]}'),
    lambda path: path.write_text('{"studio_bookmarks": 1, "bookmarks": [{"at_ns": "x"}]}'),
    lambda path: path.write_bytes(b"\xff\xfe\x00"),
    lambda path: path.write_text("[" * 100_000),
    lambda path: path.write_text(" " * (2 << 20)),
    lambda path: path.symlink_to("/etc/passwd"),
    lambda path: path.symlink_to("nothing"),
    make_loop,
    lambda path: path.mkdir(),
    os.mkfifo,
]


@pytest.mark.parametrize("make", FOREIGN)
def test_a_file_of_others_stays_as_it_is_and_they_are_kept_elsewhere(
    bag: Path, data: Path, make: Callable[[Path], object]
):
    path = bag / "bookmarks.json"
    make(path)
    before = os.lstat(path)
    made = BookmarkFile(bag, data)
    marks, trouble = made.read()
    assert marks == ()
    assert "stays as it is" in trouble
    marks, trouble = made.write([START])
    assert marks == (START,)
    assert "in the studio's own folder" in trouble
    after = os.lstat(path)
    assert (after.st_ino, after.st_mtime_ns) == (before.st_ino, before.st_mtime_ns)
    assert reopened(bag, data)[0] == [START]


def test_where_nothing_can_be_written_they_are_kept_in_the_data_folder(bag: Path, data: Path):
    made = BookmarkFile(bag, data)
    bag.rmdir()  # as a disk that is taken away
    marks, trouble = made.write([START])
    assert marks == (START,)
    assert "No such file" in trouble
    assert "in the studio's own folder" in trouble
    bag.mkdir()
    assert reopened(bag, data) == ([START], "")
    BookmarkFile(bag, data).write([START, END])
    assert (bag / "bookmarks.json").is_file()
    assert list((data / "bookmarks").iterdir()) == []


def test_where_nothing_at_all_can_be_written_it_is_said_and_a_later_place_is_taken(
    bag: Path, tmp_path: Path
):
    gone = tmp_path / "gone" / "run"
    made = BookmarkFile(gone, tmp_path / "gone" / "data")
    marks, trouble = made.write([START])
    assert marks == (START,)
    assert "No such file" in trouble
    assert "while the bag is shown" in trouble
    gone.mkdir(parents=True)
    again = BookmarkFile(gone, tmp_path / "gone" / "data")
    assert again.write([START]) == ((START,), "")


def test_what_another_studio_wrote_meanwhile_is_not_lost(bag: Path, data: Path):
    one, other = BookmarkFile(bag, data), BookmarkFile(bag, data)
    one.write([START])
    assert other.read()[0] == (START,)
    other.write([START, END])
    third = Mark(ZERO_NS + 1, "third")
    assert one.write([START, third])[0] == (START, third, END)
    assert one.write([third])[0] == (third,)
    assert reopened(bag, data)[0] == [third]


def test_a_file_with_too_many_or_too_long_ones_is_cut(bag: Path, data: Path):
    rows = [{"at_ns": one, "name": "x" * 1_000} for one in (-(1 << 62), *range(900))]
    text = json.dumps({"studio_bookmarks": 1, "bookmarks": rows})
    (bag / "bookmarks.json").write_text(text)
    marks, trouble = BookmarkFile(bag, data).read()
    assert (len(marks), trouble) == (BOOKMARKS_MAX, "")
    assert {len(one.name) for one in marks} == {200}
    assert marks[0].at_ns == 0


# Of a document


class Shown:
    """What a document shows, as its time says it, and a page's ear at its bookmarks."""

    def __init__(self, path: Path | None, data: Path, *, writes: bool = True) -> None:
        self.path, self.zero_ns = str(path or ""), ZERO_NS
        audience, self.ear = Audience(), Ear()
        audience.add(self.ear)
        self.bookmarks = Bookmarks(
            self, audience, lambda one: BookmarkFile(Path(one), data), writes=writes
        )

    async def set(self, role: Role = Role.PRESENTER, **names: float) -> tuple[list[str], str]:
        """Keep these; the names that pages have then, and what is in the way."""
        wanted = tuple(Bookmark(at_s=at_s, name=name) for name, at_s in names.items())
        await self.bookmarks.set(SetBookmarks(bookmarks=wanted), Ear(role))
        return self.told()

    def told(self) -> tuple[list[str], str]:
        event = self.ear.last("bookmarks")
        return [one["name"] for one in event["bookmarks"]], event["trouble"]


def test_who_leads_writes_them_beside_the_bag_and_who_has_control_does_not(bag: Path, data: Path):
    async def story() -> None:
        shown = Shown(bag, data)
        assert await shown.set(later=5.000000001, first=0.0) == (["first", "later"], "")
        assert reopened(bag, data)[0] == [
            Mark(ZERO_NS, "first"),
            Mark(ZERO_NS + 5_000_000_001, "later"),
        ]
        names, trouble = await shown.set(Role.STUDENT, mine=1.0)
        assert names == ["mine"]
        assert "only who leads" in trouble
        assert len(reopened(bag, data)[0]) == 2
        assert await shown.set(mine=1.0) == (["mine"], "")
        assert len(reopened(bag, data)[0]) == 1

    asyncio.run(story())


def test_a_copy_begins_with_those_of_the_class_and_has_its_own_from_then_on(bag: Path, data: Path):
    async def story() -> None:
        BookmarkFile(bag, data).write([START])
        copy = Shown(bag, data, writes=False)
        await copy.bookmarks.turn()
        assert copy.told() == (["start"], "")
        assert await copy.set(mine=3.0) == (["mine"], "")
        assert reopened(bag, data)[0] == [START]

    asyncio.run(story())


def test_those_of_the_last_minutes_are_there_again_after_a_bag_and_forgotten_with_them(
    bag: Path, data: Path
):
    async def story() -> None:
        shown = Shown(None, data)
        assert await shown.set(Role.STUDENT, now=1.5) == (["now"], "")
        shown.path = str(bag)
        assert shown.bookmarks.are_others
        await shown.bookmarks.turn()
        assert shown.told() == ([], "")
        shown.path = ""
        await shown.bookmarks.turn()
        assert shown.told() == (["now"], "")
        shown.zero_ns += 1
        await shown.bookmarks.turn()
        assert shown.told() == ([], "")
        shown.zero_ns = 0
        with pytest.raises(CommandError, match="no time to mark"):
            await shown.set(now=1.0)
        assert list(data.iterdir()) == []

    asyncio.run(story())


@pytest.mark.parametrize("at_s", ["1e999", "NaN", "-2e9"])
def test_times_that_no_recording_has_are_refused(at_s: str):
    text = f'{{"type": "set_bookmarks", "bookmarks": [{{"at_s": {at_s}, "name": "x"}}]}}'
    with pytest.raises(ValidationError):
        SetBookmarks.model_validate_json(text)


def test_beside_a_file_whose_name_leaves_no_room_for_another_they_are_kept_elsewhere(data: Path):
    bag = data.parent / ("b" * 245 + ".mcap")
    bag.touch()
    file = BookmarkFile(bag, data)
    file.read()
    file.write([START])
    assert reopened(bag, data)[0] == [START]
