"""A relay among people who are hostile to it: students at its page, and studios with its key."""

from __future__ import annotations

import json
import threading
import time
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from websockets.exceptions import ConnectionClosed, InvalidStatus

from studio.ros.wire.zenoh import (
    ReadingThread,
    declare_queryable,
    declare_stream,
    declare_subscription,
    declare_token,
)
from studio.server.relays import relayed_lanes as lanes_module
from studio.server.relays import room as room_module
from studio.server.relays.messages import (
    Blob,
    Down,
    Downloaded,
    EndPerson,
    Frame,
    Joined,
    LaneClosed,
    LaneFrame,
    LaneSnapshot,
    Pong,
    RoomState,
    Say,
    SceneClosed,
    SceneFrame,
    Settled,
    TopicState,
    TopicTick,
)
from studio.server.relays.sealing import Handshake
from studio.server.relays.tickets import RoomIdentity, TicketIssuer
from studio.server.relays.wire import CLAIM_KEY, line_keys
from tests.support.classmates import Classmate
from tests.support.hostile_origin import HostileOrigin, hostile_origin
from tests.support.relays import RelayedClass, ServedRelay, relayed_class, served_relay, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from tests.support.classmates import Lane


@pytest.fixture(scope="module")
def relay() -> Generator[ServedRelay]:
    with served_relay() as made:
        yield made


@pytest.fixture(scope="module")
def room(relay: ServedRelay, tmp_path_factory: pytest.TempPathFactory) -> Generator[RelayedClass]:
    with relayed_class(tmp_path_factory.mktemp("class"), [relay.line]) as made:
        yield made


@pytest.fixture(scope="module")
def ada(room: RelayedClass) -> Generator[Lane]:
    """A student's page, which is to go on through all of this."""
    with room.student("Ada") as ada, ada.lane() as lane:
        lane.ask("watch", document="rover")
        yield lane


@pytest.fixture
def relayed(room: RelayedClass, relay: ServedRelay) -> tuple[RelayedClass, ServedRelay]:
    return room, relay


@pytest.fixture
def origin(relay: ServedRelay) -> Generator[HostileOrigin]:
    with hostile_origin(relay.line) as made:
        yield made


def goes_on(ada: Lane) -> None:
    """The student is still answered by the studio, over the line of before."""
    answer = ada.ask("raise_hand", raised=True)
    # Also that she asks too often is the studio's answer.
    assert answer["type"] == "done" or "times per second" in answer["reason"], answer


# Students


@pytest.mark.parametrize(
    "text",
    [
        "", "nonsense", "[]", '{"type":"watch","document":"' + "x" * 5000 + '"}', "[" * 50_000,
        '{"type":"watch","document":"rover~somebody"}', '{"type":"watch","document":"!changes x"}',
        '{"type":"watch","document":""}', '{"type":"save","document":"rover","request":1}',
        '{"type":"add_relay","line":"tls/a:1#x"}', b"\xff\xfe",
    ],
)  # fmt: skip
def test_what_a_student_may_not_say_is_refused_and_the_line_stays(
    room: RelayedClass, ada: Lane, text: str | bytes
):
    uplink = room.uplink()
    line = uplink.line
    with room.student("Eva") as eva, eva.websocket("/control") as lane:
        lane.send(text)
        while json.loads(lane.recv(timeout=30)).get("type") != "refused":
            pass
    goes_on(ada)
    assert uplink.line is line


@pytest.mark.parametrize("given", ["x" * 6000, "x.y", "A" * 400, ""])
def test_a_forged_ticket_opens_nothing_and_a_long_one_cuts_no_line(
    room: RelayedClass, ada: Lane, given: str
):
    line = room.uplink().line
    stranger = Classmate(room.address())
    try:
        name = f"studio-{stranger.origin.rpartition(':')[2]}-member"
        stranger.client.headers["cookie"] = f"{name}={given}"
        assert stranger.client.get("/", follow_redirects=False).status_code in {303, 403}
        headers = {"accept": "application/json"}
        assert stranger.client.get("/api/documents", headers=headers).status_code == 403
        refused = stranger.client.post("/api/commands", content=b"{}", headers=headers)
        assert refused.status_code == 403
        for path in ("/control", "/data", "/d/rover/viser"):
            with pytest.raises(InvalidStatus):
                stranger.websocket(path)
        stranger.join("Fritz", "WRONG1")
    finally:
        stranger.close()
    goes_on(ada)
    assert room.uplink().line is line


