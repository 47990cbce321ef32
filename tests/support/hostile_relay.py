"""A relay that does what it likes: at a real port, with a real key, and without a relay's rules."""

from __future__ import annotations

import json
import secrets
import threading
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import msgspec

from studio.errors import RelayLineError
from studio.ros.wire.certificates import new_secret
from studio.ros.wire.zenoh import (
    ReadingThread,
    close,
    declare_queryable,
    declare_stream,
    declare_subscription,
    insert,
    open_zenoh,
    read_config,
)
from studio.server.relays.keys import RelayIdentity
from studio.server.relays.messages import (
    Arrive,
    Ask,
    AskJoin,
    Claim,
    ClaimAnswer,
    Down,
    Downloaded,
    Joined,
    Ping,
    Pong,
    Say,
    Settled,
    Signed,
    Up,
    decode_down,
    encode,
)
from studio.server.relays.sealing import Handshake, Joiner, split
from studio.server.relays.wire import CLAIM_KEY, line_keys
from tests.support.relays import free_port, wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterable

    from studio.classroom.classroom import Classroom
    from studio.ros.wire.zenoh import Outgoing, Query, Sample, Session
    from studio.server.relays.sealing import Opener, Sealer
    from tests.support.relays import RelayedClass

_Kind = TypeVar("_Kind")
_PATIENCE_S = 30.0


class HostileLine:
    """The relay's end of one line, of which every byte is made by hand."""

    def __init__(self, publisher: Outgoing, keys: tuple[Sealer, Opener]) -> None:
        self._publisher, (self._sealer, self._opener) = publisher, keys
        self._joiner = Joiner()
        self._sending = threading.Lock()
        self.heard_bytes = 0

    def seal(self, data: bytes) -> list[bytes]:
        """A message as it goes onto the line."""
        with self._sending:
            return [self._sealer.seal(one) for one in split(b"m" + data)]

    def send(self, data: bytes) -> None:
        """Send a message: nothing else goes between its pieces."""
        with self._sending:
            for one in split(b"m" + data):
                self._publisher.put(self._sealer.seal(one))

    def put(self, sealed: Iterable[bytes]) -> None:
        """Send what was sealed, now or before."""
        for one in sealed:
            self._publisher.put(one)

    def confirm(self, size: int) -> None:
        """Tell that so many bytes came."""
        with self._sending:
            self._publisher.put(self._sealer.seal(split(b"c" + size.to_bytes(8, "little"))[0]))

    def open(self, sealed: bytes) -> bytes | None:
        """A message of the origin that this completes, with its first byte."""
        opened = self._opener.open(sealed)
        message = self._joiner.take(opened.data, gap=opened.gap)
        if message is not None and message[:1] == b"m":
            self.heard_bytes += len(message) - 1
        return message


