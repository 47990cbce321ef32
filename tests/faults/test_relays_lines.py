"""The line between a studio and its relay is cut: nothing is lost or done twice when it is back."""

from __future__ import annotations

import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from studio.classroom import control as control_module
from studio.server.relays.wire import LEASE_MS
from tests.support.classmates import Classmate
from tests.support.cut_lines import cut_line
from tests.support.relays import RelayedClass, relay_process, relayed_class, wait_until
from tests.support.watched_pages import Mover, measured, watched_page

if TYPE_CHECKING:
    from collections.abc import Generator

    from tests.support.cut_lines import CutLine
    from tests.support.relays import RelayProcess
    from tests.support.watched_pages import WatchedPage

pytestmark = pytest.mark.network
AWAY_S = LEASE_MS / 1000 + 5
"""A cut is noticed within this, on a busy machine."""
BACK_S = 8.0
"""So long after the line is whole, all goes on at the latest, on a busy machine: what was begun
while it was cut is given up before.
"""
OTHERS_ASK = 1_100
LESSON = "# Length\n\ncheck: property base_length is 0.61\n\nNow open it.\n\ncheck: opened origin\n"
CUTS = [
    pytest.param(7.0, False, id="a moment"),
    pytest.param(60.0, False, marks=pytest.mark.sweep, id="a minute"),
    pytest.param(60.0, True, marks=pytest.mark.sweep, id="a minute and a reset"),
]


@pytest.fixture(scope="module")
def relay(tmp_path_factory: pytest.TempPathFactory) -> Generator[RelayProcess]:
    with relay_process(tmp_path_factory.mktemp("relay")) as made:
        yield made


@pytest.fixture(scope="module")
def line(relay: RelayProcess) -> Generator[CutLine]:
    with cut_line(relay.listen_port) as made:
        yield made


@pytest.fixture(scope="module")
def room(
    line: CutLine, relay: RelayProcess, tmp_path_factory: pytest.TempPathFactory
) -> Generator[RelayedClass]:
    folder = tmp_path_factory.mktemp("class")
    with relayed_class(folder, [f"tls/127.0.0.1:{line.port}#{relay.key}"]) as made:
        yield made


@pytest.fixture(autouse=True)
def _who_has_control_keeps_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """However long they are away: a page that is gone for five seconds loses it otherwise."""
    monkeypatch.setattr(control_module, "ABSENCE_S", 300.0)


@contextmanager
def at_work(room: RelayedClass, name: str) -> Generator[tuple[Mover, WatchedPage]]:
    """The presenter, and a student at the relay who has a copy, and control of the rover."""
    with (
        room.served.presenter() as browser,
        watched_page(browser) as own,
        room.student(name) as student,
        watched_page(student) as page,
    ):
        mover = Mover(own, room.served.site("base_length"))
        mover.take_control()
        assert page.answer(page.ask("open_copy", document="rover"))["type"] == "done"
        for number in range(1, 7):
            mover.edit(f"0.4{number}")
        mover.give_control(page)
        yield mover, page


def copy_of(page: WatchedPage) -> str:
    return f"rover~{page.newest('you')['person']}"


def ask_all(page: WatchedPage) -> list[int]:
    """Ask for what may be done once only, half of it with ids; the numbers of it."""
    return [
        page.ask("undo", document="rover"),
        page.ask("undo", document="rover", id=f"undo {time.monotonic()}"),
        page.ask("raise_hand"),
        page.ask("hand_in", document=copy_of(page)),
    ]


def see_that_all_was_done_once(mover: Mover, page: WatchedPage, steps: int) -> None:
    """So many steps are left, and one copy was handed in, by one person with one hand."""
    person = page.newest("you")["person"]
    mover.take_control()
    assert mover.steps == steps
    assert mover.times_told("copies", "copies", person, "handed_s") == 1
    assert mover.times_told("class_state", "members", person, "hand_s") == 1


def see_that_who_joins_is_told(room: RelayedClass) -> None:
    """Whose form comes while the line is cut is told as soon as that is noticed."""
    newcomer = Classmate(room.address())
    try:
        began_s = time.monotonic()
        answer = newcomer.join("Dora", room.served.classroom.admission.code)
        assert time.monotonic() - began_s < AWAY_S
        assert answer.status_code < 500
        assert "The studio is away" in answer.text
        assert not newcomer.cookie
    finally:
        newcomer.close()


