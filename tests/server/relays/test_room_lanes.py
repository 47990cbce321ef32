"""A room at a relay: what its pages are shown of documents, copies and the presenter's view."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from studio.protocol.documents import Gone
from studio.protocol.message import type_of
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

    from tests.support.classmates import Lane

GONE = type_of(Gone)


@pytest.fixture(scope="module")
def relay() -> Generator[ServedRelay]:
    with served_relay() as made:
        yield made


@pytest.fixture(scope="module")
def room(relay: ServedRelay, tmp_path_factory: pytest.TempPathFactory) -> Generator[RelayedClass]:
    with relayed_class(tmp_path_factory.mktemp("class"), [relay.line]) as made:
        yield made


@pytest.fixture
def presenter(room: RelayedClass) -> Generator[Lane]:
    with room.served.presenting() as lane:
        yield lane


@contextmanager
def at_work(room: RelayedClass, name: str) -> Generator[Lane]:
    """The page at the relay of somebody who joins there; it shows the rover."""
    with room.student(name) as student, student.lane() as lane:
        done(lane, "watch", document="rover")
        yield lane


def done(lane: Lane, kind: str, **fields: Any) -> list[dict[str, Any]]:  # noqa: ANN401
    """What came while a command was carried out."""
    before = len(lane.events)
    assert lane.ask(kind, **fields)["type"] == "done"
    return lane.events[before:]


def kinds(events: list[dict[str, Any]]) -> list[str]:
    return [str(one["type"]) for one in events]


def came_over(lane: Lane) -> list[dict[str, Any]]:
    """What came to a page before the studio answered it."""
    return done(lane, "raise_hand", raised=True)


def until_text(lane: Lane, text: str) -> None:
    """Wait until a page has been sent an edit."""

    def came() -> bool:
        told = [event["changed"] for event in lane.events if event["type"] == "sites"]
        return any(one["text"] == text for changed in told for one in changed)

    while not came():
        lane.until("sites")


def edited(lane: Lane, document: str, site: str, text: str) -> None:
    done(lane, "edit_site", document=document, site=site, text=text)


def site_of_copy(room: RelayedClass, copy: str) -> str:
    """The id of a site of a student's copy, once it is open."""
    document = room.served.engine.document(copy)
    room.served.run(document.opened())
    found = room.served.look(document.sites.event).changed
    return next(one.id for one in found if one.name.endswith("base_length"))


@contextmanager
def own_copy(room: RelayedClass, lane: Lane) -> Generator[tuple[str, str]]:
    """A student's copy of the rover, which their page shows; with one of its sites."""
    done(lane, "open_copy", document="rover")
    copy = f"rover~{lane.newest('you')['person']}"
    done(lane, "watch", document=copy)
    yield copy, site_of_copy(room, copy)


def shows(presenter: Lane, copy: str, *, shown: bool) -> None:
    done(presenter, "show_copy", document=copy, shown=shown)


def test_a_document_that_is_closed_and_opened_again_is_the_new_one(
    room: RelayedClass, presenter: Lane
):
    entry = str(room.served.rover.entry)
    with room.student("Ada") as ada, ada.lane() as lane:
        done(lane, "watch", document="rover")
        done(presenter, "close_document", document="rover", discard=True)
        assert lane.until(GONE)["document"] == "rover"
        done(presenter, "open_path", path=entry)
        wait_until(
            lambda: any(
                one["id"] == "rover" for one in ada.client.get("/api/documents").json()["documents"]
            ),
            "the list with it",
        )
        with ada.lane() as again:
            done(again, "watch", document="rover")
            room.served.run(room.served.rover.opened())
            site = room.served.site("base_length")
            edited(presenter, "rover", site, "0.77")
            until_text(again, "0.77")
            assert GONE not in kinds(again.events)


def test_a_copy_that_is_no_longer_shown_is_its_owners_alone_whoever_opened_it_first(
    room: RelayedClass, presenter: Lane
):
    with (
        at_work(room, "Anna") as anna,
        at_work(room, "Ben") as ben,
        own_copy(room, anna) as (copy, site),
    ):
        assert ben.ask("watch", document=copy)["kind"] == "UnknownDocumentError"
        shows(presenter, copy, shown=True)
        wait_until(lambda: ben.ask("watch", document=copy)["type"] == "done", "the copy")
        edited(anna, copy, site, "0.62")
        until_text(ben, "0.62")
        shows(presenter, copy, shown=False)
        assert ben.until(GONE)["document"] == copy
        edited(anna, copy, site, "0.63")
        until_text(anna, "0.63")
        assert "sites" not in kinds(came_over(ben))
        assert ben.ask("watch", document=copy)["type"] == "refused"
        assert GONE not in kinds(anna.events)


