"""The Doctor of the studio: connected or not, asked by many, and in front of a hostile graph."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from functools import partial
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import RouterGoneError
from studio.live.connection.link import WireLink
from studio.live.connection.ros_connection import RosConnection
from studio.live.doctor.seen import SeenDocument, Unanswered
from studio.live.panels import doctor
from studio.live.panels.doctor import COMMANDS, Doctor
from studio.protocol.doctor import FINDINGS_MAX, ExamineSystem, GetDoctorReport
from studio.protocol.roles import Role
from studio.ros.parameters.parameter import Parameter
from studio.ros.qos import QoSProfile
from studio.ros.tokens import EndpointKind, EndpointToken, NodeToken
from studio.ros.wire.zenoh import declare_token
from studio.settings import WireChoice
from tests.support.demos import node_at
from tests.support.loop_watch import stalls
from tests.support.open_documents import Ear
from tests.support.wire import PATIENCE_S, free_endpoint, open_test_session, wait_until

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator

    from studio.protocol.doctor import SystemExamined
    from studio.ros.client import Node
    from studio.ros.wire.session import WireSession
    from tests.support.loop_watch import Stall

ME = Ear()
pytestmark = [pytest.mark.network, pytest.mark.timeout(180)]
UNANSWERED = (Unanswered(is_action=False, name="/go", why="No answer came in 3 s."),)


@asynccontextmanager
async def doctor_at(endpoint: str) -> AsyncGenerator[tuple[Doctor, RosConnection]]:
    connection = RosConnection(WireChoice("off", (endpoint,)))
    made = Doctor(connection, lambda: UNANSWERED)
    try:
        yield made, connection
    finally:
        await made.close()
        await connection.close()


async def complete(made: Doctor, code: str = "") -> SystemExamined:
    """Ask until all was asked once, and something was found."""
    async with asyncio.timeout(PATIENCE_S):
        while True:
            found = await made.examine(ExamineSystem(), ME)
            if found.is_complete and (not code or code in codes(found)):
                return found
            await asyncio.sleep(0.02)


async def without(made: Doctor, code: str) -> None:
    """Ask until something is found no more."""
    async with asyncio.timeout(PATIENCE_S):
        while True:
            if code not in codes(await made.examine(ExamineSystem(), ME)):
                return
            await asyncio.sleep(0.02)


def codes(found: SystemExamined) -> set[str]:
    return {one.code for one in found.findings}


def test_without_a_connection_the_place_is_looked_at():
    async def run() -> None:
        async with doctor_at(free_endpoint()) as (made, _):
            found = await made.examine(ExamineSystem(renderer="GPU"), ME)
            assert found.is_complete
            assert {"no-router", "not-answered"} <= codes(found)
            states = {one.subject: one.state for one in found.subjects}
            assert (states["router"], states["nodes"]) == ("found", "not_examined")
            assert states["browser"] == "well"

    asyncio.run(run())


def test_a_connection_is_examined_and_let_go_of(
    endpoint: str, tester: Node, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(doctor, "LISTENS_S", 0.2)

    async def run() -> None:
        async with doctor_at(endpoint) as (made, connection):
            await connection.link()
            with node_at(endpoint, "twin"), node_at(endpoint, "twin"):
                found = await complete(made, "duplicate-name")
            assert found.listened_s >= 0.2
            states = {one.subject: one.state for one in found.subjects}
            assert (states["router"], states["nodes"]) == ("well", "found")
            await made.let_go()
            await connection.disconnect()
            assert "not-connected" in codes(await made.examine(ExamineSystem(), ME))

    assert tester.get_name()
    asyncio.run(run())


def test_parameters_that_changed_before_anybody_asked_are_known_with_their_start(
    endpoint: str, tester: Node, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(doctor, "LISTENS_S", 0.2)

    async def run() -> None:
        async with doctor_at(endpoint) as (made, connection):
            connection.on_change = made.listen
            await connection.link()
            with node_at(endpoint, "tuned") as node:
                seen = partial(node.graph.subscriptions, "/parameter_events")
                await asyncio.to_thread(wait_until, "the studio listens", lambda: bool(seen()))
                node.declare_parameter("gain", 1)
                node.set_parameters([Parameter("gain", value=2)])
                node.declare_parameter("done", 1)
                found = await complete(made, "parameter-changed")
                (told,) = (one for one in found.findings if one.code == "parameter-changed")
                assert told.evidence == ("gain is now 2, and was 1 when it was declared",)
                assert told.sentence.endswith("a restart brings back those.")
            await without(made, "parameter-changed")  # once its end is known
            await made.let_go()
            await connection.disconnect()
            made.listen()
            await connection.link()
            assert "parameter-changed" not in codes(await complete(made))

    assert tester.get_name()
    asyncio.run(run())


def test_many_who_ask_are_told_of_one_look(
    endpoint: str, tester: Node, monkeypatch: pytest.MonkeyPatch
):
    looks: list[object] = []
    looked = doctor._looked  # pyright: ignore[reportPrivateUsage]

    def counted(visit: Any) -> Any:  # noqa: ANN401 - as it is
        looks.append(visit)
        return looked(visit)

    monkeypatch.setattr(doctor, "_looked", counted)
    monkeypatch.setattr(doctor, "_LOOK_EVERY_S", 600.0)

    async def run() -> None:
        async with doctor_at(endpoint) as (made, connection):
            await connection.link()
            made.document_of = {"mine": SeenDocument("mine", "arm", fixed_trouble="No map.")}.get
            asked = [ExamineSystem(document=one) for one in ("mine", "other") * 4]
            found = await asyncio.gather(*(made.examine(one, ME) for one in asked))
            assert len(looks) == 1
            assert ["fixed-frame" in codes(one) for one in found] == [True, False] * 4

    assert tester.get_name()
    asyncio.run(run())


def test_the_document_of_who_asks_is_examined():
    async def run() -> None:
        async with doctor_at(free_endpoint()) as (made, _):
            documents = {"mine": SeenDocument("mine", "arm.xacro", fixed_trouble="No map.")}
            made.document_of = documents.get
            found = await made.examine(ExamineSystem(document="mine"), ME)
            assert "fixed-frame" in codes(found)
            assert "fixed-frame" not in codes(
                await made.examine(ExamineSystem(document="other"), ME)
            )

    asyncio.run(run())


def test_a_member_with_own_nodes_is_told_of_their_system_alone(endpoint: str):
    async def run() -> None:
        choice = WireChoice("off", (endpoint,), 23)
        own = await asyncio.to_thread(WireLink, choice, lambda: None)

        async def own_link(document: str, _person: str) -> WireLink | None:
            return own if document == "copy" else None

        try:
            async with doctor_at(endpoint) as (made, connection):
                await connection.link()
                made.own_link = own_link
                with open_test_session(endpoint, domain=23) as wire:
                    shown = show_hostile_graph(wire, 1)
                    assert await asyncio.to_thread(
                        own.graph.wait_for, lambda: bool(own.graph.publishers("/t0")), 30.0
                    )
                    mine = await made.examine(ExamineSystem(document="copy"), ME)
                    theirs = await made.examine(ExamineSystem(), ME)
                    del shown
                assert "unknown-type" in codes(mine)
                assert "unknown-type" not in codes(theirs)
        finally:
            await asyncio.to_thread(own.close)

    asyncio.run(run())


def test_a_system_that_ended_before_it_was_seen_is_forgotten(endpoint: str):
    async def run() -> None:
        own = await asyncio.to_thread(WireLink, WireChoice("off", (endpoint,), 23), lambda: None)
        await asyncio.to_thread(own.close)

        async def own_link(document: str, _person: str) -> WireLink | None:
            return own if document == "copy" else None

        async with doctor_at(endpoint) as (made, connection):
            link = await connection.link()
            made.own_link = own_link
            with pytest.raises(RouterGoneError):
                await made.examine(ExamineSystem(document="copy"), ME)
            await made.examine(ExamineSystem(), ME)
            assert list(made._visits) == [link]  # pyright: ignore[reportPrivateUsage]

    asyncio.run(run())


@pytest.mark.parametrize(("language", "title"), [("en", "Report of the Doctor"), ("de", "Bericht")])
def test_the_report_is_in_the_language_of_who_asks(language: str, title: str):
    async def run() -> None:
        async with doctor_at(free_endpoint()) as (made, _):
            asked = GetDoctorReport.model_validate({"language": language})
            report = await made.report(asked, ME)
            assert title in report.html
            assert "/go" in report.html

    asyncio.run(run())


def test_everybody_may_ask_and_not_too_often():
    for message in ExamineSystem, GetDoctorReport:
        entry = COMMANDS[message]
        assert entry.permission.role is Role.GUEST
        assert entry.limits.per_second is not None


def show_hostile_graph(wire: WireSession, count: int) -> list[object]:
    """A node that publishes on so many topics, with long names and three wrong things in each."""
    node = NodeToken(wire.domain, wire.zid, wire.next_id(), "/", "hostile" + "x" * 200)
    shown: list[object] = [declare_token(wire.zenoh, str(node))]
    qos = QoSProfile(depth=10)
    for at in range(count):
        name = f"/t{at}" + "/part" * (at % 40)
        # A token takes a millisecond: not each topic has both sides.
        kinds = [(EndpointKind.PUBLISHER, "RIHS01_0"), (EndpointKind.SUBSCRIPTION, "RIHS01_1")]
        for kind, type_hash in kinds if at % 10 == 0 else kinds[:1]:
            token = EndpointToken(
                node, wire.next_id(), kind, name, f"own_{at % 9}/msg/Odd", type_hash, qos
            )
            shown.append(declare_token(wire.zenoh, str(token)))
    return shown


@pytest.mark.sweep
def test_a_graph_of_5000_hostile_topics_holds_nobody_up(endpoint: str):
    """The loop goes on, and what is sent stays within bounds."""

    async def run() -> list[Stall]:
        noticed: list[Stall] = []
        async with doctor_at(endpoint) as (made, connection):
            link = await connection.link()
            with open_test_session(endpoint) as wire:
                shown = show_hostile_graph(wire, 5_000)
                graph, count = link.graph, len(shown)
                assert await asyncio.to_thread(
                    graph.wait_for, lambda: graph.token_count >= count, PATIENCE_S
                )
                await made.examine(ExamineSystem(), ME)  # what it imports is no part of this
                with stalls(0.05, noticed.append):
                    found = await complete(made)
                assert {"hash", "unknown-type"} <= codes(found)
                assert found.more > 5_000
                assert len(found.findings) <= FINDINGS_MAX
                assert len(found.model_dump_json()) < 600_000
        return noticed

    assert [str(one) for one in asyncio.run(run())] == []
