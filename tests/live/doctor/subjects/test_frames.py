"""Frames that are missing, shared, in a circle or apart."""

from __future__ import annotations

import time
from dataclasses import replace

import pytest

from studio.live.doctor.examination import examine
from studio.live.doctor.seen import SeenDocument
from studio.live.topics.topic_rates import KEPT_S
from studio.ros.qos import DurabilityPolicy, QoSProfile
from tests.support.patient import SCAN, TF, Patient, stamped, transform
from tests.support.wire import wait_until

pytestmark = pytest.mark.network
LATCHED = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def test_a_frame_that_headers_name_and_no_transform_is_missing(patient: Patient):
    out = patient.publisher(SCAN, "/scan_of_nowhere")
    patient.later_s = 2.0

    def send() -> None:
        out.publish(stamped(SCAN, "lost_laser", time.time_ns()))

    found = patient.until("frame-missing", "lost_laser", do=send)
    assert "/scan_of_nowhere" in found.sentence
    assert found.line.endswith("--child-frame-id lost_laser")
    with_link = replace(
        patient.seen(), document=SeenDocument("d", "robot.xacro", frozenset({"lost_laser"}))
    )
    assert "frame-missing" not in {one.code for one in examine(with_link).findings}


def test_a_line_to_type_takes_a_frame_as_one_word(patient: Patient):
    out = patient.publisher(SCAN, "/scan_of_evil")
    patient.later_s = 2.0

    def send() -> None:
        out.publish(stamped(SCAN, "x; $(reboot)", time.time_ns()))

    found = patient.until("frame-missing", "x; $(reboot)", do=send)
    assert found.line.endswith("--child-frame-id 'x; $(reboot)'")


def test_data_without_any_frame_is_a_warning_where_it_is_drawn(patient: Patient):
    scan = patient.publisher(SCAN, "/scan_of_no_frame")
    joints = patient.publisher("sensor_msgs/msg/JointState", "/joints_of_no_frame")
    patient.later_s = 2.0

    def send() -> None:
        scan.publish(stamped(SCAN, "", time.time_ns()))
        joints.publish(stamped("sensor_msgs/msg/JointState", "", time.time_ns()))

    patient.until("frame-unnamed", "/scan_of_no_frame", do=send)
    assert "frame-unnamed" not in patient.codes("/joints_of_no_frame")


def test_static_transforms_that_were_sent_before_are_known(patient: Patient):
    patient.publisher(TF, "/tf_static", LATCHED).publish(transform("world", "bolted", 1))
    out = patient.publisher(SCAN, "/scan_bolted")
    patient.later_s = 2.0

    def is_known() -> bool:
        out.publish(stamped(SCAN, "bolted", time.time_ns()))
        seen = patient.seen().heard
        return seen is not None and "bolted" in {one.frame for one in seen.frames.reports}

    wait_until("the static frame", is_known)
    assert "frame-missing" not in patient.codes("bolted")


def test_two_authors_of_a_frame_are_a_warning(patient: Patient):
    outs = [patient.publisher(TF, "/tf", node=patient.node(name)) for name in ("odom_a", "odom_b")]

    def send() -> None:
        for out in outs:
            out.publish(transform("odom", "shared_base", time.time_ns()))

    found = patient.until("two-authors", "shared_base", do=send)
    assert "/odom_a, /odom_b" in found.sentence


@pytest.mark.parametrize(
    ("code", "edges"),
    [
        ("frame-circle", (("c_one", "c_two"), ("c_two", "c_one"))),
        ("frame-circle", (("c_own", "c_own"),)),
    ],
)
def test_frames_in_a_circle_are_an_error(
    patient: Patient, code: str, edges: tuple[tuple[str, str], ...]
):
    out = patient.publisher(TF, "/tf")

    def send() -> None:
        for parent, child in edges:
            out.publish(transform(parent, child, time.time_ns()))

    assert patient.until(code, edges[0][0], do=send).level == "error"


def test_a_frame_with_two_parents_is_a_warning(patient: Patient):
    outs = [patient.publisher(TF, "/tf", node=patient.node(name)) for name in ("left", "right")]

    def send() -> None:
        for out, parent in zip(outs, ("p_left", "p_right"), strict=True):
            out.publish(transform(parent, "torn", time.time_ns()))

    patient.until("two-parents", "torn", do=send)


def test_a_transform_that_comes_too_late_is_a_warning(patient: Patient):
    outs = [patient.publisher(TF, "/tf", node=patient.node(name)) for name in ("prompt", "late")]

    def send() -> None:
        for out, late_s in zip(outs, (0, 60), strict=True):
            out.publish(transform("l_odom", "l_base", time.time_ns() - late_s * 10**9))

    found = patient.until("tf-too-old", "l_base", do=send)
    assert (found.level, found.about[0].name) == ("warn", "l_base")
    assert set(found.evidence) == {"from /late: l_base in l_odom"}


def test_a_time_that_begins_again_is_a_note(patient: Patient):
    out = patient.publisher(TF, "/tf")

    def send() -> None:
        for ago_s in (0, 60):
            out.publish(transform("j_odom", "j_base", time.time_ns() - ago_s * 10**9))

    found = patient.until("time-jumped", "j_base", do=send)
    assert (found.level, found.about[0].name) == ("note", "j_base")
    assert "went back by" in found.sentence


def test_a_frame_that_its_own_publisher_hangs_elsewhere_is_a_note(patient: Patient):
    out = patient.publisher(TF, "/tf")

    def send() -> None:
        for parent in ("m_table", "m_gripper"):
            out.publish(transform(parent, "m_cup", time.time_ns()))

    found = patient.until("frame-moved", "m_cup", do=send)
    assert (found.level, found.about[0].name) == ("note", "m_cup")
    assert "m_table" in found.sentence
    assert "m_gripper" in found.sentence

    def is_over() -> bool:
        patient.later_s += KEPT_S - 1  # so that it goes on listening
        return "frame-moved" not in patient.codes("m_cup")

    wait_until("what is long ago is not found any more", is_over)
    assert patient.later_s > 50  # and was so until then


def test_trees_that_nothing_connects_are_a_warning(patient: Patient):
    out = patient.publisher(TF, "/tf")

    def send() -> None:
        out.publish(transform("t_map", "t_robot", time.time_ns()))
        out.publish(transform("t_other", "t_sensor", time.time_ns()))

    found = patient.until("several-trees", "t_other", do=send)
    assert "t_map" in found.sentence


def test_a_transform_that_cannot_be_used_is_a_warning(patient: Patient):
    out = patient.publisher(TF, "/tf")

    def send() -> None:
        bad = transform("b_world", "b_bad", time.time_ns())
        bad.transforms[0].transform.rotation.w = 0.0
        out.publish(bad)

    assert "quaternion is zero" in patient.until("bad-transform", "b_bad", do=send).sentence


def test_names_without_end_are_bounded(patient: Patient):
    out, endless = patient.publisher(TF, "/tf"), "x" * 100_000
    patient.until(
        "bad-transform",
        "has more than",
        do=lambda: out.publish(transform("world", endless, time.time_ns())),
    )
    found = patient.examined()
    assert max(len(one.model_dump_json()) for one in found.findings) < 10_000
