"""A studio at a relay whose owner is hostile to it: real Zenoh, a real key, and no rules."""

from __future__ import annotations

import json
import logging
import threading
import time
from contextlib import ExitStack, contextmanager
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.documents.engine import COMMANDS
from studio.errors import CommandError
from studio.protocol.roles import Role
from studio.server.commands import parse_command
from studio.server.relays.messages import (
    Arrive,
    Ask,
    AskDownload,
    AskJoin,
    AskTopic,
    Downloaded,
    Joined,
    LaneClosed,
    LaneSnapshot,
    Leave,
    OpenLane,
    OpenScene,
    Ping,
    Pong,
    Refresh,
    Say,
    SceneClosed,
    SceneFrame,
    Settled,
    Taken,
    TopicState,
    Up,
    Viewers,
    WantBlobs,
    encode,
)
from studio.server.relays.tickets import TicketIssuer
from tests.support.command_fuzzer import CommandFuzzer
from tests.support.hostile_relay import HostileRelay, hostile_relay
from tests.support.loop_watch import Stall, stalls
from tests.support.relays import RelayedClass, relayed_class, served_relay, wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

STALL_S = 0.25
GROWTH_BYTES = 400 << 20
"""The flood is made in this process, too."""


class HostileClass:
    """A class at a hostile relay, and what its relay can do there."""

    def __init__(self, room: RelayedClass, relay: HostileRelay) -> None:
        self.room, self.relay = room, relay

    @property
    def classroom(self):
        return self.room.served.classroom

    def ticket(self, name: str) -> str:
        """Of somebody who joined at the relay."""
        return self.relay.join(name, self.classroom.admission.code)

    def person(self, name: str) -> str:
        return next(one.person for one in self.classroom.members if one.name == name)

    def page(self, ticket: str) -> int:
        """The number of a page that has arrived."""
        page = self.relay.number()
        self.relay.say(Arrive(page, ticket))
        return page

    def ask(self, page: int, kind: str, **fields: Any) -> dict[str, Any]:
        """What a command of a page is answered."""
        return self.ask_text(page, json.dumps({"type": kind, "request": 1, **fields}).encode())

    def ask_text(self, page: int, text: bytes) -> dict[str, Any]:
        since, number = len(self.relay.heard), self.relay.number()
        self.relay.say(Ask(page, number, text))
        self.relay.until(Settled, lambda one: one.number == number, since)
        said = [one for one in self.relay.heard[since:] if isinstance(one, Say)]
        events = [json.loads(one.frame.data) for one in said if not one.frame.binary]
        return next(one for one in reversed(events) if one["type"] in {"done", "refused"})

    def answers(self) -> None:
        """Wait until all that was said before was taken."""
        number = self.relay.number()
        self.relay.say(Ping(number))
        self.relay.until(Pong, lambda one: one.sent_ns == number)

    def copy_of(self, name: str) -> tuple[int, str, str]:
        """A page, its ticket, and the copy that its person has made."""
        ticket = self.ticket(name)
        page = self.page(ticket)
        assert self.ask(page, "open_copy", document="rover")["type"] == "done"
        return page, ticket, f"rover~{self.person(name)}"


@pytest.fixture(scope="module")
def relay() -> Generator[HostileRelay]:
    with hostile_relay() as made:
        yield made


@pytest.fixture(scope="module")
def shared(
    relay: HostileRelay, tmp_path_factory: pytest.TempPathFactory
) -> Generator[HostileClass]:
    with relayed_class(tmp_path_factory.mktemp("class"), [relay.line]) as room:
        yield HostileClass(room, relay)


@pytest.fixture
def hostile(shared: HostileClass, relay: HostileRelay) -> HostileClass:
    relay.confirms = "honestly"
    wait_until(lambda: shared.room.uplink().state == "there", "the line")
    shared.answers()
    return shared


# Tickets


