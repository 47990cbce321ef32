"""Clocks that differ, and two kinds of time."""

from __future__ import annotations

import json
import time
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from studio.live.doctor.seen import Offset
from studio.live.doctor.subjects.clocks import findings
from studio.live.topics.topic_rates import KEPT_S
from studio.protocol.parameters import SetParameter
from studio.ros.attachment import packed
from studio.ros.messages import message
from studio.ros.parameters.parameter import Parameter
from studio.ros.tokens import DataKey
from studio.ros.wire.zenoh import declare_publisher
from studio.server.commands import parse_command
from tests.support.patient import CLOCK, STRING, Patient, clock_at
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from studio.protocol.displays import Mend

pytestmark = pytest.mark.network


@pytest.mark.parametrize(("code", "off_s"), [("clock-ahead", 5.0), ("clock-behind", -5.0)])
def test_a_clock_that_differs_is_found_in_both_directions(
    patient: Patient, code: str, off_s: float
):
    node = patient.node("elsewhere")
    topic = f"/{code.replace('-', '_')}"
    patient.publisher(STRING, topic, node=node)
    wait_until("its publisher is there", lambda: bool(node.graph.publishers(topic)))
    (end,) = node.graph.publishers(topic)
    key = str(DataKey(0, topic, end.type_name, end.type_hash))
    out = declare_publisher(node.wire.zenoh, key, blocking=False, reliable=True)
    numbers, off_by_s = iter(range(1, 1_000_000)), off_s

    def send() -> None:
        sent_ns = time.time_ns() + int(off_by_s * 1e9)
        out.put(b"\0\1\0\0\1\0\0\0\0", attachment=packed(next(numbers), sent_ns, end.gid))

    found = patient.until(code, "/elsewhere", do=send)
    assert found.level == "error"
    assert "/elsewhere" in found.sentence
    off_by_s = 0.0

    def is_set() -> bool:
        patient.later_s += KEPT_S - 1  # so that it goes on listening
        send()
        return code not in patient.codes("/elsewhere")

    wait_until("a clock that was set is right again", is_set)
    out.undeclare()


def test_simulated_time_without_a_clock_is_an_error(patient: Patient):
    patient.subscribe(CLOCK, "/clock")
    found = patient.until("no-clock", "/robot")
    assert found.line == "ros2 param set /robot use_sim_time false"
    assert found.evidence == ("subscribers of /clock: /robot", "publishers of /clock: 0")


def test_what_the_click_sets_ends_both_findings(patient: Patient):
    node = patient.node("simulated")
    patient.publisher(STRING, "/by_simulated", node=node)

    def set_as(mend: Mend | None) -> None:
        assert mend is not None
        command = parse_command(json.dumps({"request": 1, **mend.command}).encode())
        assert isinstance(command, SetParameter)
        assert (command.node, command.name) == ("/simulated", "use_sim_time")
        assert mend.label == f"Set use_sim_time of /simulated to {command.text}"
        (done,) = node.set_parameters([Parameter(command.name, value=command.text == "true")])
        assert done.successful

    node.set_parameters([Parameter("use_sim_time", value=True)])
    set_as(patient.until("no-clock", "/simulated").mend)
    wait_until("it is mended", lambda: "no-clock" not in patient.codes("/simulated"))
    patient.publisher(CLOCK, "/clock")
    set_as(patient.until("time-mixed", "/simulated").mend)
    wait_until("it goes by it", lambda: "time-mixed" not in patient.codes("/simulated"))


def test_two_clocks_and_nodes_of_wall_time_are_warnings(patient: Patient):
    one, other = patient.node("gazebo"), patient.node("bag")
    for node in one, other:
        patient.publisher(CLOCK, "/clock", node=node).publish(clock_at(5 * 10**9))
    patient.publisher(STRING, "/by_wall_time")
    assert "/bag, /gazebo" in patient.until("two-clocks").sentence
    mixed = patient.until("time-mixed", "/robot")
    assert "/gazebo" not in mixed.sentence
    patient.subscribe(CLOCK, "/clock")
    assert "time-mixed" not in patient.codes("/robot")


def test_clocks_that_agree_are_well(patient: Patient):
    out = patient.publisher(STRING, "/agreed")

    def heard() -> int:
        out.publish(message(STRING)())
        seen = patient.seen().heard
        return sum(one.samples for one in seen.offsets) if seen else 0

    wait_until("some samples", lambda: heard() > 5)
    assert not patient.codes("/robot") & {"clock-ahead", "clock-behind"}


def test_the_clock_of_nodes_on_dds_is_that_of_their_bridge(patient: Patient):
    seen = patient.seen()
    assert seen.heard is not None
    offset = Offset("b0b0b0", ("/driver",), -2 * 10**9, 9, "robot")
    (found,) = findings(replace(seen, system=None, heard=replace(seen.heard, offsets=(offset,))))
    assert found.sentence.startswith("The clock of the machine of the bridge robot is at least 2 s")
    assert "it was passed on" in found.evidence[0]
