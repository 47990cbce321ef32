"""Silent sensors, and topics that become slow."""

from __future__ import annotations

from dataclasses import replace

import pytest

from studio.live.doctor.examination import examine
from studio.live.doctor.pace import PaceNow
from tests.support.patient import SCAN, STRING, Patient, stamped
from tests.support.wire import wait_until

pytestmark = pytest.mark.network
SCANNED = stamped(SCAN, "base", 1)


def heard(patient: Patient, topic: str) -> int:
    """How many samples of a topic came."""
    found = patient.seen().heard
    assert found is not None
    return found.topics[topic].samples if topic in found.topics else 0


def test_a_sensor_that_never_speaks_is_silent(patient: Patient):
    patient.publisher(SCAN, "/mute_scan")
    patient.publisher(STRING, "/mute_text")
    wait_until("it is listened to", lambda: "/mute_scan" in patient.listened_to())
    assert "silent-topic" not in patient.codes("/mute_scan")
    patient.later_s = 3.0
    found = patient.until("silent-topic", "/mute_scan")
    assert "nothing came in 3 s" in found.sentence
    assert found.talk is not None
    assert found.talk.sources == ("/robot",)
    assert "silent-topic" not in patient.codes("/mute_text")  # it may speak when it has something


def test_a_topic_that_stops_is_silent_after_some_of_its_periods(patient: Patient):
    out = patient.publisher(SCAN, "/stopped_scan")

    def published() -> bool:
        out.publish(SCANNED)
        return heard(patient, "/stopped_scan") > 0

    wait_until("its way is there", published)
    before = heard(patient, "/stopped_scan")
    for at in range(1, 13):
        out.publish(SCANNED)
        wait_until("each comes", lambda: heard(patient, "/stopped_scan") >= before + at)  # noqa: B023 - done within
    assert "silent-topic" not in patient.codes("/stopped_scan")
    patient.later_s = 4.0
    found = patient.until("silent-topic", "/stopped_scan")
    assert found.sentence.startswith("Nothing has come on /stopped_scan for ")
    patient.later_s = 0.0


def test_a_topic_slower_than_its_own_average_is_a_warning(patient: Patient):
    patient.publisher(SCAN, "/slowed_scan")
    wait_until("it is listened to", lambda: "/slowed_scan" in patient.listened_to())
    seen = patient.seen()
    assert seen.heard is not None
    slow = replace(
        seen.heard.topics["/slowed_scan"],
        samples=900,
        pace=PaceNow(20.0, 7.0, 0.1, is_slow=True),
    )
    heard_so = replace(seen.heard, topics={"/slowed_scan": slow})
    found = {one.code: one for one in examine(replace(seen, heard=heard_so)).findings}
    assert "comes 7 times a second, and came 20" in found["slow-topic"].sentence


def test_what_is_listened_to_is_said(patient: Patient):
    patient.publisher(STRING, "/listened_to")
    wait_until("it is listened to", lambda: "/listened_to" in patient.listened_to())
    (rates,) = (one for one in patient.examined().subjects if one.subject == "rates")
    assert rates.count >= 1
    assert rates.detail.startswith("listened for ")