def forged(hostile: HostileClass, what: str) -> str:
    """A ticket that the origin did not make, or that is not valid any more."""
    good = hostile.ticket("Ada")
    seed, room = b"s" * 32, hostile.room.origin.identity.id
    person = hostile.person("Ada")
    match what:
        case "of a presenter":
            return TicketIssuer(seed, room).issue("token-presenter", "Teacher", "presenter")
        case "of the relay's own making":
            return TicketIssuer(seed, room).issue(person, "Ada", "student")
        case "of another room":
            key = hostile.classroom.members.key
            return TicketIssuer(key, "another").issue(person, "Ada", "student")
        case "changed":
            return good[:-4] + ("AAAA" if good[-4:] != "AAAA" else "BBBB")
        case _:
            return what


@pytest.mark.parametrize(
    "what",
    ["of a presenter", "of the relay's own making", "of another room", "changed", "x" * 400, "é~"],
)
def test_nobody_arrives_by_a_ticket_that_the_origin_did_not_make(hostile: HostileClass, what: str):
    page = hostile.page(forged(hostile, what))
    assert "not in this class" in hostile.ask(page, "raise_hand", raised=True)["reason"]
    assert not any(one.hand_s for one in hostile.classroom.members)


def test_who_was_sent_out_is_nobody_though_the_relay_keeps_their_page(hostile: HostileClass):
    ticket = hostile.ticket("Bob")
    page, person = hostile.page(ticket), hostile.person("Bob")
    assert hostile.ask(page, "raise_hand", raised=True)["type"] == "done"
    served = hostile.room.served
    served.run(hostile.classroom.remove(person))
    served.look(lambda: hostile.room.origin.end_person(person))
    assert hostile.ask(page, "raise_hand", raised=True)["type"] == "refused"
    assert hostile.ask(hostile.page(ticket), "raise_hand", raised=True)["type"] == "refused"
    assert not served.look(lambda: hostile.classroom.is_here(person))


def test_after_a_log_out_all_tickets_pages_and_copies_of_before_are_worth_nothing(
    hostile: HostileClass,
):
    page, ticket, copy = hostile.copy_of("Cleo")
    hostile.relay.say(OpenLane(copy, ticket))
    hostile.relay.until(LaneSnapshot, lambda one: one.lane == copy)
    since = len(hostile.relay.heard)
    hostile.room.served.run(hostile.classroom.log_out())
    assert hostile.ask(page, "raise_hand", raised=True)["type"] == "refused"
    assert hostile.ask(hostile.page(ticket), "raise_hand", raised=True)["type"] == "refused"
    hostile.relay.until(LaneClosed, lambda one: one.lane == copy, since)
    assert hostile.person("Cleo")  # as a member she is kept


# Commands


def commands_above(role: Role) -> dict[str, bytes]:
    """A well-formed command of every kind that this role may not send, by name."""
    fuzzer, made = CommandFuzzer(Random(7), {}), dict[str, bytes]()
    wanted = {one.permission.name for one in COMMANDS if not role.includes(one.permission.role)}
    for _ in range(40_000):
        text = json.dumps(fuzzer.command(1)).encode()
        name = json.loads(text)["type"]
        if name not in wanted or name in made:
            continue
        try:
            parse_command(text)
        except CommandError:
            continue
        made[name] = text
    assert wanted - made.keys() <= {"open_link"}, wanted - made.keys()
    return made


@pytest.mark.parametrize("role", [Role.STUDENT, Role.HELPER])
def test_no_page_does_what_only_more_than_its_person_may(hostile: HostileClass, role: Role):
    name = f"Dora {role}"
    page = hostile.page(hostile.ticket(name))
    member = hostile.classroom.members.get(hostile.person(name))
    hostile.room.served.look(lambda: setattr(member, "role", role))
    executed = list[str]()
    for kind, text in commands_above(role).items():
        refused = hostile.ask_text(page, text)
        if refused["kind"] not in {"NotAllowedError", "UnknownDocumentError"}:
            executed.append(f"{kind}: {refused}")
    assert hostile.ask(page, "save", document="rover")["kind"] == "NotInControlError"
    assert {"open_path", "list_folder", "start_class", "add_relay"} <= {
        *commands_above(role)
    }
    assert not executed
    for fields in ({"type": "set_member_role", "person": member.person, "role": "helper"},):
        assert hostile.ask_text(page, json.dumps(fields).encode())["kind"] == "NotAllowedError"


