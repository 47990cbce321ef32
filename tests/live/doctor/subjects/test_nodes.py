"""Nodes of one name, silent ones, and tokens that are none."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from studio.live.doctor import asking
from studio.live.doctor.examination import examine
from studio.ros.client import Context, Node
from studio.ros.graph.diagnosis import UnseenNodes
from studio.ros.wire.zenoh import declare_token
from tests.support.wire import open_test_session

if TYPE_CHECKING:
    from tests.support.patient import Patient

pytestmark = pytest.mark.network


def test_two_nodes_of_one_name_are_one_finding(patient: Patient):
    patient.node("twin")
    patient.node("twin")
    found = patient.until("duplicate-name", "2 nodes are called /twin")
    assert len(found.evidence) == 2
    assert [(one.kind, one.name) for one in found.about] == [("node", "/twin")]
    assert "two-servers" not in patient.codes("/twin")


def test_a_node_that_nobody_spins_does_not_answer(
    patient: Patient, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(asking, "ANSWER_S", 0.4)
    with open_test_session(patient.endpoint) as wire:
        context = Context.over(wire)
        Node("asleep", context=context)
        found = patient.until("silent-node", "/asleep", asks=True)
        context.shutdown()
    assert found.level == "warn"
    assert "/robot" not in found.sentence
    seen = patient.seen(asks=True)
    assert seen.answers is not None
    assert seen.answers.asked >= 1
    assert "/robot" not in seen.answers.silent


def test_a_token_that_is_none_is_found(patient: Patient):
    session = patient.robot.wire.zenoh
    token = declare_token(session, "@ros2_lv/0/junk")
    found = patient.until("token", "not understood")
    token.undeclare()
    assert "junk" in found.evidence[0]


def test_processes_that_the_router_does_not_show_are_an_error(patient: Patient):
    seen = patient.seen(asks=True)
    assert seen.answers is not None
    unseen = replace(seen.answers, unseen=UnseenNodes(2, ("1.8.0",), ("1.10.2",)))
    found = {one.code: one for one in examine(replace(seen, answers=unseen)).findings}
    assert "2 processes publish (Zenoh 1.8.0)" in found["unseen-nodes"].sentence


def test_a_process_that_answered_before_and_does_no_more_is_dead(patient: Patient):
    seen = patient.seen(asks=True)
    assert seen.answers is not None
    zid = patient.robot.wire.zid
    lost = replace(seen.answers, lost=frozenset({zid}), silent=("/robot",))
    found = {one.code: one for one in examine(replace(seen, answers=lost)).findings}
    assert found["dead-node"].level == "error"
    assert "silent-node" not in found


def test_who_answers_no_more_is_known_by_the_answers_before(patient: Patient):
    seen = patient.seen(asks=True)
    assert seen.system is not None
    assert seen.answers is not None
    before = replace(seen.answers, sessions={patient.robot.wire.zid: "1.8.0", "gone": "1.8.0"})
    wire = patient.context.wire
    again = asking.ask(wire, seen.system, before)
    assert again.lost == {patient.robot.wire.zid}  # the other has no node any more
    assert asking.ask(wire, seen.system, again).lost == again.lost
