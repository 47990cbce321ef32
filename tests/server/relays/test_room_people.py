"""A room at a relay: who may be there, what is theirs, and who has to go."""

from __future__ import annotations

import asyncio
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest
from websockets.exceptions import ConnectionClosed

from studio.errors import NotJoiningError
from studio.protocol.classroom import Gather, Stopped
from studio.protocol.message import type_of
from studio.scene import SUBPROTOCOL
from studio.server.relays.messages import AskJoin
from tests.support.classmates import Classmate
from tests.support.relays import (
    RelayedClass,
    ServedRelay,
    line_cut,
    relayed_class,
    served_relay,
    wait_until,
)
from tests.support.watched_pages import watched_page

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from websockets.sync.connection import Connection

    from tests.support.classmates import Lane

SHOWN = {"documents", "document", "sites", "robot"}
"""What only those are sent who may see the robot."""


@pytest.fixture(scope="module")
def relay() -> Generator[ServedRelay]:
    with served_relay() as made:
        yield made


@pytest.fixture(scope="module")
def shared(relay: ServedRelay, tmp_path_factory: pytest.TempPathFactory) -> Generator[RelayedClass]:
    with relayed_class(tmp_path_factory.mktemp("class"), [relay.line]) as made:
        yield made


@pytest.fixture(scope="module")
def presenter(shared: RelayedClass) -> Generator[Lane]:
    with shared.served.presenting() as lane:
        yield lane


@pytest.fixture
def room(shared: RelayedClass, presenter: Lane) -> RelayedClass:
    """The class, which others may join, and nobody is left in it of tests before."""
    assert presenter.ask("end_class")["type"] == "done"
    assert presenter.ask("start_class")["type"] == "done"
    return shared


@contextmanager
def at_work(room: RelayedClass, name: str) -> Generator[Lane]:
    """The page at the relay of somebody who joins there; it shows the rover."""
    with room.student(name) as student, student.lane() as lane:
        assert lane.ask("watch", document="rover")["type"] == "done"
        yield lane


def person_of(lane: Lane) -> str:
    return str(lane.newest("you")["person"])


def edited(room: RelayedClass, presenter: Lane, text: str) -> None:
    """The presenter changes the rover."""
    site = room.served.site("base_length")
    answer = presenter.ask("edit_site", document="rover", site=site, text=text)
    assert answer["type"] == "done"


def until_text(lane: Lane, text: str) -> None:
    """A page is sent an edit."""
    while all(one["text"] != text for one in lane.until("sites")["changed"]):
        pass


def kinds_until_ended(lane: Lane) -> set[str]:
    """What a page was still sent until its connection was ended."""
    before = len(lane.events)
    with pytest.raises(ConnectionClosed):
        lane.until("nothing that is sent")
    return {str(event["type"]) for event in lane.events[before:]}


def read_all(connection: Connection) -> None:
    for _ in connection:
        pass


def test_who_is_sent_out_while_the_line_is_cut_goes_when_it_is_back_and_others_go_on(
    room: RelayedClass, relay: ServedRelay, presenter: Lane
):
    site = room.served.site("base_length")
    with (
        room.student("Ada") as ada,
        ada.lane() as out,
        ada.websocket("/d/rover/viser", SUBPROTOCOL) as view,
        room.student("Ben") as ben,
        watched_page(ben) as page,
    ):
        assert out.ask("watch", document="rover")["type"] == "done"
        assert view.recv(timeout=60)
        wait_until(lambda: page.text(site) and page.frames_s, "the robot")
        with line_cut(relay, room):
            room.served.run(room.served.classroom.remove(person_of(out)))
            edited(room, presenter, "0.7")
        wait_until(lambda: page.text(site) == "0.7", "the edit")
        assert not kinds_until_ended(out) & SHOWN
        with pytest.raises(ConnectionClosed):
            read_all(view)
        now_s = time.monotonic()
        edited(room, presenter, "0.71")
        wait_until(lambda: page.text(site) == "0.71", "the next edit")
        wait_until(lambda: page.frame_after(now_s), "frames of the 3D view")
        assert ada.client.get("/").status_code != 200


