"""Profiles that DDS would not match, and promises that nobody watches."""

from __future__ import annotations

from dataclasses import replace

import pytest

from studio.live.doctor.seen import Answers, Ends
from studio.live.doctor.subjects.qos import findings
from studio.ros.duration import Duration
from studio.ros.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy
from studio.ros.tokens import EndpointKind
from tests.support.dds_bridges import bridged_end, graph_end
from tests.support.patient import STRING, Patient, stamped

pytestmark = pytest.mark.network
SECOND = Duration(seconds=1)

FAULTS = {
    "reliable": (
        QoSProfile(reliability=ReliabilityPolicy.BEST_EFFORT),
        QoSProfile(depth=10),
        "the publisher is best effort, the subscription wants reliable",
    ),
    "latched": (
        QoSProfile(depth=1),
        QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL),
        "the publisher is volatile, the subscription wants transient local",
    ),
    "deadline": (QoSProfile(depth=1), QoSProfile(depth=1, deadline=SECOND), "deadline"),
    "lease": (
        QoSProfile(depth=1),
        QoSProfile(depth=1, liveliness_lease_duration=SECOND),
        "liveliness lease",
    ),
    "liveliness": (
        QoSProfile(depth=1),
        QoSProfile(depth=1, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC),
        "liveliness is automatic",
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_profile_that_dds_would_not_match_is_a_warning(patient: Patient, fault: str):
    offered, wanted, said = FAULTS[fault]
    topic = f"/qos_{fault}"
    patient.publisher(STRING, topic, offered)
    patient.subscribe(STRING, topic, wanted)
    found = patient.until("qos", topic)
    assert said in found.sentence
    assert found.sentence.endswith("(/robot to /robot); Zenoh carries it, DDS would not.")
    assert found.evidence[0].startswith("/robot offers ")


def test_policies_that_only_dds_keeps_are_a_note(patient: Patient):
    promised = QoSProfile(
        depth=5, deadline=SECOND, lifespan=SECOND, liveliness_lease_duration=SECOND
    )
    patient.publisher(STRING, "/qos_promised", promised)
    found = patient.until("qos-not-watched", "/qos_promised")
    assert found.level == "note"
    assert "a deadline and a lifespan and a liveliness lease" in found.sentence


def test_a_deadline_that_is_missed_is_a_warning(patient: Patient):
    out = patient.publisher("sensor_msgs/msg/Imu", "/qos_late", QoSProfile(
        depth=5, deadline=Duration(nanoseconds=1_000_000)
    ))  # fmt: skip
    found = patient.until(
        "deadline-missed",
        "/qos_late",
        do=lambda: out.publish(stamped("sensor_msgs/msg/Imu", "base", 1)),
    )
    assert "every 0.001 s at the latest" in found.sentence


def test_profiles_that_match_are_well(patient: Patient):
    patient.publisher(STRING, "/qos_well", 10)
    patient.subscribe(STRING, "/qos_well", QoSProfile(reliability=ReliabilityPolicy.BEST_EFFORT))
    assert patient.codes("/qos_well") == set()


@pytest.mark.parametrize(
    ("way", "code"),
    [("dds", "qos-on-dds"), ("announces", "qos-through-bridge"), ("announced", ""), ("zenoh", "")],
)
def test_what_becomes_of_profiles_on_dds_goes_by_the_way(patient: Patient, way: str, code: str):
    offered = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    out = graph_end(bridged_end("/on_dds", qos=offered))
    into = graph_end(bridged_end("/on_dds", "/listener", kind=EndpointKind.SUBSCRIPTION))
    if way == "announces":
        out = replace(out, node=replace(out.node, zid="c0c0c0", bridge=""))
    elif way != "dds":
        into = replace(into, node=replace(into.node, zid="c0c0c0", bridge=""))
    seen = patient.seen()
    assert seen.system is not None
    system = replace(seen.system, topics={"/on_dds": Ends((out,), (into,))})
    announcing = frozenset({"c0c0c0"}) if way != "zenoh" else frozenset[str]()
    answers = Answers({}, None, {}, {}, 0, (), announcing=announcing)
    found = [one.code for one in findings(replace(seen, system=system, answers=answers))]
    assert found == ([code] if code else [])


def test_dds_watches_what_its_nodes_promise(patient: Patient):
    promised = QoSProfile(depth=5, deadline=SECOND)
    seen = patient.seen()
    assert seen.system is not None
    ends = Ends((graph_end(bridged_end("/on_dds", qos=promised)),), ())
    system = replace(seen.system, topics={"/on_dds": ends})
    assert list(findings(replace(seen, system=system))) == []
