"""A class that is shared by a relay: what its people see and do there."""

from __future__ import annotations

from http import HTTPStatus
from typing import TYPE_CHECKING

import pytest

from tests.support.classmates import Classmate
from tests.support.relays import RelayedClass, ServedRelay, relayed_class, served_relay, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator


@pytest.fixture(scope="module")
def relay() -> Generator[ServedRelay]:
    with served_relay() as made:
        yield made


@pytest.fixture(scope="module")
def room(relay: ServedRelay, tmp_path_factory: pytest.TempPathFactory) -> Generator[RelayedClass]:
    with relayed_class(tmp_path_factory.mktemp("class"), [relay.line]) as made:
        yield made


def test_a_student_sees_the_document_and_each_change_of_it(room: RelayedClass):
    with room.student("Ada") as ada, ada.lane() as lane:
        assert lane.ask("watch", document="rover")["type"] == "done"
        assert {"hello", "documents", "you", "document", "sites", "robot"} <= {
            event["type"] for event in lane.events
        }
        assert lane.newest("you")["name"] == "Ada"
        with room.served.presenting() as presenter:
            site = room.served.site("base_length")
            presenter.ask("edit_site", document="rover", site=site, text="0.7")
            assert lane.until("sites")["changed"]


def test_the_presenter_sees_who_is_here_and_at_which_relay(room: RelayedClass):
    with room.served.presenting() as presenter, room.student("Grace") as grace:
        with grace.lane() as lane:
            lane.ask("watch", document="rover")

            def is_here() -> bool:
                presenter.until("class_state")
                members = presenter.newest("class_state")["members"]
                return any(one["name"] == "Grace" and one["here"] for one in members)

            wait_until(is_here, "Grace")
        wait_until(lambda: not is_here(), "her leaving")


def test_a_student_may_not_edit_until_control_is_given(room: RelayedClass):
    with room.student("Alan") as alan, alan.lane() as lane, room.served.presenting() as presenter:
        lane.ask("watch", document="rover")
        site = room.served.site("base_width")
        edit = {"document": "rover", "site": site, "text": "0.45"}
        assert lane.ask("edit_site", **edit)["kind"] == "NotInControlError"
        person = lane.newest("you")["person"]
        wait_until(
            lambda: (
                presenter.ask("give_control", person=person, document="rover")["type"] == "done"
            ),
            "control",
        )
        lane.until("you", has_control=True)
        assert lane.ask("edit_site", **edit)["type"] == "done"
        assert lane.ask("return_control")["type"] == "done"


def test_who_is_sent_out_is_out_at_the_relay_until_they_are_readmitted(room: RelayedClass):
    with room.student("Kay") as kay, room.served.presenting() as presenter:
        kay.client.headers["connection"] = "close"  # those of who is sent out are ended
        with kay.lane() as lane:
            lane.ask("watch", document="rover")
            person = lane.newest("you")["person"]
        assert presenter.ask("remove_member", person=person)["type"] == "done"
        page = "/d/rover"
        wait_until(lambda: kay.client.get(page).status_code != HTTPStatus.OK, "being out")
        code = room.served.classroom.admission.code
        assert "You were sent out of this class" in kay.join("Kay again", code).text
        assert presenter.ask("readmit_member", person=person)["type"] == "done"
        wait_until(lambda: kay.client.get(page).status_code == HTTPStatus.OK, "being in again")


def test_a_locked_class_and_its_password_hold_at_the_relay(room: RelayedClass):
    with room.served.presenting() as presenter, room.student("Lin") as lin:
        code = room.served.classroom.admission.code
        presenter.ask("set_class", password="wheel")
        try:
            other = Classmate(room.address())
            assert "That is not the password" in other.join("Mel", code).text
            assert other.join("Mel", code, "wheel").status_code == HTTPStatus.SEE_OTHER
            other.close()
            presenter.ask("set_class", password="", locked=True)
            late = Classmate(room.address())
            assert "The class is locked" in late.join("Late", code).text
            late.close()
            assert lin.client.get("/d/rover").status_code == HTTPStatus.OK
        finally:
            presenter.ask("set_class", password="", locked=False)


def test_a_student_who_is_made_a_guest_may_ask_for_control_no_more(room: RelayedClass):
    with room.student("Noa") as noa, noa.lane() as lane, room.served.presenting() as presenter:
        lane.ask("watch", document="rover")
        person = lane.newest("you")["person"]
        presenter.ask("set_member_role", person=person, role="guest")
        lane.until("you", role="guest")
        assert lane.ask("ask_control", asking=True)["type"] == "refused"
        presenter.ask("set_member_role", person=person, role="helper")
        lane.until("you", role="helper")
        assert lane.until("class_state")["members"]