@pytest.mark.parametrize("is_cut", [False, True], ids=["", "after a cut"])
def test_who_owns_a_shown_copy_that_others_opened_first_goes_on_when_it_is_no_longer_shown(
    is_cut: bool, room: RelayedClass, relay: ServedRelay, presenter: Lane
):
    with at_work(room, "Anna") as anna, at_work(room, "Ben") as ben:
        done(anna, "open_copy", document="rover")
        copy = f"rover~{anna.newest('you')['person']}"
        shows(presenter, copy, shown=True)
        wait_until(lambda: ben.ask("watch", document=copy)["type"] == "done", "the copy")
        done(anna, "watch", document=copy)
        site = site_of_copy(room, copy)
        if is_cut:
            with line_cut(relay, room):
                pass
        edited(anna, copy, site, "0.64")
        for one in (anna, ben):
            until_text(one, "0.64")
        shows(presenter, copy, shown=False)
        assert ben.until(GONE)["document"] == copy
        edited(anna, copy, site, "0.66")
        until_text(anna, "0.66")
        assert "sites" not in kinds(came_over(ben))
        assert GONE not in kinds(anna.events)


def test_who_follows_is_taken_to_a_shown_copy_before_and_after_a_cut(
    room: RelayedClass, relay: ServedRelay, presenter: Lane
):
    with at_work(room, "Anna") as anna, at_work(room, "Ben") as ben:
        done(presenter, "lead", leading=True)
        with own_copy(room, anna) as (copy, _):
            shows(presenter, copy, shown=True)
            done(ben, "follow", following=True)
            done(presenter, "show_focus", document=copy, panel="first")
            ben.until("focus", document=copy, panel="first")
            with line_cut(relay, room):
                pass
            done(presenter, "show_focus", document=copy, panel="second")
            ben.until("focus", document=copy, panel="second")
            shows(presenter, copy, shown=False)
            done(presenter, "show_focus", document=copy, panel="third")
            assert "focus" not in kinds(came_over(ben))


@pytest.mark.parametrize("is_cut", [False, True], ids=["", "after a cut"])
def test_who_follows_once_the_presenter_leads_no_more_is_not_taken_to_where_they_were(
    is_cut: bool, room: RelayedClass, relay: ServedRelay, presenter: Lane
):
    with at_work(room, "Ada") as early, at_work(room, "Ben") as late:
        done(presenter, "lead", leading=True)
        done(early, "follow", following=True)
        done(presenter, "show_focus", document="rover", panel="seen")
        early.until("focus", panel="seen")
        if is_cut:
            with line_cut(relay, room):
                pass
            early.until("focus", panel="seen")
        done(presenter, "lead", leading=False)
        late.until("leading", leading=False)
        done(late, "follow", following=True)
        came_over(late)
        assert "focus" not in kinds(late.events)


def test_the_list_of_documents_is_the_newest_and_before_the_first_a_sentence_says_so(
    room: RelayedClass, relay: ServedRelay, presenter: Lane
):
    entry = str(room.served.rover.entry)
    with room.student("Ada") as ada:

        def listed() -> list[str]:
            found = ada.client.get("/api/documents").json()["documents"]
            return [str(one["id"]) for one in found]

        wait_until(lambda: listed() == ["rover"], "the rover")
        done(presenter, "close_document", document="rover", discard=True)
        wait_until(lambda: listed() == [], "its end")
        done(presenter, "open_path", path=entry)
        wait_until(lambda: listed() == ["rover"], "its return")
        lanes = relay.room().lanes
        relay.look(lambda: lanes.studio.take_snapshot(()))
        answer = ada.client.get("/api/documents")
        assert 400 <= answer.status_code < 500
        assert "has not said what is open" in answer.text
        relay.look(lanes.renew)
        wait_until(lambda: ada.client.get("/api/documents").status_code == 200, "the list")
        assert listed() == ["rover"]


def test_a_large_part_of_a_later_frame_of_a_3d_view_crosses_the_line_once(
    room: RelayedClass, relay: ServedRelay
):
    scene = room.served.rover.scene
    random = np.random.default_rng(1)
    bytes_of_points = 50_000 * 3 * 4

    def grow() -> None:
        """Draw points that were never sent before."""
        points = random.random((50_000, 3), dtype=np.float32)
        first = np.array([[0, 1, 2]], dtype=np.uint32)
        scene.viser.scene.add_mesh_simple("/large", points, first)
        scene.flush()

    with at_work(room, "Ben") as lane, room.student("Ada") as ada, watched_page(ada) as page:
        wait_until(lambda: page.frames_s, "the robot")
        for _ in range(2):
            frame_count, before = len(page.frames_s), relay.room().received_bytes
            room.served.look(grow)
            wait_until(lambda count=frame_count: len(page.frames_s) > count, "the frame")
            came_over(lane)  # what came after it has come as well
            came_bytes = relay.look(lambda: relay.room().received_bytes) - before
            assert bytes_of_points <= came_bytes < 1.5 * bytes_of_points
