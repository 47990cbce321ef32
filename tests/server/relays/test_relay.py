"""A class that is shared by a relay: what its people see and do there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

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
