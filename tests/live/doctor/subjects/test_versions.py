"""Versions of Zenoh and of rmw_zenoh."""

from __future__ import annotations

from dataclasses import replace

import pytest

from studio.live.doctor.examination import examine
from studio.live.doctor.seen import Answers, Seen
from studio.ros.tokens import whatever_type_key
from studio.ros.wire.zenoh import declare_publisher
from tests.support.dds_bridges import bridge
from tests.support.patient import STRING, Patient

pytestmark = pytest.mark.network


def answers(routers: dict[str, str], sessions: dict[str, str]) -> Answers:
    """What routers and processes said of themselves."""
    return Answers({}, None, routers, sessions, 0, ())


def codes(told: Answers) -> set[str]:
    return {one.code for one in examine(Seen(answers=told)).findings}


def test_versions_of_zenoh_that_do_not_fit_are_an_error():
    assert codes(answers({"a": "1.10.2"}, {"b": "1.8.0"})) == set()
    assert codes(answers({"a": "0.11.0"}, {"b": "1.8.0"})) == {"zenoh-versions"}
    assert codes(answers({"a": "1.8.0", "b": "1.10.2"}, {})) == {
        "several-routers",
        "router-versions",
    }


def test_samples_of_an_outdated_rmw_are_an_error(patient: Patient):
    patient.publisher(STRING, "/outdated")
    session = patient.robot.wire.zenoh
    key = whatever_type_key(0, "/outdated").replace("*/*", "std_msgs::msg::dds_::String_/RIHS01_0")
    out = declare_publisher(session, key, blocking=False, reliable=True)
    found = patient.until(
        "old-rmw", "/outdated", do=lambda: out.put(b"\0\1\0\0", attachment=b"old")
    )
    out.undeclare()
    assert found.level == "error"


def test_all_versions_that_are_known_are_said(patient: Patient):
    seen = patient.seen(asks=True)
    (told,) = (one for one in examine(seen).subjects if one.subject == "versions")
    assert "studio " in told.detail
    assert "router's Zenoh 1." in told.detail
    (blind,) = (
        one for one in examine(replace(seen, answers=None)).subjects if one.subject == "versions"
    )
    assert "Zenoh" not in blind.detail


def test_a_bridge_that_is_a_router_is_said_as_what_it_is(patient: Patient):
    seen = patient.seen(asks=True)
    assert seen.system is not None
    assert seen.answers is not None
    routers = {**seen.answers.routers, "b0b0b0": "1.9.0"}
    now = replace(
        seen,
        system=replace(seen.system, bridges=(bridge("/driver"),)),
        answers=replace(seen.answers, routers=routers),
    )
    found = examine(now)
    assert not {"several-routers", "router-versions"} & {one.code for one in found.findings}
    (told,) = (one for one in found.subjects if one.subject == "versions")
    assert "bridge to DDS 1.10.0" in told.detail
    assert "1.9.0" not in told.detail
