"""Types that clash or are not known."""

from __future__ import annotations

from dataclasses import replace

import pytest

from studio.live.doctor.examination import examine
from studio.ros.types.files import InterfaceTexts
from studio.ros.types.library import TypeLibrary
from tests.support.patient import STRING, Patient
from tests.support.wire import open_test_session, show_endpoints

pytestmark = pytest.mark.network


def test_two_types_of_one_topic_are_an_error(patient: Patient):
    patient.publisher(STRING, "/two_types")
    patient.subscribe("std_msgs/msg/Int64", "/two_types")
    found = patient.until("type", "/two_types")
    assert found.sentence.startswith("/two_types has 2 types, std_msgs/msg/Int64, std_msgs/msg/Str")
    assert found.talk is not None
    assert not found.talk.meets


def test_two_forms_of_one_type_are_an_error(patient: Patient):
    with open_test_session(patient.endpoint) as other:
        other.types.add_texts({STRING: "string data\nstring more\n"})
        kept = show_endpoints(other, 1, name="forms")
        patient.subscribe(STRING, "/forms/topic_0")
        found = patient.until("hash", "/forms/topic_0")
        del kept
    assert "has several forms, which never meet" in found.sentence


def test_a_type_that_is_not_known_is_a_warning(patient: Patient):
    patient.robot.wire.types.add_texts({"own_things/msg/Odd": "string data\n"})
    patient.publisher("own_things/msg/Odd", "/odd_thing")
    found = patient.until("unknown-type", "/odd_thing")
    assert "own_things/msg/Odd" in found.sentence


def test_a_faulty_interface_file_is_a_warning(patient: Patient):
    seen = patient.seen()
    assert seen.system is not None
    types = TypeLibrary("jazzy")
    types.add_sound_texts(InterfaceTexts({"own_things/msg/Bad": "int32 Speed\n"}, {}))
    found = {
        one.code
        for one in examine(replace(seen, system=replace(seen.system, types=types))).findings
    }
    assert "interface-text" in found
