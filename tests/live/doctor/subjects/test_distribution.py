"""Types as of another distribution."""

from __future__ import annotations

from dataclasses import replace

import pytest

from studio.live.doctor.seen import Ends
from studio.live.doctor.subjects.distribution import findings
from studio.ros.graph.diagnosis import DistroHashes
from studio.ros.profiles import HUMBLE
from studio.ros.types.library import TypeLibrary
from tests.support.dds_bridges import bridged_end, graph_end
from tests.support.demos import node_at
from tests.support.patient import STRING, Patient
from tests.support.wire import open_test_session, show_endpoints

pytestmark = pytest.mark.network


@pytest.mark.parametrize("distro", ["humble", "kilted"])
def test_types_of_another_distribution_are_an_error_that_one_click_mends(
    patient: Patient, distro: str
):
    with open_test_session(patient.endpoint, distro=distro) as other:
        if distro == "kilted":  # of String all have the same
            other.types.add_texts({STRING: "string data\nstring more\n"})
        kept = show_endpoints(other, 1, name=distro)
        found = patient.until("foreign-hash", STRING)
        del kept
    assert found.level == "error"
    assert any(f"/{distro}: {STRING}" in line for line in found.evidence)
    if distro == "humble":
        assert found.mend is not None
        assert found.mend.command == {"type": "connect_wire", "distro": "humble"}
    else:
        assert "--interfaces" in found.sentence


def test_a_system_of_the_same_distribution_has_no_finding(patient: Patient):
    with node_at(patient.endpoint, "same"):
        seen = patient.seen()
    assert list(findings(seen)) == []


def test_whoever_speaks_humble_hears_of_jazzy(patient: Patient):
    seen = patient.seen()
    assert seen.system is not None
    types = TypeLibrary("humble")
    system = replace(seen.system, profile=HUMBLE, types=types, hash_of=DistroHashes(types))
    (found,) = findings(replace(seen, system=system))
    assert found.mend is not None
    assert found.mend.command["distro"] in {"jazzy", "kilted"}


@pytest.mark.parametrize("told", ["", "as here", "RIHS01_1"])
def test_of_dds_only_another_form_is_found_and_not_that_keys_hold_none(patient: Patient, told: str):
    seen = patient.seen()
    assert seen.system is not None
    types = TypeLibrary("humble")
    hashes = DistroHashes(types)
    type_hash = types.hash_of(STRING) if told == "as here" else told
    system = replace(
        seen.system,
        profile=HUMBLE,
        hash_of=hashes,
        form_of=hashes.form_of,
        topics={"/x": Ends((graph_end(bridged_end("/x", type_hash=type_hash)),), ())},
        services={},
    )
    assert len(list(findings(replace(seen, system=system)))) == (told == "RIHS01_1")