@pytest.mark.parametrize("what", ["package", "urdf", "copies", "../urdf", "{}", ""])
def test_no_file_is_given_out_by_a_relay(hostile: HostileClass, what: str):
    number = hostile.relay.number()
    hostile.relay.say(AskDownload(number, hostile.ticket("Eve"), "rover", what))
    assert hostile.relay.until(Downloaded, lambda one: one.number == number).kind


def test_a_copy_is_shown_to_nobody_elses_ticket(hostile: HostileClass):
    _, _, copy = hostile.copy_of("Fay")
    other = hostile.ticket("Gil")
    subscribe = {
        "type": "subscribe",
        "subscription": 4,
        "topic": "/joint_states",
        "document": copy,
        "mode": "newest",
    }
    for ticket in ("", other):
        since, number = len(hostile.relay.heard), hostile.relay.number()
        hostile.relay.say(
            OpenLane(copy, ticket),
            OpenScene(copy, ticket),
            AskTopic(json.dumps(subscribe).encode(), ticket),
            AskDownload(number, ticket or other, copy, "page"),
        )
        hostile.relay.until(LaneClosed, lambda one: one.lane == copy, since)
        hostile.relay.until(SceneClosed, lambda one: one.document == copy, since)
        state = hostile.relay.until(TopicState, since=since)
        assert json.loads(state.text)["type"] == "not_subscribed"
        found = hostile.relay.until(Downloaded, lambda one, n=number: one.number == n, since)
        assert found.kind
        told = hostile.relay.heard[since:]
        assert not any(isinstance(one, LaneSnapshot) and one.lane == copy for one in told)
        assert not any(isinstance(one, SceneFrame) and one.document == copy for one in told)


def test_a_page_that_never_arrived_or_has_left_is_nobody(hostile: HostileClass):
    page = hostile.page(hostile.ticket("Hal"))
    assert hostile.ask(hostile.relay.number(), "raise_hand", raised=True)["type"] == "refused"
    hostile.relay.say(Leave(page))
    assert hostile.ask(page, "raise_hand", raised=True)["type"] == "refused"


# Replays


def test_what_was_sent_before_runs_once_however_often_it_is_sent_again(
    hostile: HostileClass, monkeypatch: pytest.MonkeyPatch
):
    names = list[str]()
    rename = hostile.classroom.rename

    async def counted(person: str, name: str) -> None:
        names.append(name)
        await rename(person, name)

    monkeypatch.setattr(hostile.classroom, "rename", counted)
    line, relay = hostile.relay.now, hostile.relay
    page = hostile.page(hostile.ticket("Ida"))
    text = json.dumps({"type": "set_name", "request": 1, "name": "Ivy", "id": "one"}).encode()
    sealed = line.seal(encode(Ask(page, relay.number(), text)))
    for _ in range(20):
        line.put(sealed)
    hostile.answers()
    uplink = hostile.room.uplink()
    assert uplink.line is not None
    assert uplink.line.refused >= 19
    for _ in range(20):  # the same command, in messages of their own
        assert hostile.ask_text(page, text)["type"] == "done"
    assert names == ["Ivy"]


def test_messages_that_come_in_another_order_end_the_line(hostile: HostileClass):
    line, lines = hostile.relay.now, len(hostile.relay.lines)
    first, second = line.seal(encode(Ping(1))), line.seal(encode(Ping(2)))
    line.put([*second, *first])
    hostile.relay.until_line(lines)


# Floods


def rss_bytes() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


@contextmanager
def goes_on(hostile: HostileClass) -> Generator[None]:
    """The presenter's page is answered all the while, and the loop and memory stay within bounds."""
    served, found, before = hostile.room.served, list[Stall](), rss_bytes()
    with served.presenting() as presenter, ExitStack() as watch:
        served.look(lambda: watch.enter_context(stalls(STALL_S, found.append)))
        ended, answered, worst_s = threading.Event(), [0], [0.0]

        def ask() -> None:
            while not ended.is_set():
                began_s = time.monotonic()
                assert presenter.ask("watch", document="rover")["type"] in {"done", "refused"}
                worst_s[0] = max(worst_s[0], time.monotonic() - began_s)
                answered[0] += 1
                time.sleep(0.1)

        asking = threading.Thread(target=ask)
        asking.start()
        try:
            yield
        finally:
            ended.set()
            asking.join()
            served.look(watch.close)
    print(f"answered {answered[0]}, worst {worst_s[0]:.2f} s, {(rss_bytes() - before) >> 20} MiB")
    ours = [one for one in found if "hostile" not in one.what]
    assert not ours, "\n".join(map(str, ours))
    assert answered[0] > 0
    assert rss_bytes() - before < GROWTH_BYTES


