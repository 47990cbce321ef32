"""A studio that has a relay's key, and is hostile to the relay and to its other rooms."""

from __future__ import annotations

import secrets
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING

import msgspec

import studio
from studio.ros.wire.zenoh import (
    ReadingThread,
    ask,
    close,
    declare_stream,
    declare_subscription,
    declare_token,
    insert,
    open_zenoh,
    read_config,
)
from studio.server.relays.keys import parse_relay_line
from studio.server.relays.messages import (
    AskDownload,
    Claim,
    ClaimAnswer,
    Down,
    Downloaded,
    Frame,
    LaneSnapshot,
    OpenLane,
    RoomState,
    Signed,
    decode_up,
    encode,
)
from studio.server.relays.sealing import Handshake
from studio.server.relays.tickets import RoomIdentity, TicketIssuer
from studio.server.relays.wire import CLAIM_KEY, key_digest, line_keys
from tests.support.classmates import Classmate
from tests.support.hostile_relay import HostileLine
from tests.support.relays import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.wire.zenoh import Config, Declaration, Sample, Session
    from studio.server.relays.keys import RelayAddress
    from studio.server.relays.messages import Up

_PATIENCE_S = 10.0


class HostileOrigin:
    """Knocks at a relay as a studio does; what it says then is up to the test."""

    def __init__(self, line: str) -> None:
        self.relay = parse_relay_line(line)
        self.session: Session = open_zenoh(_config(self.relay))
        self.identity = RoomIdentity(secrets.token_bytes(32))
        self.issuer = TicketIssuer(b"t" * 32, self.identity.id)
        self.heard: list[Up] = []
        self.address = self.line_name = ""
        self.downloaded: Downloaded | None = None
        """What is given out, whatever is asked for."""
        self.now: HostileLine
        self._threads: list[ReadingThread[Sample]] = []
        self._tokens: list[Declaration] = []

    def close(self) -> None:
        """Leave."""
        for one in self._threads:
            one.close()
        close(self.session)

    def ask(self, claim: Claim, signer: RoomIdentity | None = None) -> ClaimAnswer | None:
        """What a claim is answered; None: nothing."""
        body = msgspec.msgpack.encode(claim)
        signed = msgspec.msgpack.encode(Signed(body, (signer or self.identity).sign(body)))
        found = ask(self.session, CLAIM_KEY, signed, 1.0)
        if found is None:
            return None
        answer = msgspec.msgpack.decode(found, type=Signed)
        return msgspec.msgpack.decode(answer.body, type=ClaimAnswer)

    def claim(
        self, handshake: Handshake, identity: RoomIdentity | None = None, session: str = "s"
    ) -> Claim:
        """A claim as a studio makes it."""
        own = identity or self.identity
        digest = key_digest(self.relay.key)
        return Claim(studio.__version__, own.id, own.public, handshake.public, session, digest)

    def open(self, *, greets: bool = True) -> None:
        """Have its own room served."""
        handshake = Handshake()
        claim = self.claim(handshake)
        answer = self.ask(claim)
        assert answer is not None
        assert not answer.reason, answer
        keys = handshake.keys(answer.handshake, msgspec.msgpack.encode(claim), is_origin=True)
        up, down, alive = line_keys(answer.line)
        incoming = declare_subscription(self.session, up, 65_536, reliable=True)
        self.now = HostileLine(declare_stream(self.session, down, _PATIENCE_S), keys)
        self._threads.append(ReadingThread("hostile-up", incoming, partial(self._take, self.now)))
        self._tokens.append(declare_token(self.session, alive))
        self.address, self.line_name = answer.address, answer.line
        if greets:
            self.say(self.state())

    def state(self, **fields: object) -> RoomState:
        """What it says of its room."""
        told: dict[str, object] = {
            "session": "s",
            "link": b"",
            "tickets": self.issuer.public,
            "is_open": True,
            "has_password": False,
            "default_document": "rover",
            "documents": ("rover",),
            **dict.fromkeys(("shown", "holder", "controlled"), ""),
            "others": (),
            "sent_out": (),
        }
        return RoomState(**{**told, **fields})  # pyright: ignore[reportArgumentType]

    def say(self, *messages: Down) -> None:
        """Send messages as a studio seals them."""
        for one in messages:
            self.now.send(encode(one))

    def until(self, kind: type[Up], count: int = 1) -> None:
        """Wait until so many messages of a kind have come."""

        def has_come() -> bool:
            return sum(isinstance(one, kind) for one in self.heard) >= count

        wait_until(has_come, f"a {kind.__name__}", _PATIENCE_S)

    @contextmanager
    def page(self, person: str = "victim") -> Generator[Classmate]:
        """A browser that came to its room by a ticket."""
        made = Classmate(self.address)
        try:
            wait_until(lambda: made.client.get("/join").status_code == 200, "the form")
            ticket = self.issuer.issue(person, "Vic", "student")
            assert made.client.get(f"/join?pass={ticket}").status_code == 303
            yield made
        finally:
            made.close()

    def _take(self, line: HostileLine, samples: list[Sample]) -> None:
        for sample in samples:
            message = line.open(sample.payload.to_bytes())
            if message is None or message[:1] != b"m":
                continue
            told = decode_up(message[1:])
            self.heard.append(told)
            if isinstance(told, AskDownload) and self.downloaded is not None:
                self.say(msgspec.structs.replace(self.downloaded, number=told.number))
            if isinstance(told, OpenLane):
                shown = Frame(b'{"type":"documents","documents":[]}', key="documents")
                self.say(LaneSnapshot(told.lane, (shown,)))


@contextmanager
def hostile_origin(line: str) -> Generator[HostileOrigin]:
    """A hostile studio that has connected."""
    made = HostileOrigin(line)
    try:
        yield made
    finally:
        made.close()


def _config(relay: RelayAddress) -> Config:
    config = read_config()
    insert(config, "mode", '"client"')
    insert(config, "connect/endpoints", f'["{relay.endpoint}"]')
    insert(config, "scouting/multicast/enabled", "false")
    for key, json5 in relay.credentials.of_session().items():
        insert(config, key, json5)
    return config