@pytest.mark.parametrize("ending", ["end_class", "pause_class"])
def test_a_class_that_ended_while_the_line_was_cut_is_another_once_it_is_started_again(
    ending: str, room: RelayedClass, relay: ServedRelay, presenter: Lane
):
    with at_work(room, "Ada") as before:
        with line_cut(relay, room):
            assert presenter.ask(ending)["type"] == "done"
            edited(room, presenter, "0.7")
        assert not kinds_until_ended(before) & SHOWN
    assert presenter.ask("start_class")["type"] == "done"
    with at_work(room, "Bob") as lane:
        edited(room, presenter, "0.72")
        until_text(lane, "0.72")


def test_a_class_that_ended_and_began_while_the_line_was_cut_has_nobody_of_before(
    room: RelayedClass, relay: ServedRelay, presenter: Lane
):
    with at_work(room, "Ada") as before:
        with line_cut(relay, room):
            assert presenter.ask("end_class")["type"] == "done"
            assert presenter.ask("start_class")["type"] == "done"
            edited(room, presenter, "0.7")
        assert not kinds_until_ended(before) & SHOWN


def test_to_log_everybody_out_ends_all_pages_at_once(
    room: RelayedClass, relay: ServedRelay, presenter: Lane
):
    with room.student("Ada") as ada, ada.lane() as lane, at_work(room, "Ben") as other:
        assert lane.ask("watch", document="rover")["type"] == "done"
        room.served.run(room.served.classroom.log_out())
        for one in (lane, other):
            assert not kinds_until_ended(one) & SHOWN
        edited(room, presenter, "0.73")
        assert ada.client.get("/").status_code != 200