def flood_of(kind: str, hostile: HostileClass) -> Callable[[int], Up]:
    ticket = hostile.ticket("Jim")
    page = hostile.page(ticket)
    text = b'{"type":"get_urdf","document":"rover","request":1}'
    return {
        "ping": lambda n: Ping(n),
        "ask": lambda n: Ask(page, n, text),
        "no page": lambda n: Ask(n + (1 << 40), n, text),
        "join": lambda n: AskJoin(n, f"K{n}", "WRONG1", "", ""),
        "arrive": lambda n: Arrive(n + (1 << 41), "x" * 300),
        "arrive and leave": lambda n: Arrive(n, ticket) if n % 2 else Leave(n - 1),
        "lane": lambda n: OpenLane("rover" if n % 2 else ""),
        "lanes": lambda n: OpenLane(f"no{n % 600}"),
        "scene": lambda n: OpenScene("rover"),
        "refresh": lambda n: Refresh(""),
        "topic": lambda n: AskTopic(b"{"),
        "download": lambda n: AskDownload(n, ticket, "rover", "page"),
        "viewers": lambda n: Viewers(n % 50, n % 7),
    }[kind]  # fmt: skip


FLOODS = (
    *("ping", "ask", "no page", "join", "arrive", "arrive and leave", "lane", "lanes", "scene"),
    *("refresh", "topic", "download", "viewers"),
)


def flood(hostile: HostileClass, make: Callable[[int], Up], count: int) -> None:
    lines = len(hostile.relay.lines)
    for _ in range(count):
        if len(hostile.relay.lines) > lines:  # the origin has had enough, and dialled again
            return
        hostile.relay.say(make(hostile.relay.number()))


@pytest.mark.parametrize("kind", FLOODS)
def test_a_flood_of_messages_leaves_the_presenter_and_the_loop_alone(
    hostile: HostileClass, kind: str
):
    make = flood_of(kind, hostile)
    with goes_on(hostile):
        flood(hostile, make, 300)


@pytest.mark.sweep
@pytest.mark.parametrize("kind", FLOODS)
def test_a_flood_of_a_hundred_thousand_messages_does_neither(hostile: HostileClass, kind: str):
    make = flood_of(kind, hostile)
    with goes_on(hostile):
        flood(hostile, make, 100_000)


@pytest.mark.parametrize("mb", [5, pytest.param(64, marks=pytest.mark.sweep)])
def test_a_message_larger_than_a_relay_has_reason_for_is_not_even_joined(
    hostile: HostileClass, mb: int
):
    with goes_on(hostile):
        for _ in range(4):
            hostile.relay.raw(bytes((mb << 20) - 64))
        hostile.answers()
    line = hostile.room.uplink().line
    assert line is not None
    assert line.refused >= 4


def test_another_relay_goes_on_while_one_floods(tmp_path: Path):
    with hostile_relay() as bad, served_relay() as good:
        with relayed_class(tmp_path, [bad.line, good.line]) as room:
            hostile = HostileClass(room, bad)
            endpoint = good.line.partition("#")[0]
            with room.student("Lea", endpoint) as lea, lea.lane() as lane:
                lane.ask("watch", document="rover")
                flood(hostile, flood_of("ask", hostile), 500)
                assert lane.ask("raise_hand", raised=True)["type"] == "done"
                bad.raw(b"nonsense")
                assert lane.ask("raise_hand", raised=False)["type"] == "done"
            assert room.uplink(endpoint).state == "there"


# Lies about what came


