"""Stamps of another time, on data and on /tf."""

from __future__ import annotations

import time
from dataclasses import replace

import pytest

from studio.live.doctor.seen import Ends, Header, HeardTopic
from studio.live.doctor.subjects.stamps import findings
from studio.ros.qos import DurabilityPolicy, QoSProfile
from tests.support.dds_bridges import bridged_end, graph_end
from tests.support.patient import CLOCK, SCAN, TF, Patient, clock_at, stamped, transform
from tests.support.wire import wait_until

pytestmark = pytest.mark.network
SECOND_NS = 10**9


@pytest.mark.parametrize(
    ("code", "off_s"), [("stamp-future", 3), ("stamp-past", -60), ("stamp-zero", None)]
)
def test_a_stamp_that_is_off_is_a_warning(patient: Patient, code: str, off_s: int | None):
    topic = f"/{code.replace('-', '_')}"
    out = patient.publisher(SCAN, topic)

    def send() -> None:
        stamp_ns = 0 if off_s is None else time.time_ns() + off_s * SECOND_NS
        out.publish(stamped(SCAN, "base", stamp_ns))

    found = patient.until(code, topic, do=send)
    assert found.level == "warn"
    assert "/robot" in found.sentence


def test_a_stamp_that_nothing_needs_may_be_zero(patient: Patient):
    kind = "diagnostic_msgs/msg/DiagnosticArray"
    out = patient.publisher(kind, "/unplaced")

    def came() -> bool:
        out.publish(stamped(kind, "", 0))
        heard = patient.seen().heard
        return heard is not None and heard.topics["/unplaced"].header is not None

    wait_until("its header", came)
    assert not {one for one in patient.codes("/unplaced") if one.startswith("stamp")}


def test_stamps_of_now_are_well(patient: Patient):
    out = patient.publisher(SCAN, "/stamped_now")
    for _ in range(20):
        out.publish(stamped(SCAN, "base", time.time_ns()))
        codes = patient.codes("/stamped_now")
        assert not {one for one in codes if one.startswith("stamp")}


def test_wall_time_beside_simulated_time_is_a_warning(patient: Patient):
    clock, out = patient.publisher(CLOCK, "/clock"), patient.publisher(SCAN, "/of_wall_time")

    def send() -> None:
        clock.publish(clock_at(7 * SECOND_NS))
        out.publish(stamped(SCAN, "base", time.time_ns()))

    found = patient.until("stamp-of-wall-time", "/of_wall_time", do=send)
    assert "/clock says 7.0 s" in found.sentence
    assert found.mend is not None
    assert found.mend.label == "Set use_sim_time of /robot to true"


@pytest.mark.parametrize(("code", "off_s"), [("tf-future", 5), ("tf-past", -30)])
def test_transforms_of_another_time_are_a_warning(patient: Patient, code: str, off_s: int):
    out = patient.publisher(TF, "/tf")
    child = f"moved_{code[3:]}"
    found = patient.until(
        code,
        child,
        do=lambda: out.publish(transform("world", child, time.time_ns() + off_s * SECOND_NS)),
    )
    assert "by /robot" in found.sentence
    assert [(one.kind, one.name) for one in found.about] == [("frame", child)]


@pytest.mark.parametrize(
    "durability", [DurabilityPolicy.VOLATILE, DurabilityPolicy.TRANSIENT_LOCAL]
)
def test_what_waited_on_dds_is_old_and_well(patient: Patient, durability: DurabilityPolicy):
    seen = patient.seen()
    assert seen.system is not None
    assert seen.heard is not None
    end = graph_end(bridged_end("/map", qos=QoSProfile(depth=1, durability=durability)))
    now_ns = time.time_ns()
    header = Header(now_ns - 300 * SECOND_NS, "map", now_ns, now_ns, "/driver")
    topic = HeardTopic("/map", SCAN, 5.0, 1, None, header, has_header=True, not_understood=0)
    now = replace(
        seen,
        system=replace(seen.system, topics={"/map": Ends((end,), ())}),
        heard=replace(seen.heard, topics={"/map": topic}, clock=None),
    )
    is_old = "stamp-past" in {one.code for one in findings(now)}
    assert is_old is (durability is DurabilityPolicy.VOLATILE)