@pytest.mark.parametrize("ending", ["end_class", "pause_class"])
def test_who_only_looks_at_a_full_class_has_to_go_when_it_ends(
    ending: str, room: RelayedClass, presenter: Lane, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("studio.classroom.classroom.MEMBERS_MAX", 0)
    with at_work(room, "Eve") as lane:
        assert person_of(lane).startswith("viewer-")
        assert lane.newest("you")["role"] == "guest"
        assert presenter.ask(ending)["type"] == "done"
        assert not kinds_until_ended(lane) & SHOWN


def test_who_joins_later_is_not_told_what_happened_before(room: RelayedClass, presenter: Lane):
    with at_work(room, "Ada") as early:
        presenter.ask("gather_all")
        presenter.ask("stop_robot")
        early.until(type_of(Stopped))
        assert early.newest(type_of(Gather))
        with at_work(room, "Ben") as late:
            assert late.ask("raise_hand", raised=True)["type"] == "done"
            kinds = {event["type"] for event in late.events}
            assert {"leading", "control"} <= kinds
            assert not kinds & {type_of(Gather), type_of(Stopped)}


def test_a_guest_learns_of_being_a_student_and_can_be_given_control(
    room: RelayedClass, presenter: Lane
):
    assert presenter.ask("set_class", join_as="guest")["type"] == "done"
    with at_work(room, "Gus") as lane:
        person = person_of(lane)
        assert lane.newest("you")["role"] == "guest"
        # What they say goes over the line after their arrival.
        assert lane.ask("raise_hand", raised=True)["type"] == "refused"
        assert presenter.ask("set_member_role", person=person, role="student")["type"] == "done"
        assert lane.until("you", role="student")["person"] == person
        given = presenter.ask("give_control", person=person, document="rover")
        assert given["type"] == "done"
        lane.until("you", has_control=True)
        edit = {"document": "rover", "site": room.served.site("base_width"), "text": "0.46"}
        assert lane.ask("edit_site", **edit)["type"] == "done"


def test_who_has_the_link_joins_though_others_have_spent_all_guesses(room: RelayedClass):
    async def guess() -> str:
        for number in range(10_000):
            try:
                await room.origin.join("a relay", AskJoin(number, "Eve", "WRONGX", "", ""))
            except NotJoiningError as error:
                if error.why == "tries":
                    return "spent"
        return "never spent"

    assert room.served.run(guess()) == "spent"
    link = room.served.classroom.admission.link
    form = AskJoin(1, "Ada", link, "", "")
    assert room.served.run(room.origin.join("a relay", form))
    browser = Classmate(room.address())
    try:
        assert browser.join("Ben", link).status_code == 303
    finally:
        browser.close()


def test_a_relay_that_is_dialled_twice_at_once_has_one_line(
    room: RelayedClass, relay: ServedRelay, presenter: Lane
):
    async def dial_twice() -> None:
        await asyncio.gather(*(room.origin.dial(relay.line) for _ in range(2)))

    room.served.run(dial_twice())
    (uplink,) = room.origin.uplinks.values()
    wait_until(lambda: uplink.state == "there", "the line")
    wait_until(lambda: relay.room().is_there, "the studio")
    with at_work(room, "Ada") as lane:
        edited(room, presenter, "0.74")
        until_text(lane, "0.74")
    assert uplink.state == "there"
    assert len(relay.relay.rooms) == 1


def test_a_line_that_the_relay_has_ended_is_dialled_again(
    room: RelayedClass, relay: ServedRelay, presenter: Lane
):
    with at_work(room, "Ada") as lane:
        relay.look(relay.room().hang_up)
        wait_until(lambda: relay.room().is_there, "the studio")
        edited(room, presenter, "0.75")
        until_text(lane, "0.75")


def test_who_has_control_keeps_it_while_their_page_moves_to_another_relay_and_not_for_ever(
    room: RelayedClass, presenter: Lane, monkeypatch: pytest.MonkeyPatch
):
    # A page that is gone loses control at once, had it nowhere else to go to.
    monkeypatch.setattr("studio.classroom.control.ABSENCE_S", 0.0)
    classroom = room.served.classroom
    first = room.uplink().relay.endpoint
    with served_relay() as other:
        room.dial(other.line)
        there = next(one for one in room.origin.uplinks if one != first)
        with room.student("Ada", first) as ada:
            with ada.lane() as lane:
                person = str(lane.until("you")["person"])
                assert lane.ask("raise_hand", raised=True)["type"] == "done"
                given = presenter.ask("give_control", person=person, document="rover")
                assert given["type"] == "done"
                wait_until(lambda: others_of(lane), "the address of the other relay")
                (address,) = others_of(lane)
            wait_until(lambda: not classroom.is_here(person), "her leaving")
            moved = Classmate(room.address(there))
            try:
                moved.client.get(address)
                with moved.lane() as lane:
                    lane.until("you", person=person, has_control=True)
                    wait_until(lambda: classroom.is_here(person), "her return")
                    assert classroom.control.holder == person
                    monkeypatch.setattr("studio.classroom.control.MOVING_S", 0.0)
            finally:
                moved.close()
        wait_until(lambda: not classroom.control.holder, "the end of her control")
        room.served.run(room.origin.remove(there))


def others_of(lane: Lane) -> list[str]:
    """The addresses at other relays that a page was told last."""
    lane.ask("raise_hand", raised=True)
    return list(lane.newest("relay_state")["others"])


def test_a_studio_that_dials_two_addresses_of_one_relay_is_told_and_stays_by_the_first(
    tmp_path: Path,
):
    with served_relay() as relay, relayed_class(tmp_path, [relay.line]) as room:
        other = relay.line.replace("127.0.0.1", "localhost")
        dialled = room.served.run(room.origin.dial(other))
        second = room.uplink(dialled.endpoint)
        wait_until(lambda: second.state == "refused", "the refusal")
        assert "already" in second.reason
        assert room.uplink(relay.line.partition("#")[0]).state == "there"


def test_relays_are_kept_and_forgotten_beside_a_line_that_cannot_be_read(tmp_path: Path):
    with served_relay() as relay, relayed_class(tmp_path, []) as room:
        kept = room.served.classroom.relay_lines
        kept += ["tls/192.0.2.1:7448#damaged", relay.line.partition("#")[0] + "#old"]
        told: list[str] = []
        room.served.run(room.origin.begin([f" {relay.line} "], told.append))
        assert kept == ["tls/192.0.2.1:7448#damaged", relay.line]
        assert len(told) == 1
        assert "damaged" not in told[0]
        endpoint = relay.line.partition("#")[0]
        room.served.run(room.origin.remove(endpoint))
        assert kept == ["tls/192.0.2.1:7448#damaged"]
        room.served.run(room.origin.add(relay.line))
        assert kept == ["tls/192.0.2.1:7448#damaged", relay.line]
