"""The Doctor in front of nodes of a real ROS 2: a sound one is well, a stopped one is found."""

from __future__ import annotations

import asyncio
import os
import signal
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from studio.live.connection.ros_connection import RosConnection
from studio.live.doctor.asking import ask
from studio.live.doctor.examination import examine
from studio.live.panels.doctor import Doctor
from studio.live.panels.parameters import NodeParameters
from studio.protocol.doctor import ExamineSystem
from studio.protocol.parameters import SetParameter
from studio.settings import WireChoice
from tests.support.open_documents import Ear
from tests.support.patient import patient_system
from tests.support.ros2_peer import real_node
from tests.support.wire import PATIENCE_S, free_endpoint, router_at, wait_until

if TYPE_CHECKING:
    from studio.protocol.doctor import Finding

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


async def found_by(doctor: Doctor, *, code: str, is_there: bool = True) -> Finding | None:
    """Ask until something is found about the real node, or is found no more."""
    async with asyncio.timeout(PATIENCE_S):
        while True:
            answer = await doctor.examine(ExamineSystem(), Ear())
            found = [one for one in answer.findings if one.code == code and SERVER in one.sentence]
            if bool(found) is is_there:
                return found[0] if found else None
            await asyncio.sleep(0.05)


def test_what_a_real_node_was_started_with_is_known_and_a_click_sets_its_time():
    endpoint = free_endpoint()

    async def run() -> None:
        connection = RosConnection(WireChoice("off", (endpoint,)))
        doctor, parameters = Doctor(connection, lambda: ()), NodeParameters(connection)
        connection.on_change = doctor.listen
        graph = (await connection.link()).graph
        topic = "/parameter_events"
        await asyncio.to_thread(
            wait_until, "the studio listens", lambda: bool(graph.subscriptions(topic))
        )
        with real_node(endpoint, "server") as real:
            await asyncio.to_thread(real.wait_said, "ready")
            simulated = SetParameter(node=SERVER, name="use_sim_time", text="true")
            await parameters.set(simulated)
            changed = await found_by(doctor, code="parameter-changed")
            assert changed is not None
            assert changed.evidence == (
                "use_sim_time is now True, and was False when it was declared",
            )
            still = await found_by(doctor, code="no-clock")
            assert still is not None
            assert still.mend is not None
            await parameters.set(SetParameter.model_validate(still.mend.command))
            assert await found_by(doctor, code="no-clock", is_there=False) is None
            assert await found_by(doctor, code="parameter-changed", is_there=False) is None
        for part in parameters, doctor, connection:
            await part.close()

    with router_at(endpoint):
        asyncio.run(run())
