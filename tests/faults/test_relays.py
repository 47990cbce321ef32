"""Relays that die or stand still: their people go on at another, and others notice nothing."""

from __future__ import annotations

import time
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

import pytest

from tests.support.relays import RelayedClass, relay_process, relayed_class, wait_until
from tests.support.strangers import resident_bytes
from tests.support.watched_pages import Mover, gone_on_at_another, measured, watched_page

if TYPE_CHECKING:
    from collections.abc import Generator

    from tests.support.relays import RelayProcess
    from tests.support.watched_pages import WatchedPage

pytestmark = pytest.mark.network
MB = 1 << 20
RETURN_S = 20.0
"""A relay that was started anew has its room again within this, on a busy machine."""


@pytest.fixture(scope="module")
def relays(tmp_path_factory: pytest.TempPathFactory) -> Generator[list[RelayProcess]]:
    with ExitStack() as held:
        folders = [tmp_path_factory.mktemp(name) for name in ("first", "second")]
        yield [held.enter_context(relay_process(one)) for one in folders]


@pytest.fixture(scope="module")
def room(
    relays: list[RelayProcess], tmp_path_factory: pytest.TempPathFactory
) -> Generator[RelayedClass]:
    with relayed_class(tmp_path_factory.mktemp("class"), [one.line for one in relays]) as made:
        yield made


@contextmanager
def presenting(room: RelayedClass) -> Generator[Mover]:
    """The presenter's page, and what moves the rover there."""
    with room.served.presenter() as browser, watched_page(browser) as page:
        yield Mover(page, room.served.site("base_length"))


def endpoint(relay: RelayProcess) -> str:
    return relay.line.partition("#")[0]


@contextmanager
def killed(room: RelayedClass, relay: RelayProcess) -> Generator[None]:
    """A relay that is dead in this block, and serves its room again after it."""
    relay.kill()
    try:
        yield
    finally:
        relay.start()
        began_s = time.monotonic()
        uplink = room.uplink(endpoint(relay))
        wait_until(lambda: uplink.state == "there", "the relay that was started anew", RETURN_S)
        measured(f"a relay serves {time.monotonic() - began_s:.2f} s after its start")


def knows_another(page: WatchedPage) -> bool:
    return len(page.newest("relay_state")["others"]) == 1


def test_who_was_at_a_relay_that_dies_goes_on_at_another_as_the_same_person(
    room: RelayedClass, relays: list[RelayProcess]
):
    first, second = relays
    with (
        presenting(room) as mover,
        room.student("Ada", endpoint(first)) as ada,
        watched_page(ada) as page,
    ):
        wait_until(lambda: knows_another(page), "the address of the other relay")
        person = page.newest("you")["person"]
        with killed(room, first):
            assert page.ended.wait(5)
            arrived_s = time.monotonic()
            with gone_on_at_another(page) as there:
                assert there.browser.base.startswith(
                    urlsplit(room.address(endpoint(second))).path[:-1]
                )
                resumed_s = mover.shown_within(there, arrived_s, "the document at the other relay")
                measured(f"document, joints and 3D view {resumed_s:.2f} s after arriving")
                assert resumed_s < 10
                assert there.newest("you")["person"] == person
                assert there.newest("you")["name"] == "Ada"
                assert there.sees_studio == "there"
                assert there.newest("relay_state")["others"] == []
        names = [one.name for one in room.served.classroom.members]
        assert names.count("Ada") == 1


@pytest.mark.sweep
def test_within_two_seconds_of_arriving_at_another_relay_all_goes_on(
    room: RelayedClass, relays: list[RelayProcess]
):
    with (
        presenting(room) as mover,
        room.student("Bea", endpoint(relays[0])) as bea,
        watched_page(bea) as page,
    ):
        wait_until(lambda: knows_another(page), "the address of the other relay")
        with killed(room, relays[0]):
            arrived_s = time.monotonic()
            with gone_on_at_another(page) as there:
                assert mover.shown_within(there, arrived_s, "the document") < 2.0


def test_what_was_asked_of_a_relay_that_died_is_done_once_when_it_is_asked_of_another(
    room: RelayedClass, relays: list[RelayProcess]
):
    with (
        presenting(room) as mover,
        room.student("Cora", endpoint(relays[0])) as cora,
        watched_page(cora) as page,
    ):
        wait_until(lambda: knows_another(page), "the address of the other relay")
        person = page.newest("you")["person"]
        texts = [f"0.4{number}" for number in range(1, 7)]
        for text in texts:
            mover.edit(text)
        assert page.answer(page.ask("open_copy", document="rover"))["type"] == "done"
        mover.give_control(page)
        before = mover.steps
        asked = [
            *(("undo", {"document": "rover", "id": f"undo {number}"}) for number in range(4)),
            ("raise_hand", {"id": "hand"}),
            ("hand_in", {"document": f"rover~{person}", "id": "hand-in"}),
        ]
        numbers = [page.ask(kind, **fields) for kind, fields in asked]
        wait_until(lambda: page.answers(numbers[1]), "the answers of some")
        with killed(room, relays[0]), gone_on_at_another(page) as there:
            again = [there.ask(kind, **fields) for kind, fields in asked]
            assert {there.answer(one)["type"] for one in again} == {"done"}
            mover.take_control()
            assert mover.steps == before - 4
            assert there.text(mover.site) == texts[1]
            assert mover.times_told("copies", "copies", person, "handed_s") == 1
            assert mover.times_told("class_state", "members", person, "hand_s") == 1


@pytest.mark.parametrize(
    "stands_s", [pytest.param(3.0), pytest.param(10.0, marks=pytest.mark.sweep)]
)
def test_of_a_relay_that_stood_still_the_newest_is_shown_and_another_is_not_slowed(
    room: RelayedClass, relays: list[RelayProcess], stands_s: float
):
    first, second = relays
    with (
        presenting(room) as mover,
        room.student("Dan", endpoint(first)) as dan,
        room.student("Eva", endpoint(second)) as eva,
        watched_page(dan) as behind,
        watched_page(eva) as beside,
    ):
        for page in (behind, beside):
            mover.shown_within(page, time.monotonic(), "a move")
        usual_s = shown_at_once(mover, beside, 1.0)
        before = resident_bytes()
        first.pause()
        slowest_s = shown_at_once(mover, beside, stands_s)
        grown = resident_bytes() - before
        first.resume()
        resumed_s = time.monotonic()
        mover.move()
        wait_until(lambda: mover.is_shown(behind), "the newest", 15 + stands_s)
        measured(
            f"after {stands_s:.0f} s: shown {time.monotonic() - resumed_s:.2f} s later, origin "
            f"{grown / MB:.1f} MB larger; beside {slowest_s:.2f} s at most, {usual_s:.2f} s before"
        )
        assert grown < 60 * MB
        assert slowest_s < usual_s + 1.0
        mover.shown_within(behind, resumed_s, "the 3D view")


def shown_at_once(mover: Mover, page: WatchedPage, for_s: float) -> float:
    """Move again and again for so long; the longest until a move was shown."""
    slowest_s, end_s = 0.0, time.monotonic() + for_s
    while time.monotonic() < end_s:
        mover.move()
        moved_s = time.monotonic()
        wait_until(lambda: mover.is_shown(page), "a move beside")
        slowest_s = max(slowest_s, time.monotonic() - moved_s)
        time.sleep(0.01)
    return slowest_s