def test_the_ticket_of_another_room_is_no_pass(
    room: RelayedClass, origin: HostileOrigin, ada: Lane
):
    origin.open()
    person = ada.newest("you")["person"]
    for issuer in (
        origin.issuer,
        TicketIssuer(b"t" * 32, room.origin.identity.id),
    ):
        stranger = Classmate(room.address())
        try:
            ticket = issuer.issue(person, "Ada", "helper")
            answer = stranger.client.get(f"/join?pass={ticket}", follow_redirects=False)
            assert answer.headers["location"].endswith("/join")
            headers = {"accept": "application/json"}
            assert stranger.client.get("/api/documents", headers=headers).status_code == 403
        finally:
            stranger.close()
    goes_on(ada)


def test_another_students_copy_is_not_there(room: RelayedClass):
    with room.student("Gil") as gil, gil.lane() as lane:
        assert lane.ask("open_copy", document="rover")["type"] == "done"
        copy = f"rover~{lane.newest('you')['person']}"
        assert lane.ask("watch", document=copy)["type"] == "done"
        with room.student("Hua") as hua, hua.lane() as other:
            for kind, fields in (("watch", {}), ("get_urdf", {}), ("undo", {})):
                refused = other.ask(kind, document=copy, **fields)
                assert refused["kind"] == "UnknownDocumentError"
            with pytest.raises((InvalidStatus, ConnectionClosed)):
                hua.websocket(f"/d/{copy}/viser", "viser").recv(timeout=30)
            page = hua.client.get(f"/api/documents/{copy}/export/page")
            assert page.status_code >= 400


def test_students_who_flood_leave_the_others_answers_and_the_line(room: RelayedClass, ada: Lane):
    line = room.uplink().line
    with room.student("Ivo") as ivo:
        for path, kind in (("/control", "watch"), ("/data", "subscribe")):
            with ivo.websocket(path) as lane:
                for number in range(700):
                    document = f"x{number}~{number}"
                    lane.send(json.dumps({"type": kind, "document": document, "request": number}))
                goes_on(ada)
                answers = 0
                while answers < 700:
                    told = json.loads(lane.recv(timeout=30))
                    answers += told["type"] in {"refused", "not_subscribed"}
    goes_on(ada)
    assert room.uplink().line is line


# Studios that have the key


def test_nobody_claims_the_room_of_another(
    room: RelayedClass, relay: ServedRelay, origin: HostileOrigin, ada: Lane
):
    served, own = room.origin.identity, relay.room().line
    theirs = RoomIdentity(b"x" * 32)
    theirs.id = served.id
    claim = origin.claim(Handshake(), theirs)
    assert origin.ask(claim) is None
    with_their_key = msgspec.structs.replace(claim, public=served.public)
    assert origin.ask(with_their_key, theirs) is None
    assert relay.look(lambda: relay.relay.rooms[served.id].line) is own or own is None
    goes_on(ada)


def test_a_claim_that_was_made_for_another_relay_is_not_taken(origin: HostileOrigin):
    claim = origin.claim(Handshake())
    assert origin.ask(msgspec.structs.replace(claim, relay=b"another")) is None
    assert origin.ask(claim) is not None


def test_who_listens_to_everything_hears_nothing_that_can_be_read(
    room: RelayedClass, relay: ServedRelay, origin: HostileOrigin, ada: Lane
):
    heard = list[tuple[str, bytes]]()

    def take(samples: list[Any]) -> None:
        heard.extend((str(one.key_expr), one.payload.to_bytes()) for one in samples)

    keys = ("**", "studio-relay/**", "studio-relay/*/up", "studio-relay/*/down")
    with hostile_origin(relay.line) as listener:
        subscribed = [
            ReadingThread(
                key, declare_subscription(listener.session, key, 9_999, reliable=True), take
            )
            for key in keys
        ]
        origin.open()  # what it says is not heard either, though it is said just now
        goes_on(ada)
        site = room.served.site("base_length")
        with room.served.presenting() as presenter:
            presenter.ask("edit_site", document="rover", site=site, text="0.71")
            ada.until("sites")
        wait_until(lambda: heard, "what goes up, which all may subscribe")
        for one in subscribed:
            one.close()
    assert all(key.endswith("/up") for key, _ in heard)
    shown = {key.split("/")[1] for key, _ in heard}
    assert origin.line_name not in shown  # by which others could write to it
    assert not any(word in data for _, data in heard for word in (b"raise_hand", b"rover", b"Ask"))


