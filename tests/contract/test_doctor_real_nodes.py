"""The Doctor in front of nodes of a real ROS 2: a sound one is well, a stopped one is found."""

from __future__ import annotations

import os
import signal
from dataclasses import replace

import pytest

from studio.live.doctor.asking import ask
from studio.live.doctor.examination import examine
from tests.support.patient import patient_system
from tests.support.ros2_peer import real_node
from tests.support.wire import free_endpoint, router_at, wait_until

SERVER = "/peer_server"
pytestmark = [pytest.mark.network, pytest.mark.sweep, pytest.mark.timeout(120)]


def test_a_real_node_is_well_until_its_process_is_stopped(monkeypatch: pytest.MonkeyPatch):
    endpoint = free_endpoint()
    with (
        router_at(endpoint),
        patient_system(endpoint) as doctor,
        real_node(endpoint, "server") as real,
    ):
        real.wait_said("ready")
        graph, wire = doctor.context.graph, doctor.context.wire
        wait_until("it can be asked", lambda: bool(graph.servers(f"{SERVER}/get_parameters")))
        seen = doctor.seen(asks=True)
        assert seen.answers is not None
        assert seen.answers.silent == ()
        assert set(seen.answers.sessions.values()) == {"1.8.0"}
        codes = {one.code for one in examine(seen).findings if one.level != "note"}
        assert codes == set()
        # A process that is stopped is waited for with each question.
        monkeypatch.setattr("studio.ros.graph.diagnosis._ADMIN_TIMEOUT_S", 0.5)
        monkeypatch.setattr("studio.live.doctor.asking.ANSWER_S", 0.5)
        os.kill(real.process.pid, signal.SIGSTOP)
        try:
            after = doctor.seen()
            assert after.system is not None
            answers = ask(wire, after.system, seen.answers)
        finally:
            os.kill(real.process.pid, signal.SIGCONT)
        found = {one.code: one for one in examine(replace(after, answers=answers)).findings}
        assert SERVER in found["dead-node"].sentence