@pytest.mark.parametrize("confirms", ["never", "everything"])
def test_lies_about_what_came_cost_the_origin_a_bounded_memory(
    hostile: HostileClass, confirms: Any
):
    hostile.relay.confirms = confirms
    lines = len(hostile.relay.lines)
    with goes_on(hostile):
        for number in range(60):
            hostile.relay.say(OpenLane("rover"), OpenScene("rover"), Ping(number))
            if len(hostile.relay.lines) > lines:
                break
            if confirms == "everything":
                hostile.relay.now.confirm((1 << 64) - 1)
        line = hostile.room.uplink().line
        if line is not None:
            assert line.confirmed_bytes <= line.sent_bytes


def test_a_relay_that_confirms_nothing_is_given_up(hostile: HostileClass):
    hostile.relay.confirms, lines = "never", len(hostile.relay.lines)
    pings = [encode(Ping(1))] * 1000
    end_s = time.monotonic() + 60
    with goes_on(hostile):
        while len(hostile.relay.lines) == lines:
            assert time.monotonic() < end_s
            for one in pings[:1000]:
                hostile.relay.raw(one)
            line = hostile.room.uplink().line
            if line is not None and line.lag_s > 1:
                break
        assert line is None or line.pending_bytes() >= 0


# What is no message


def struct_of(kind: type) -> st.SearchStrategy[Any]:
    fields = msgspec.structs.fields(kind)
    return st.tuples(*(_ANY for _ in fields)).map(lambda given: [kind.__name__, *given])


_LEAF = (
    st.none() | st.booleans() | st.integers(-(1 << 63), (1 << 64) - 1) | st.floats()
    | st.text(max_size=20) | st.binary(max_size=20)
    | st.sampled_from(["", "rover", "rover~x", "!changes graph", "!operations goals", "!changes x"])
)  # fmt: skip
_ANY = st.recursive(_LEAF, lambda inner: st.lists(inner, max_size=3), max_leaves=6)
_KINDS: tuple[type, ...] = (
    *(OpenLane, Refresh, OpenScene, WantBlobs, Arrive, Leave, Viewers, Ask, AskJoin, AskTopic),
    *(AskDownload, Ping, Taken),
)


def well_formed() -> st.SearchStrategy[Up]:
    """Messages whose fields are of their kinds, and of no sense; none that ends it for good."""
    name = st.sampled_from(["", "rover", "rover~x", "~", "!changes graph", "!changes ", "\0", "é"])
    ticket = st.just("") | st.text(max_size=30)
    number = st.integers(0, 1 << 60)
    options = st.lists(st.tuples(st.text(max_size=9), st.text(max_size=9)), max_size=3).map(tuple)
    text = st.binary(max_size=40) | st.just(b'{"type":"subscribe","subscription":1,"topic":"/a"}')
    return st.one_of(
        st.builds(OpenLane, name, ticket),
        st.builds(OpenScene, name, ticket),
        st.builds(Refresh, name),
        st.builds(WantBlobs, name, st.lists(st.binary(max_size=20), max_size=3).map(tuple)),
        st.builds(Arrive, number, ticket),
        st.builds(Leave, number),
        st.builds(Ask, number, number, text),
        st.builds(AskJoin, number, ticket, ticket, ticket, ticket),
        st.builds(AskTopic, text, ticket),
        st.builds(
            AskDownload, number, ticket, name, st.sampled_from(["page", "series", "x"]), options
        ),
        st.builds(Ping, number),
        st.builds(Viewers, st.integers(0, 9), st.integers(0, 9)),
    )


@given(st.binary(max_size=200) | st.sampled_from(_KINDS[:-1]).flatmap(struct_of) | well_formed())
def send_any(hostile: HostileClass, made: Any) -> None:
    lines = len(hostile.relay.lines)
    uplink = hostile.room.uplink()
    data = made if isinstance(made, bytes) else msgspec.msgpack.encode(made)
    hostile.relay.raw(data)
    number = hostile.relay.number()
    hostile.relay.say(Ping(number))

    def is_over() -> bool:
        ended = len(hostile.relay.lines) > lines and uplink.state == "there"
        return ended or any(
            isinstance(one, Pong) and one.sent_ns == number for one in hostile.relay.heard[-50:]
        )

    wait_until(is_over, "an answer, or another line")


