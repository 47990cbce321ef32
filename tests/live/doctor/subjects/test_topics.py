"""Topics with one side only."""

from __future__ import annotations

from dataclasses import replace

import pytest

from studio.live.doctor.examination import examine
from tests.support.patient import STRING, Patient

pytestmark = pytest.mark.network


def test_a_topic_of_one_side_is_a_note(patient: Patient):
    patient.publisher(STRING, "/spoken_only")
    patient.subscribe("std_msgs/msg/Int32", "/waited_for")
    waits = patient.until("no-publisher", "/waited_for")
    assert (waits.level, waits.sentence) == (
        "note",
        "/robot waits for /waited_for, which nobody publishes.",
    )
    assert waits.talk is not None
    assert (waits.talk.sources, waits.talk.targets) == ((), ("/robot",))
    assert patient.until("no-subscriber", "/spoken_only").level == "note"


def test_two_names_that_may_be_one_are_a_warning(patient: Patient):
    patient.publisher(STRING, "/turtle/cmd_vel")
    patient.subscribe(STRING, "/turtle/cmd_val")
    found = patient.until("perhaps-meant", "/turtle/cmd_val")
    assert found.level == "warn"
    assert "/turtle/cmd_vel" in found.sentence
    assert found.line.endswith("-r /turtle/cmd_val:=/turtle/cmd_vel")
    assert patient.codes("/turtle/cmd_val") == {"perhaps-meant"}


def test_a_namespace_that_one_side_lacks_is_a_warning(patient: Patient):
    patient.publisher(STRING, "/robot_1/odometry_text")
    patient.subscribe(STRING, "/odometry_text")
    patient.until("perhaps-meant", "/robot_1/odometry_text")


def test_names_of_other_types_are_not_taken_for_one(patient: Patient):
    patient.publisher(STRING, "/near_a")
    patient.subscribe("std_msgs/msg/Int32", "/near_b")
    patient.until("no-publisher", "/near_b")
    assert "perhaps-meant" not in patient.codes("/near_b")


def test_a_topic_with_both_sides_is_well(patient: Patient):
    patient.publisher(STRING, "/both_sides")
    patient.subscribe(STRING, "/both_sides")
    assert patient.codes("/both_sides") == set()


def test_what_the_studio_itself_waits_for_is_a_note(patient: Patient):
    patient.subscribe(STRING, "/plotted_topic")
    seen = patient.seen()
    assert seen.system is not None
    own = replace(seen.system, own=frozenset({patient.robot.wire.zid}))
    found = {one.code: one for one in examine(replace(seen, system=own)).findings}
    assert "/plotted_topic" in found["studio-waits"].sentence
    assert "no-publisher" not in found