def test_nobody_answers_claims_in_the_place_of_the_relay(
    relay: ServedRelay, origin: HostileOrigin, tmp_path: Path
):
    asked = list[Any]()
    thread = ReadingThread(
        "false claims", declare_queryable(origin.session, CLAIM_KEY, 64), asked.extend
    )
    with relayed_class(tmp_path, [relay.line]) as other:
        assert other.uplink().state == "there"
    thread.close()
    assert not asked


def test_who_floods_a_relay_with_garbage_cuts_no_line_of_others(
    room: RelayedClass, relay: ServedRelay, origin: HostileOrigin, ada: Lane
):
    line = room.uplink().line
    origin.open()
    for key in ("studio-relay/nobody/down", "studio-relay/*/down", line_keys(origin.line_name)[1]):
        garbage = declare_stream(origin.session, key, 10)
        for _ in range(4_000):
            garbage.put(b"x" * 200)
        for _ in range(20):
            garbage.put(bytes(60_000))
        goes_on(ada)
    for _ in range(2_000):
        origin.say(Pong(1))
    token = declare_token(origin.session, "studio-relay/*/alive")
    token.undeclare()
    goes_on(ada)
    assert room.uplink().line is line


def test_a_message_that_zenoh_does_not_take_ends_only_who_sent_it(
    room: RelayedClass, origin: HostileOrigin, ada: Lane
):
    line = room.uplink().line
    origin.open()
    stream = declare_stream(origin.session, line_keys(origin.line_name)[1], 10)
    with suppress(Exception):
        for _ in range(4):
            stream.put(bytes(10 << 20))
    goes_on(ada)
    assert room.uplink().line is line


@pytest.mark.parametrize("count", [100, pytest.param(1_000, marks=pytest.mark.sweep)])
@pytest.mark.parametrize("of_one_room", [True, False])
def test_many_claims_leave_rooms_lines_and_threads_within_bounds(
    relayed: tuple[RelayedClass, ServedRelay],
    origin: HostileOrigin,
    ada: Lane,
    count: int,
    of_one_room: bool,
):
    room, relay = relayed
    line, threads = room.uplink().line, threading.active_count()
    for number in range(count):
        if not of_one_room:
            origin.identity = RoomIdentity(number.to_bytes(32))
        origin.ask(origin.claim(Handshake(), session=str(number)))
    goes_on(ada)
    assert room.uplink().line is line
    assert len(relay.relay.rooms) <= 64
    wait_until(lambda: threading.active_count() < threads + 2 * 64 + 20, "the threads' ends")
    assert room.origin.identity.id in relay.relay.rooms


