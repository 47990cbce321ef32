"""A studio at a relay whose owner is hostile to it: real Zenoh, a real key, and no rules."""

from __future__ import annotations

import json
from random import Random
from typing import TYPE_CHECKING

import pytest

from studio.documents.engine import COMMANDS
from studio.errors import CommandError
from studio.protocol.roles import Role
from studio.server.commands import parse_command
from studio.server.relays.messages import (
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
    SceneClosed,
    SceneFrame,
    TopicState,
    encode,
)
from studio.server.relays.tickets import TicketIssuer
from tests.support.command_fuzzer import CommandFuzzer
from tests.support.hostile_relay import HostileClass, HostileRelay, hostile_relay
from tests.support.relays import relayed_class, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path


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
    assert {"open_path", "list_folder", "start_class", "add_relay"} <= {*commands_above(role)}
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
            OpenScene(copy, 1, ticket),
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
        hostile, bad.heard_bytes = HostileClass(room, bad), bytearray()
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
            bad.say(OpenLane("rover"), OpenScene("rover", 1), OpenLane("!changes graph"))
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
