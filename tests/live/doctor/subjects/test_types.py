"""Types that clash or are not known."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from studio.live.doctor.examination import examine
from studio.live.doctor.seen import Ends
from studio.live.doctor.subjects.types import findings
from studio.ros.profiles import HUMBLE
from studio.ros.tokens import EndpointKind
from studio.ros.types.files import InterfaceTexts
from studio.ros.types.library import TypeLibrary
from tests.support.dds_bridges import bridged_end, graph_end
from tests.support.patient import STRING, Patient
from tests.support.wire import open_test_session, show_endpoints

if TYPE_CHECKING:
    from studio.protocol.doctor import Finding
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.profiles import WireProfile

pytestmark = pytest.mark.network
RANGE = "sensor_msgs/msg/Range"


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


def found_on_dds(
    patient: Patient, *ends: GraphEndpoint, profile: WireProfile | None = None
) -> dict[str, Finding]:
    """What is found of the ends of /range, by code."""
    seen = patient.seen()
    assert seen.system is not None
    system = replace(
        seen.system,
        topics={"/range": Ends(ends[:1], ends[1:])},
        nodes=tuple(one.node for one in ends),
        profile=profile or seen.system.profile,
    )
    return {one.code: one for one in findings(replace(seen, system=system))}


def range_end(type_name: str = RANGE, told: str = "", node: str = "/talker") -> GraphEndpoint:
    kind = EndpointKind.PUBLISHER if node == "/talker" else EndpointKind.SUBSCRIPTION
    return graph_end(bridged_end("/range", node, kind=kind, type_name=type_name, type_hash=told))


def test_a_type_that_is_told_by_name_only_is_no_other_form(patient: Patient):
    codes = found_on_dds(patient, range_end(), range_end(told="RIHS01_1", node="/listener"))
    assert "hash" not in codes
    assert codes["other-form"].evidence == (f"/range: {RANGE} by name only",)


def test_types_by_name_that_humble_has_in_another_form_are_a_warning(patient: Patient):
    found = found_on_dds(patient, range_end())["other-form"]
    assert f"{RANGE} of humble is another than of jazzy" in found.sentence
    assert found.mend is not None
    assert found.mend.command == {"type": "connect_wire", "distro": "humble"}
    as_humble = found_on_dds(patient, range_end(), profile=HUMBLE)
    assert as_humble["by-name-only"].level == "note"


def test_types_by_name_that_are_the_same_everywhere_are_a_note(patient: Patient):
    assert found_on_dds(patient, range_end(STRING)).keys() == {"by-name-only"}
    assert found_on_dds(patient, range_end(STRING, told="RIHS01_1")).keys() == set()


def test_two_forms_on_dds_are_misread(patient: Patient):
    ends = range_end(told="RIHS01_1"), range_end(told="RIHS01_2", node="/listener")
    assert "misread on DDS" in found_on_dds(patient, *ends)["hash"].sentence