def test_who_claims_and_says_nothing_has_no_line_for_long(
    relay: ServedRelay, origin: HostileOrigin, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(room_module, "_GREETING_S", 0.2)
    origin.open(greets=False)
    served = relay.relay.rooms[origin.identity.id]
    wait_until(lambda: served.line is None, "the end of the line")


def test_a_studio_ends_nobody_of_another_room(room: RelayedClass, origin: HostileOrigin, ada: Lane):
    origin.open()
    person = ada.newest("you")["person"]
    with origin.page("own") as own, own.lane() as page:
        page.until("documents")
        origin.say(EndPerson(person), EndPerson("own"))
        with pytest.raises(ConnectionClosed):
            page.until("nothing")
    goes_on(ada)


def test_what_a_studio_gives_out_has_no_power_over_the_pages_of_other_rooms(origin: HostileOrigin):
    origin.open()
    origin.downloaded = Downloaded(
        *(0, 'a"\r\nset-cookie: a=b', "text/html\r\nset-cookie: a=b"), data=b"<script>"
    )
    with origin.page() as vic:
        found = vic.client.get("/api/documents/rover/export/page")
        assert found.status_code == 200
        assert "set-cookie" not in found.headers
        assert found.headers["content-type"] == "application/octet-stream"
        assert found.headers["content-security-policy"] == "sandbox"


# What is no message of a studio


_LEAF = (
    st.none()
    | st.booleans()
    | st.integers(0, 1 << 40)
    | st.text(max_size=9)
    | st.binary(max_size=9)
)
_ANY = st.recursive(_LEAF, lambda inner: st.lists(inner, max_size=3), max_leaves=6)
_KINDS: tuple[type, ...] = (
    *(RoomState, LaneSnapshot, LaneFrame, LaneClosed, SceneFrame, Blob, SceneClosed, Say, Settled),
    *(Joined, EndPerson, TopicState, TopicTick, Downloaded, Pong),
)


def struct_of(kind: type) -> st.SearchStrategy[Any]:
    fields = msgspec.structs.fields(kind)
    return st.tuples(*(_ANY for _ in fields)).map(lambda given: [kind.__name__, *given])


def well_formed() -> st.SearchStrategy[Down]:
    """Messages whose fields are of their kinds, and of no sense."""
    name, number = st.sampled_from(["", "rover", "!changes graph", "x"]), st.integers(-9, 99)
    data = st.binary(max_size=40) | st.sampled_from([b'{"type":"you"}', b'{"type":"done"}', b"{"])
    frame = st.builds(Frame, data, st.booleans(), st.sampled_from(["", "view", "a"]))
    some = st.lists(st.binary(max_size=20), max_size=3).map(tuple)
    state = b'{"type":"subscription","subscription":1,"channel":7,"state":"live"}'
    return st.one_of(
        st.builds(LaneSnapshot, name, st.lists(frame, max_size=3).map(tuple)),
        st.builds(LaneFrame, name, frame),
        st.builds(Say, number, frame),
        st.builds(Settled, number, number),
        st.builds(
            SceneFrame,
            name,
            number,
            st.booleans(),
            some,
            st.lists(st.booleans(), max_size=3).map(tuple),
        ),
        st.builds(Blob, st.binary(max_size=16), data),
        st.builds(TopicState, data | st.just(state)),
        st.builds(TopicTick, data, number),
        st.builds(Joined, number, st.text(max_size=9)),
        st.builds(Downloaded, number, st.text(max_size=9)),
        st.builds(Pong, number),
    )


@given(st.binary(max_size=200) | st.sampled_from(_KINDS).flatmap(struct_of) | well_formed())
def send_any(relay: ServedRelay, origin: HostileOrigin, made: object) -> None:
    served = relay.relay.rooms[origin.identity.id]
    if served.line is None or served.line.closed:
        origin.open()
        wait_until(lambda: served.is_there, "the room")
    line = served.line
    assert line is not None
    before = line.received_bytes
    data = made if isinstance(made, bytes) else msgspec.msgpack.encode(made)
    origin.now.send(data)
    wait_until(lambda: line.closed or line.received_bytes >= before + len(data), "its end")


def test_whatever_a_studio_sends_is_ignored_or_ends_its_line_and_pages_stay(
    relay: ServedRelay, origin: HostileOrigin, ada: Lane, caplog: pytest.LogCaptureFixture
):
    origin.open()
    with origin.page("vic") as vic, vic.websocket("/control") as page:
        send_any(relay, origin)
        page.send(b'{"type":"watch","document":"no such","request":7}')
        # What its own studio shows it may be of any form; what the relay answers comes after it.
        while b'"request":7' not in (told := page.recv(timeout=30, decode=False)):
            pass
        assert b"UnknownDocumentError" in told
    failed = [one for one in caplog.records if one.levelname == "ERROR"]
    assert not failed, [(one.getMessage(), one.exc_text) for one in failed]
    goes_on(ada)


def test_changes_without_end_end_the_line_and_not_the_relay(
    relay: ServedRelay, origin: HostileOrigin, ada: Lane, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(lanes_module, "_SINCE_BYTES_MAX", 16 << 20)
    origin.open()
    with origin.page() as vic, vic.lane() as page:
        page.until("documents")
        served = relay.relay.rooms[origin.identity.id]
        line = served.line
        assert line is not None
        end_s = time.monotonic() + 60
        number = 0
        while not line.closed:
            assert time.monotonic() < end_s
            number += 1
            origin.say(LaneFrame("", Frame(bytes(4 << 20), key=f"k{number}")))
    goes_on(ada)
