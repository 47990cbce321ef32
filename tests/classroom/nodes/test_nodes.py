"""Students' own nodes: real sessions by the lines that were copied, at the router's own process."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any, TypeAlias

import pytest

from studio.classroom import classroom as classroom_module
from studio.classroom.classroom import Classroom, Reach
from studio.classroom.nodes import links as links_module
from studio.classroom.nodes import nodes as nodes_module
from studio.classroom.nodes.nodes import COMMANDS
from studio.documents.engine import Engine
from studio.errors import CommandError, WireError
from studio.protocol.classroom import SetMemberRole
from studio.protocol.roles import Role
from studio.protocol.student_nodes import GetMyGraph, GetNodeAccess, NodeAccess
from studio.ros.messages import message
from studio.settings import Settings
from tests.support.open_documents import Ear
from tests.support.ros2_peer import real_node
from tests.support.student_nodes import STRING, OwnNode, variables
from tests.support.wire import free_endpoint, free_port, show_endpoints

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Awaitable, Callable, Generator
    from pathlib import Path

    from studio.protocol.student_nodes import MyGraph


class Page(Ear):
    """A page of a person."""

    def __init__(self, person: str, role: Role = Role.STUDENT) -> None:
        super().__init__(role)
        self.person = person


ADA, BOB = Page("ada"), Page("bob")


@pytest.fixture(autouse=True)
def _a_port_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:  # pyright: ignore[reportUnusedFunction]
    monkeypatch.setattr(nodes_module, "_PORTS", (free_port(),))


@asynccontextmanager
async def room(file: Path | None = None) -> AsyncGenerator[Classroom]:
    """A class with access for nodes."""
    made = Classroom(file, Reach(("http://robots.example/",), only_here=False))
    try:
        await made.start()
        if made.nodes.record.secret:
            made.nodes.resume()
        else:
            await made.nodes.start()
        await until(lambda: made.nodes.event().state == "on")
        yield made
    finally:
        await made.close()


def run(work: Callable[[Classroom], Awaitable[None]], file: Path | None = None) -> None:
    async def begin() -> None:
        async with room(file) as made:
            await work(made)

    asyncio.run(begin())


async def until(condition: Callable[[], bool]) -> None:
    async with asyncio.timeout(60):
        while not condition():  # noqa: ASYNC110 - nothing tells us when
            await asyncio.sleep(0.01)


async def access(made: Classroom, page: Ear) -> NodeAccess:
    answer = await COMMANDS.carry_out(made.nodes, GetNodeAccess(request=3), page)
    assert isinstance(answer, NodeAccess)
    return answer


async def graph(made: Classroom, page: Ear) -> MyGraph:
    answer: Any = await COMMANDS.carry_out(made.nodes, GetMyGraph(request=4), page)
    return answer


async def seen(made: Classroom, page: Ear, *nodes: str) -> MyGraph:
    """The graph of a person, once it has these nodes and no others."""
    async with asyncio.timeout(60):
        while True:
            found = await graph(made, page)
            if found.nodes == nodes:
                return found
            await asyncio.sleep(0.02)


Starting: TypeAlias = "Callable[[str, str], Awaitable[OwnNode]]"


@pytest.fixture
def own_nodes() -> Generator[Starting]:
    made: list[OwnNode] = []

    async def start(line: str, name: str) -> OwnNode:
        made.append(await asyncio.to_thread(OwnNode, line, name))
        return made[-1]

    yield start
    for one in made:
        one.close()


def test_two_students_each_see_what_they_publish_and_nothing_of_the_other(own_nodes: Starting):
    async def work(made: Classroom) -> None:
        ada, bob = await access(made, ADA), await access(made, BOB)
        assert ada.domain != bob.domain
        await own_nodes(ada.shell, "ada_talks")
        await seen(made, BOB)
        found = await seen(made, ADA, "/ada_talks")
        topic = next(one for one in found.topics if one.name == "/temperature")
        assert (topic.types, topic.publishers, topic.subscriptions) == ((STRING,), 1, 0)
        await own_nodes(bob.shell, "bob_talks")
        await seen(made, BOB, "/bob_talks")
        await seen(made, ADA, "/ada_talks")

    run(work)


def test_a_check_of_a_student_finds_them_green_whose_node_publishes(own_nodes: Starting):
    """By the link that lessons look through: as that of the class, of one domain."""

    async def work(made: Classroom) -> None:
        ada, bob = await access(made, ADA), await access(made, BOB)
        talks = await own_nodes(ada.shell, "talks")
        for_ada, for_bob = await made.nodes.link("ada"), await made.nodes.link("bob")
        assert for_ada is not None
        assert for_bob is not None
        assert await made.nodes.link("ada") is for_ada
        assert (for_ada.domain, for_bob.domain) == (ada.domain, bob.domain)
        await until(lambda: for_ada.publishers("/temperature") == ["/talks"])
        rates = for_ada.measure("/temperature", 60.0)
        said = message(STRING)(data="21")

        def counted() -> bool:
            talks.out.publish(said)
            return rates.flow().rate_hz > 1

        await until(counted)
        rates.close()
        assert for_bob.publishers("/temperature") == []

    run(work)


def test_real_nodes_of_ros_join_by_the_line_and_are_in_their_students_graph_alone():
    """Those of ros2_peer have no TLS: the line is pasted where a router of the student runs."""

    async def work(made: Classroom) -> None:
        ada = await access(made, ADA)
        await access(made, BOB)
        near = free_endpoint()
        router = await asyncio.create_subprocess_exec(
            *(sys.executable, "-m", "studio", "router", "--listen", near, "--join"),
            env={**os.environ, **variables(ada.shell)},
            stdout=asyncio.subprocess.PIPE,
        )
        try:
            assert router.stdout is not None
            assert b"Zenoh router at" in await router.stdout.readline()
            with real_node(
                *(near, "pub", "--topic", "/temperature", "--count", "0"),
                line=f"export ROS_DOMAIN_ID={ada.domain}",
            ) as node:
                await asyncio.to_thread(node.wait_said, "ready")
                found = await seen(made, ADA, "/peer_pub")
                topic = next(one for one in found.topics if one.name == "/temperature")
                assert (topic.types, topic.publishers) == ((STRING,), 1)
                link = await made.nodes.link("ada")
                assert link is not None
                rates = link.measure("/temperature", 60.0)
                await until(lambda: rates.flow().rate_hz > 1)
                rates.close()
                await seen(made, BOB)
        finally:
            router.send_signal(signal.SIGTERM)
            await router.wait()

    run(work)


def test_the_same_person_keeps_their_domain_and_each_line_is_of_one_domain():
    async def work(made: Classroom) -> None:
        ada, again, bob = await access(made, ADA), await access(made, ADA), await access(made, BOB)
        assert again.domain == ada.domain
        assert variables(ada.shell)["ROS_DOMAIN_ID"] == str(ada.domain)
        assert f"$env:ROS_DOMAIN_ID='{ada.domain}'" in ada.powershell
        assert ada.endpoint in ada.shell
        assert ada.endpoint == made.nodes.event().endpoint
        lines = {variables(one.shell)["ZENOH_CONFIG_OVERRIDE"] for one in (ada, bob)}
        assert len(lines) == 2
        assert made.nodes.event().given == 2

    run(work)


def test_the_line_names_the_address_by_which_others_find_this_machine():
    async def work() -> None:
        reach = Reach(("http://robots.example/",), only_here=False, host="robots.example")
        made = Classroom(None, reach)
        try:
            await made.nodes.start()
            given = await access(made, ADA)
            assert given.endpoint.startswith("tls/robots.example:")
            assert f'connect/endpoints=["{given.endpoint}"]' in given.shell
        finally:
            await made.close()

    asyncio.run(work())


def test_when_all_domains_are_given_out_a_sentence_says_so():
    async def work(made: Classroom) -> None:
        given = [(await access(made, Page(f"person {n}"))).domain for n in range(60)]
        assert len({*given}) == 60
        assert made.nodes.event().given == made.nodes.event().limit == 60
        with pytest.raises(CommandError, match="All 60 domains are given out: share one"):
            await access(made, Page("one more"))

    run(work)


def test_who_is_sent_out_is_cut_off_and_the_others_come_back(own_nodes: Starting):
    async def work(made: Classroom) -> None:
        members = [await made.join(name, made.admission.code, "", "") for name in ("Ada", "Bob")]
        ada, bob = (Page(one.person) for one in members)
        lines = [(await access(made, one)).shell for one in (ada, bob)]
        for line, name in zip(lines, ("ada_talks", "bob_talks"), strict=True):
            await own_nodes(line, name)
        await seen(made, ada, "/ada_talks")
        await seen(made, bob, "/bob_talks")
        await made.remove(ada.person)
        await seen(made, bob, "/bob_talks")
        assert await made.nodes.link(ada.person) is None
        again, other = [await own_nodes(lines[0], name) for name in ("again", "other")]
        await own_nodes(lines[1], "bob_listens")
        await seen(made, bob, "/bob_listens", "/bob_talks")
        for one, name in ((again, "/again"), (other, "/other")):
            await until(lambda one=one: bool(one.context.graph.nodes()))
            assert [found.path for found in one.context.graph.nodes()] == [name]
        await made.readmit(ada.person)
        assert variables((await access(made, ada)).shell) != variables(lines[0])
        assert made.nodes.event().given == 3

    run(work)


def test_a_full_class_keeps_the_place_of_who_has_nodes(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(classroom_module, "MEMBERS_MAX", 2)

    async def work(made: Classroom) -> None:
        ada, bob = [await made.join(name, made.admission.code, "", "") for name in ("Ada", "Bob")]
        await access(made, Page(ada.person))
        await made.join("Eve", made.admission.code, "", "")
        assert made.members.find(ada.person) is ada
        assert made.members.find(bob.person) is None

    run(work)


def test_who_becomes_a_guest_is_cut_off():
    async def work(made: Classroom) -> None:
        ada = await made.join("Ada", made.admission.code, "", "")
        await access(made, Page(ada.person))
        await made.set_role(SetMemberRole(person=ada.person, role="guest"))
        assert await made.nodes.link(ada.person) is None

    run(work)


def test_the_end_of_the_class_switches_access_off(own_nodes: Starting):
    async def work(made: Classroom) -> None:
        line = (await access(made, ADA)).shell
        assert await made.nodes.link("ada") is not None
        await made.end()
        assert made.nodes.event().state == "off"
        assert not made.nodes.record.secret
        assert await made.nodes.link("ada") is None
        with pytest.raises(CommandError, match="ask the presenter to switch their access on"):
            await access(made, ADA)
        with pytest.raises(WireError):
            await own_nodes(line, "late")
        await made.nodes.start()
        assert (await access(made, ADA)).shell != line

    run(work)


def test_who_makes_all_join_again_switches_access_off():
    async def work(made: Classroom) -> None:
        await access(made, ADA)
        await made.log_out()
        assert made.nodes.event().state == "off"

    run(work)


def test_a_studio_that_was_killed_goes_on_with_the_lines_that_were_copied(
    own_nodes: Starting, tmp_path: Path
):
    file = tmp_path / "class.json"
    lines: list[str] = []

    async def copy(made: Classroom) -> None:
        lines.append((await access(made, ADA)).shell)

    async def go_on(made: Classroom) -> None:
        await own_nodes(lines[0], "ada_talks")
        await seen(made, ADA, "/ada_talks")
        assert variables((await access(made, BOB)).shell) != variables(lines[0])

    run(copy, file)
    assert file.stat().st_mode & 0o077 == 0
    run(go_on, file)


def test_a_studio_that_starts_goes_on_with_the_access_of_before(tmp_path: Path):
    async def work() -> None:
        file = tmp_path / "class-1.json"
        before = Classroom(file, Reach(("http://robots.example/",)))
        await before.nodes.start()
        await access(before, ADA)
        await before.close()
        made = Engine(Settings(data_folder=tmp_path), Classroom(file))
        try:
            await made.start()
            await until(lambda: made.classroom.nodes.event().state == "on")
            assert made.classroom.nodes.event().given == 1
        finally:
            await made.close()

    asyncio.run(work())


def test_when_the_router_dies_it_is_started_again_and_nodes_come_back(
    own_nodes: Starting, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(nodes_module, "_LOOK_EVERY_S", 0.05)

    async def work(made: Classroom) -> None:
        await own_nodes((await access(made, ADA)).shell, "ada_talks")
        await seen(made, ADA, "/ada_talks")
        pid = made.nodes.router_pid
        assert pid is not None
        os.kill(pid, signal.SIGKILL)
        await until(lambda: made.nodes.router_pid not in {pid, None})
        await until(lambda: made.nodes.event().state == "on")
        await seen(made, ADA, "/ada_talks")

    run(work)


def test_a_link_that_nobody_asks_for_is_closed(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(links_module, "_LOOK_EVERY_S", 0.05)

    async def work(made: Classroom) -> None:
        await access(made, ADA)
        first = await made.nodes.link("ada")
        with monkeypatch.context() as sooner:
            sooner.setattr(links_module, "IDLE_S", 0.0)
            await until(lambda: made.nodes.link_count == 0)
        assert await made.nodes.link("ada") is not first

    run(work)


def test_a_domain_with_thousands_of_endpoints_is_not_looked_into(
    own_nodes: Starting, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(links_module, "TOKENS_MAX", 300)
    monkeypatch.setattr(links_module, "CROWDED_S", 0.2)

    async def work(made: Classroom) -> None:
        ada = await own_nodes((await access(made, ADA)).shell, "ada_talks")
        await seen(made, ADA, "/ada_talks")
        many = show_endpoints(ada.context.wire, 400)
        await until(lambda: made.nodes.link_count == 0)
        with pytest.raises(CommandError, match="has more than 300 nodes and endpoints: end some"):
            await graph(made, ADA)
        with pytest.raises(CommandError, match="has more than 300 nodes and endpoints: end some"):
            await made.nodes.link("ada")
        for one in many:
            one.undeclare()

        async def again() -> bool:
            try:
                return (await graph(made, ADA)).nodes == ("/ada_talks",)
            except CommandError:
                return False

        async with asyncio.timeout(60):
            while not await again():  # noqa: ASYNC110 - nothing tells us when
                await asyncio.sleep(0.02)

    run(work)


def test_pages_are_told_whether_nodes_may_join():
    async def work(made: Classroom) -> None:
        page = Page("ada")
        made.attach(page)
        assert page.last("student_nodes")["state"] == "on"
        await access(made, page)
        await until(lambda: page.last("student_nodes")["given"] == 1)
        await made.nodes.stop()
        await until(lambda: page.last("student_nodes")["state"] == "off")
        assert page.last("student_nodes")["endpoint"] == ""

    run(work)


def test_without_a_free_port_it_says_why(monkeypatch: pytest.MonkeyPatch):
    async def work(made: Classroom) -> None:
        other = Classroom(None, Reach(("http://robots.example/",)))
        try:
            with pytest.raises(CommandError, match="another program listens there"):
                await other.nodes.start()
            assert other.nodes.event().state == "failed"
            assert "another program" in other.nodes.event().trouble
            await made.nodes.stop()
            await other.nodes.start()
            assert other.nodes.event().state == "on"
        finally:
            await other.close()

    run(work)