@pytest.mark.timeout(300)
@pytest.mark.parametrize(("cut_s", "resets"), CUTS)
def test_after_a_silent_cut_the_newest_is_shown_and_what_was_asked_is_done_once(
    room: RelayedClass, line: CutLine, cut_s: float, resets: bool
):
    with at_work(room, "Ada") as (mover, page):
        before = mover.steps
        line.cut()
        cut_at_s = time.monotonic()
        numbers = ask_all(page)
        see_that_who_joins_is_told(room)
        wait_until(lambda: page.sees_studio == "away", "the sentence that it is away", AWAY_S)
        away_s = time.monotonic() - cut_at_s
        last = page.text(mover.site)
        assert (last, mover.steps) == ("0.46", before)
        assert not any(map(page.answers, numbers))
        wait_until(lambda: time.monotonic() - cut_at_s > cut_s, "the end of the cut", 90)
        if cut_s > 10:
            late = page.answer(page.ask("undo", document="rover"))
            assert late["kind"] == "OriginAwayError"
        assert page.text(mover.site) == last
        line.go_on(resets=resets)
        whole_s = time.monotonic()
        wait_until(lambda: page.sees_studio == "there", "the studio", BACK_S)
        there_s = time.monotonic() - whole_s
        assert {page.answer(one)["type"] for one in numbers} == {"done"}
        done_s = time.monotonic() - whole_s
        measured(f"away after {away_s:.2f} s; {there_s:.2f} s after the cut it is there")
        measured(f"all was done {done_s:.2f} s after the cut")
        see_that_all_was_done_once(mover, page, before - 2)
        assert mover.shown_within(page, whole_s, "the newest") < BACK_S
        with room.student("Dora"):
            names = [one.name for one in room.served.classroom.members]
            assert names.count("Dora") == 1


def test_what_was_done_before_its_answer_was_lost_is_not_done_again_however_much_others_ask(
    room: RelayedClass, line: CutLine
):
    with at_work(room, "Bob") as (mover, page):
        before = mover.steps
        line.cut(back_flows=True)
        numbers = ask_all(page)
        wait_until(lambda: mover.steps == before - 2, "what was asked to be done")
        others = [
            mover.page.ask("set_joints", document="rover", positions={}, id=f"other {number}")
            for number in range(OTHERS_ASK)
        ]
        mover.page.answer(others[-1])
        assert not any(map(page.answers, numbers))
        line.go_on(resets=True)
        wait_until(lambda: page.sees_studio == "away", "the sentence that it is away", AWAY_S)
        whole_s = time.monotonic()
        wait_until(lambda: page.sees_studio == "there", "the studio", BACK_S)
        assert {page.answer(one)["type"] for one in numbers} == {"done"}
        measured(f"all was answered {time.monotonic() - whole_s:.2f} s after the reset")
        see_that_all_was_done_once(mover, page, before - 2)


def test_a_lesson_that_is_read_goes_on_after_a_reset_and_each_step_is_ticked_once(
    room: RelayedClass, line: CutLine
):
    with at_work(room, "Cleo") as (mover, page):
        mover.do("save_lesson", lesson="length", text=LESSON)
        for kind, fields in (
            ("open_lesson", {"document": "rover", "lesson": "length"}),
            ("saw_panel", {"panel": "origin"}),
        ):
            assert page.answer(page.ask(kind, **fields))["type"] == "done"
        wait_until(lambda: ticks(page).count(None) == 1, "the tick of the panel")
        (panel_s,) = set(ticks(page)) - {None}
        line.go_on(resets=True)
        wait_until(lambda: page.sees_studio == "away", "the sentence that it is away", AWAY_S)
        wait_until(lambda: page.sees_studio == "there", "the studio", BACK_S)
        mover.take_control()
        mover.edit("0.61")
        wait_until(lambda: None not in ticks(page), "the tick of the length")
        assert panel_s in ticks(page)
        told = {tuple(one["done_s"] for one in event["steps"]) for event in page.of("lesson_state")}
        assert all(len({one[at] for one in told} - {None}) == 1 for at in (0, 1))
        mover.do("delete_lesson", lesson="length")


def ticks(page: WatchedPage) -> list[float | None]:
    """When each step of the open lesson was done."""
    told = page.of("lesson_state")
    return [one["done_s"] for one in told[-1]["steps"]] if told else []
