"""Services and actions: served twice, not at all, or not answered."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from studio.live.doctor.examination import examine
from studio.live.doctor.seen import Unanswered
from studio.ros.action import ActionClient
from studio.ros.messages import service
from tests.support.goals import FIBONACCI

if TYPE_CHECKING:
    from tests.support.patient import Patient

pytestmark = pytest.mark.network
TRIGGER = service("std_srvs/srv/Trigger")


def test_a_service_with_two_servers_is_a_warning(patient: Patient):
    for name in "one", "other":
        patient.node(name).create_service(TRIGGER, "/served_twice", lambda _, answer: answer)
    found = patient.until("two-servers", "/served_twice")
    assert found.sentence == "/served_twice is served 2 times, by /one, /other: keep one."


def test_one_node_that_serves_a_name_twice_is_a_warning(patient: Patient):
    node = patient.node("eager")
    for _ in range(2):
        node.create_service(TRIGGER, "/eager_go", lambda _, answer: answer)
    assert "by /eager, /eager" in patient.until("two-servers", "/eager_go").sentence


def test_a_client_without_server_is_a_warning(patient: Patient):
    node = patient.node("waiting")
    node.create_client(TRIGGER, "/never_served")
    ActionClient(node, node.wire.types.action(FIBONACCI), "/never_done")
    found = patient.until("not-served", "/never_served")
    assert found.sentence == (
        "/waiting has a client of the service /never_served, which nobody serves."
    )
    assert "the action /never_done" in patient.until("not-served", "/never_done").sentence
    assert patient.codes("/never_done") == {"not-served"}


def test_calls_and_goals_without_answer_are_warnings(patient: Patient):
    seen = replace(
        patient.seen(),
        unanswered=(
            Unanswered(False, "/go", "No answer came."),
            Unanswered(True, "/turn", "Gone."),
        ),
    )
    found = [one.sentence for one in examine(seen).findings if one.code == "not-answered"]
    assert found == [
        "The last call of /go was not answered. No answer came.",
        "The last goal of /turn was not answered. Gone.",
    ]