def test_whatever_a_relay_sends_is_ignored_or_ends_the_line(
    hostile: HostileClass, caplog: pytest.LogCaptureFixture
):
    with caplog.at_level(logging.ERROR):
        send_any(hostile)
    assert not [one for one in caplog.records if one.levelno >= logging.ERROR]
    assert hostile.room.uplink().state in {"there", "lost"}


# Addresses, and secrets


@pytest.mark.parametrize(
    "answers",
    [
        {"address": "javascript:alert(1)//"},
        {"address": "https://a.example/\x1b[2J"},
        {"address": "https://a.example/x;script-src *"},
        {"address": "https://a.example/" + "x" * 4000},
        {"line": "*"},
        {"line": "a/**"},
    ],
)
def test_a_relay_whose_answer_names_no_page_or_no_line_is_not_used(
    tmp_path: Path, answers: dict[str, str], shared: HostileClass
):
    del tmp_path
    with hostile_relay() as bad:
        bad.answers = answers
        served, origin = shared.room.served, shared.room.origin
        served.run(origin.dial(bad.line))
        uplink = shared.room.uplink(bad.endpoint)
        wait_until(lambda: "names no line" in uplink.reason, "the reason")
        assert not uplink.address
        served.run(origin.remove(bad.endpoint))


def test_a_claim_names_the_relay_that_it_is_for(hostile: HostileClass):
    with hostile_relay() as other:
        served, origin = hostile.room.served, hostile.room.origin
        served.run(origin.dial(other.line))
        wait_until(lambda: other.claims, "the claim")
        assert other.claims[0].relay != hostile.relay.claims[0].relay
        served.run(origin.remove(other.endpoint))


def test_nothing_that_a_relay_is_sent_holds_a_secret_of_the_studio(tmp_path: Path):
    with hostile_relay() as bad, relayed_class(tmp_path, [bad.line]) as room:
        hostile = HostileClass(room, bad)
        served, classroom = room.served, room.served.classroom
        served.run(classroom.admission.set_password("pass-word-of-the-class"))
        with served.presenting() as presenter:
            lines = len(bad.lines)
            assert presenter.ask("add_relay", line=bad.line)["type"] == "done"
            bad.until_line(lines)
            wait_until(lambda: room.uplink().state == "there", "the line")
            number = bad.number()
            bad.say(AskJoin(number, "Mia", classroom.admission.code, "pass-word-of-the-class", ""))
            ticket = bad.until(Joined, lambda one: one.number == number).ticket
            bad.say(OpenLane("rover"), OpenScene("rover"), OpenLane("!changes graph"))
            page = hostile.page(ticket)
            member = classroom.members.get(hostile.person("Mia"))
            served.look(lambda: setattr(member, "role", Role.HELPER))
            helped = hostile.page(ticket)
            for one in (page, helped):
                hostile.ask(one, "raise_hand", raised=True)
                hostile.ask(one, "get_urdf", document="rover")
                hostile.ask(one, "open_copy", document="rover")
            presenter.ask("edit_site", document="rover", site=served.site("base_length"), text="1")
            bad.until(LaneSnapshot, lambda one: one.lane == "rover")
            bad.until(SceneFrame)
            hostile.answers()
        key = classroom.members.key
        secrets = {
            "token": served.url.partition("token=")[2].encode(),
            "key of cookies": key.hex().encode(),
            "key of cookies, raw": key,
            "a member's cookie": classroom.members.cookie_of(member).partition(".")[2].encode(),
            "password": b"pass-word-of-the-class",
            "its hash": classroom.admission.password.encode(),
            "seed of the room": classroom.room_seed.encode(),
            "seed of the room, raw": bytes.fromhex(classroom.room_seed),
            "key of the relay": bad.line.partition("#")[2].encode(),
            "the relays": b'"type":"relays"',
            "folder": str(tmp_path / "data").encode(),
        }
        heard = bytes(bad.heard_bytes)
        assert [name for name, one in secrets.items() if one in heard] == []
        assert len(heard) > 10_000