class HostileRelay:
    """Answers claims as a relay does; what it says then is up to the test."""

    def __init__(self, session: Session, identity: RelayIdentity, endpoint: str) -> None:
        self._session, self._identity = session, identity
        self.line = f"{endpoint}#{identity.key}"
        self.endpoint = endpoint
        self.claims: list[Claim] = []
        self.lines: dict[str, HostileLine] = {}
        self.heard: list[Down] = []
        self.heard_bytes: bytearray | None = None
        """Of every message, opened, where they are wanted."""
        self.confirms: Literal["honestly", "never", "everything"] = "honestly"
        self.answers: dict[str, str] = {}
        """Of claims, instead of what is true."""
        self._numbers = iter(range(1, 1 << 40))
        # Each sample that waits holds as much as Zenoh receives at once.
        down = declare_subscription(session, line_keys("*")[1], 4_096, reliable=True)
        self._threads = (
            ReadingThread("hostile-down", down, self._take),
            ReadingThread("hostile-claims", declare_queryable(session, CLAIM_KEY, 64), self._claim),
        )

    def close(self) -> None:
        """End it."""
        for one in self._threads:
            one.close()
        close(self._session)

    # What it says

    @property
    def now(self) -> HostileLine:
        """The newest line."""
        return next(reversed(self.lines.values()))

    def number(self) -> int:
        """One that was not used yet."""
        return next(self._numbers)

    def say(self, *messages: Up) -> None:
        """Send messages as a relay seals them."""
        for one in messages:
            self.now.send(encode(one))

    def raw(self, data: bytes) -> None:
        """Send bytes that may be no message, sealed."""
        self.now.send(data)

    def join(self, name: str, code: str) -> str:
        """The ticket of somebody who joins here."""
        number = self.number()
        self.say(AskJoin(number, name, code, "", ""))
        joined = self.until(Joined, lambda one: one.number == number)
        assert joined.ticket, joined
        return joined.ticket

    # What it hears

    def until(
        self, kind: type[_Kind], holds: Callable[[_Kind], bool] = lambda _: True, since: int = 0
    ) -> _Kind:
        """The first message of a kind of which that holds, once it is there."""
        found: list[_Kind] = []

        def look() -> bool:
            found[:] = [one for one in self.heard[since:] if isinstance(one, kind) and holds(one)]
            return bool(found)

        wait_until(look, f"a {kind.__name__}", _PATIENCE_S)
        return found[0]

    def until_line(self, before: int) -> None:
        """Wait until the origin dialled once more than `before` times."""
        wait_until(lambda: len(self.lines) > before, "another line", _PATIENCE_S)

    def _claim(self, queries: list[Query]) -> None:
        for query in queries:
            assert query.payload is not None
            signed = msgspec.msgpack.decode(query.payload.to_bytes(), type=Signed)
            claim = msgspec.msgpack.decode(signed.body, type=Claim)
            self.claims.append(claim)
            handshake = Handshake()
            keys = handshake.keys(claim.handshake, signed.body, is_origin=False)
            name = secrets.token_hex(8)
            told = {"line": name, "address": "http://127.0.0.1:9/room/", **self.answers}
            answer = ClaimAnswer(handshake=handshake.public, **told)
            body = msgspec.msgpack.encode(answer)
            proof = self._identity.sign(signed.body + body)
            made = msgspec.msgpack.encode(Signed(body, proof))
            query.reply(str(query.key_expr), made, attachment=b"")
            query.drop()
            if not self.answers:
                publisher = declare_stream(self._session, line_keys(name)[0], _PATIENCE_S)
                self.lines[name] = HostileLine(publisher, keys)

    def _take(self, samples: list[Sample]) -> None:
        for sample in samples:
            name = str(sample.key_expr).split("/")[1]
            wait_until(lambda name=name: name in self.lines, "the line", _PATIENCE_S)
            line = self.lines[name]
            try:
                message = line.open(sample.payload.to_bytes())
            except RelayLineError:
                continue
            if message is None or message[:1] != b"m":
                continue
            if self.heard_bytes is not None:
                self.heard_bytes += message[1:]
            told = decode_down(message[1:])
            if isinstance(told, Downloaded):
                told = msgspec.structs.replace(told, data=b"")
            self.heard.append(told)
            if self.confirms != "never":
                line.confirm(line.heard_bytes if self.confirms == "honestly" else (1 << 64) - 1)


@contextmanager
def hostile_relay() -> Generator[HostileRelay]:
    """A hostile relay that listens."""
    identity, endpoint = RelayIdentity(new_secret()), f"tls/127.0.0.1:{free_port()}"
    config = read_config()
    insert(config, "mode", '"router"')
    insert(config, "listen/endpoints", json.dumps([endpoint]))
    insert(config, "scouting/multicast/enabled", "false")
    insert(config, "scouting/gossip/enabled", "false")
    for key, json5 in identity.credentials.of_router().items():
        insert(config, key, json5)
    made = HostileRelay(open_zenoh(config), identity, endpoint)
    try:
        yield made
    finally:
        made.close()


class HostileClass:
    """A class at a hostile relay, and what its relay can do there."""

    def __init__(self, room: RelayedClass, relay: HostileRelay) -> None:
        self.room, self.relay = room, relay
        self._flooder = ""

    @property
    def classroom(self) -> Classroom:
        return self.room.served.classroom

    def ticket(self, name: str) -> str:
        """Of somebody who joined at the relay."""
        return self.relay.join(name, self.classroom.admission.code)

    def flooder(self) -> str:
        """The ticket of somebody who joined before any flood, after which nobody might."""
        self._flooder = self._flooder or self.ticket("Jim")
        return self._flooder

    def person(self, name: str) -> str:
        return next(one.person for one in self.classroom.members if one.name == name)

    def page(self, ticket: str) -> int:
        """The number of a page that has arrived."""
        page = self.relay.number()
        self.relay.say(Arrive(page, ticket))
        return page

    def ask(self, page: int, kind: str, **fields: object) -> dict[str, Any]:
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
        """Wait until all that was said before was taken, or ended the line and there is another."""
        numbers, since, asked_s = set[int](), len(self.relay.heard), 0.0

        def has_answered() -> bool:
            nonlocal asked_s
            if time.monotonic() > asked_s + 2:
                asked_s = time.monotonic()
                numbers.add(self.relay.number())
                self.relay.say(Ping(max(numbers)))
            told = self.relay.heard[since:]
            return any(isinstance(one, Pong) and one.sent_ns in numbers for one in told)

        wait_until(has_answered, "an answer")

    def copy_of(self, name: str) -> tuple[int, str, str]:
        """A page, its ticket, and the copy that its person has made."""
        ticket = self.ticket(name)
        page = self.page(ticket)
        assert self.ask(page, "open_copy", document="rover")["type"] == "done"
        return page, ticket, f"rover~{self.person(name)}"
