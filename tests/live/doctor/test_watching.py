"""Listening: it begins with the first question, leaves the graph alone, and ends by itself."""

from __future__ import annotations

import struct

import pytest

from studio.live.doctor.topic_watch import Reading, TopicWatch, header_of
from studio.live.doctor.watching import has_header
from studio.live.topics.topic_rates import KEPT_S
from studio.ros.cdr import codec_of
from studio.ros.messages import message, shared_types
from tests.support.patient import SCAN, STRING, Patient, stamped
from tests.support.wire import wait_until

pytestmark = pytest.mark.network


def test_nobody_is_heard_before_the_first_question(patient: Patient):
    patient.publisher(STRING, "/quiet")
    assert patient.watching.listens_to == ()
    assert "/quiet" in patient.listened_to()
    assert "/quiet" in patient.watching.listens_to
    assert patient.context.graph.subscriptions("/quiet") == []


def test_it_ends_by_itself_when_nobody_asks_any_more(patient: Patient):
    patient.publisher(STRING, "/quiet_again")
    assert "/quiet_again" in patient.listened_to()
    patient.later_s = KEPT_S + 1
    wait_until("it ends", lambda: patient.watching.listens_to == ())
    again = patient.seen().heard  # it begins anew
    assert again is not None
    assert again.listened_s < KEPT_S
    assert again.topics["/quiet_again"].samples == 0


def test_a_topic_that_is_gone_is_heard_no_more(patient: Patient):
    out = patient.publisher(STRING, "/passing")
    assert "/passing" in patient.listened_to()
    patient.robot.destroy_publisher(out)
    wait_until("it is left", lambda: "/passing" not in patient.listened_to())


def test_its_own_session_is_not_listened_to_nor_hidden_topics(patient: Patient):
    patient.publisher(STRING, "/_hidden/feedback")
    assert "/_hidden/feedback" not in patient.listened_to()
    assert "/rosout" not in patient.listened_to()


def test_a_large_message_is_copied_once_a_second_at_most(patient: Patient):
    out = patient.publisher("sensor_msgs/msg/Image", "/large_image")
    now_s = 100.0
    watch = TopicWatch(patient.context, "/large_image", 60.0, Reading(True), lambda: now_s)
    patient.after(watch.close)
    image = stamped("sensor_msgs/msg/Image", "cam", 1)
    image.data = bytes(1 << 17)

    def came(count: int) -> bool:
        out.publish(image)
        return watch.samples >= count

    wait_until("the first", lambda: came(1))
    first = watch.header()
    assert first is not None
    wait_until("more", lambda: came(5))
    assert watch.header() is first
    now_s = 102.0
    wait_until("another", lambda: came(10) and watch.header() is not first)


@pytest.mark.parametrize("order", ["little", "big"])
def test_a_header_is_read_in_both_byte_orders(order: str):
    codec = codec_of(message(SCAN))
    payload = codec.encode(stamped(SCAN, "laser", 12 * 10**9 + 34), little_endian=order == "little")
    assert header_of(bytes(payload)) == (12 * 10**9 + 34, "laser")


@pytest.mark.parametrize(
    "payload", [b"", b"\0\1\0\0", b"\0\1\0\0" + struct.pack("<iII", 1, 2, 1 << 31) + b"x"]
)
def test_bytes_that_are_no_header_do_no_harm(payload: bytes):
    found = header_of(payload)
    assert found is None or len(found[1]) <= 1_024


def test_only_types_that_begin_with_a_header_have_one():
    types = shared_types()
    assert has_header(types, SCAN)
    assert not has_header(types, STRING)
    assert not has_header(types, "nowhere/msg/Nothing")
