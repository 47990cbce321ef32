"""Nodes of other domains, at the same router."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from studio.live.doctor.asking import ask
from studio.live.doctor.examination import examine
from studio.live.doctor.seen import Here
from tests.support.dds_bridges import bridge, started
from tests.support.wire import open_test_session, show_endpoints

if TYPE_CHECKING:
    from tests.support.patient import Patient

pytestmark = pytest.mark.network


def test_nodes_of_other_domains_are_a_note_while_there_are_some_here(patient: Patient):
    with open_test_session(patient.endpoint, domain=7) as other:
        kept = show_endpoints(other, 1)
        found = patient.until("more-domains", "domain 7: 1 node", asks=True)
        assert found.level == "note"
        del kept


def test_a_domain_without_nodes_leads_to_the_one_with_some(patient: Patient):
    seen = patient.seen(asks=True)
    assert seen.system is not None
    alone = replace(seen.system, nodes=(), domain=9)
    found = {one.code: one for one in examine(replace(seen, system=alone)).findings}
    assert found["other-domain"].mend is not None
    assert found["other-domain"].mend.command == {"type": "connect_wire", "domain": 0}
    assert found["other-domain"].line == "export ROS_DOMAIN_ID=0"


def test_a_router_without_any_node_is_said(patient: Patient):
    seen = patient.seen(asks=True)
    assert seen.system is not None
    assert seen.answers is not None
    nobody = replace(
        seen,
        system=replace(seen.system, nodes=()),
        answers=replace(seen.answers, nodes_by_domain={}),
    )
    (found,) = (one for one in examine(nobody).findings if one.code == "no-nodes")
    assert "RMW_IMPLEMENTATION=rmw_zenoh_cpp" in found.sentence


def test_another_domain_of_the_terminal_is_a_note(patient: Patient):
    seen = replace(patient.seen(asks=True), here=Here(variables={"ROS_DOMAIN_ID": "5"}))
    assert "other-domain-here" in {one.code for one in examine(seen).findings}


def test_nodes_of_a_bridge_count_in_its_domain(patient: Patient):
    seen = patient.seen()
    assert seen.system is not None
    elsewhere = bridge("/driver", "/laser", settings=started(5), is_used=False)
    system = replace(seen.system, bridges=(elsewhere,))
    assert ask(patient.context.wire, system).nodes_by_domain[5] == 2


def test_why_no_node_is_behind_a_bridge_its_own_subject_says(patient: Patient):
    seen = patient.seen(asks=True)
    assert seen.system is not None
    assert seen.answers is not None
    nobody = replace(
        seen,
        system=replace(seen.system, nodes=(), bridges=(bridge(),)),
        answers=replace(seen.answers, nodes_by_domain={}),
    )
    codes = {one.code for one in examine(nobody).findings}
    assert ("no-nodes" in codes, "bridge-empty" in codes) == (False, True)
