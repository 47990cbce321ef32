"""The relay: takes the claims of origins, and serves each room below a path of its own."""

from __future__ import annotations

import asyncio
import json
import logging
import secrets
from http import HTTPStatus
from typing import TYPE_CHECKING, Any, Final

import msgspec
from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse, Response

import studio
from studio.errors import RelayError, RelayLineError, SettingsError
from studio.ros.wire.zenoh import (
    ReadingThread,
    ZError,
    close,
    declare_queryable,
    declare_stream,
    declare_subscription,
    insert,
    open_zenoh,
    read_config,
    token_change,
    watch_tokens,
)
from studio.scene.frame_parts import BlobStore
from studio.server.app import make_app
from studio.server.credentials import Credentials
from studio.server.front import Front
from studio.server.pages import waiting_page
from studio.server.relays.door import PATHS, Door
from studio.server.relays.inbox import Inbox
from studio.server.relays.line import Line
from studio.server.relays.messages import Claim, ClaimAnswer, Signed
from studio.server.relays.metrics import metrics
from studio.server.relays.room import Room
from studio.server.relays.sealing import Handshake
from studio.server.relays.tickets import verify_room
from studio.server.relays.wire import CLAIM_KEY, SAMPLES_MAX, key_digest, line_keys, set_limits

if TYPE_CHECKING:
    from collections.abc import Callable

    from starlette.types import ASGIApp, Receive, Scope, Send

    from studio.protocol.roles import Person
    from studio.ros.wire.zenoh import Config, Outgoing, Query, Sample, Session
    from studio.server.assets import Assets
    from studio.server.crowd import Crowd
    from studio.server.origin import KnownHosts
    from studio.server.relays.keys import RelayIdentity
    from studio.server.relays.sealing import Opener, Sealer

ROOMS_MAX: Final = 64
_BLOBS_BYTES: Final = 512 << 20
_CLAIMS_WAITING: Final = 64
_MATCHING_S: Final = 10.0
_FORGOTTEN_S: Final = 24 * 3600.0
"""After so long a room is forgotten whose origin is away, and that nobody looks at."""
_UP: Final = "studio-relay/*/up"
_, _DOWN, _ALIVE = line_keys("*")
_ACCESS: Final = {
    "enabled": True,
    "default_permission": "deny",
    "rules": [
        {
            "id": name,
            "permission": "allow",
            "flows": flows,
            "messages": messages,
            "key_exprs": [key],
        }
        for name, flows, messages, key in (
            ("claims", ["ingress"], ["query"], CLAIM_KEY),
            ("down", ["ingress"], ["put"], _DOWN),
            ("up", ["ingress"], ["declare_subscriber"], _UP),
            ("alive", ["ingress"], ["liveliness_token"], _ALIVE),
            ("told", ["egress"], ["put", "reply", "declare_subscriber", "declare_queryable"], "**"),
        )
    ],
    "subjects": [{"id": "studios"}],
    "policies": [{"rules": ["claims", "down", "up", "alive", "told"], "subjects": ["studios"]}],
}
"""Who has the key may claim and send; not answer claims for us, nor hear what others send here."""
_TAKEN: Final = (
    "another studio with this room's key has taken it over: stop that one, and start this one "
    "again to get it back."
)
_BEARER: Final = "bearer "
_log = logging.getLogger(__name__)


class Relay:
    """Begins and ends with the server, on its loop; an ASGI application as well.

    Args:
        endpoint: Where origins dial in, as `tls/0.0.0.0:7448`.
        identity: Of this relay; proves its key.
        address: Of its page, as browsers reach it, with a slash at the end.
        assets: The files of the page.
        hosts: The names by which it is reached.
        port: The port that it listens on.
        base: The path below which its page is reached.
        proxies: Whose headers tell who asks.
        on_listening: Called once browsers and studios may come.
    """

    def __init__(  # noqa: PLR0913 - by name
        self,
        *,
        endpoint: str,
        identity: RelayIdentity,
        address: str,
        assets: Assets,
        hosts: KnownHosts,
        port: int,
        base: str = "",
        proxies: frozenset[str] = frozenset(),
        on_listening: Callable[[], object] = lambda: None,
    ) -> None:
        self.endpoint, self.identity, self.address = endpoint, identity, address
        self._assets, self._base = assets, base
        self._on_listening = on_listening
        self._front = hosts, port, proxies
        front = Front(hosts, port, base, proxies)
        self._door = Door(lambda: tuple(self.rooms.values()), front, assets.words)
        self.rooms: dict[str, Room] = {}
        self._apps: dict[str, tuple[str, ASGIApp]] = {}
        self._lines: dict[str, tuple[Room, Inbox]] = {}
        """By their names, which only the two ends know; some have ended."""
        self._blobs = BlobStore(_BLOBS_BYTES)
        self.crowd: Crowd | None = None
        self._session: Session | None = None
        self._threads: tuple[ReadingThread[Any], ...] = ()

    # Its life

    async def begin(self) -> None:
        """Listen for origins.

        Raises:
            SettingsError: It cannot listen there.
        """
        self._loop = asyncio.get_running_loop()
        try:
            session = await asyncio.to_thread(open_zenoh, self._config())
        except ZError as error:
            reason = str(error).split(" at /")[0][:200]
            raise SettingsError(
                f"The relay cannot listen at {self.endpoint} ({reason}): choose another --listen."
            ) from None
        self._session = session
        down = declare_subscription(session, _DOWN, SAMPLES_MAX, reliable=True)
        claims = declare_queryable(session, CLAIM_KEY, _CLAIMS_WAITING)
        alive = watch_tokens(session, _ALIVE)
        self._threads = (
            ReadingThread("relay-down", down, self._feed),
            ReadingThread("relay-claims", claims, self._claims),
            ReadingThread("relay-alive", alive, self._origins),
        )

    async def answering(self) -> None:
        """Tell that studios may dial in."""
        self._on_listening()

    async def end(self) -> None:
        """End all rooms, and let the origins go."""
        for thread in self._threads:
            await asyncio.to_thread(thread.close)
        await asyncio.gather(*(one.close() for one in self.rooms.values()))
        if self._session is not None:
            await asyncio.to_thread(close, self._session)

    def _config(self) -> Config:
        config = read_config()
        insert(config, "mode", '"router"')
        insert(config, "listen/endpoints", json.dumps([self.endpoint]))
        insert(config, "scouting/gossip/enabled", "false")
        insert(config, "transport/unicast/accept_timeout", "5000")
        insert(config, "transport/unicast/max_sessions", str(4 * ROOMS_MAX))
        set_limits(config)
        insert(config, "access_control", json.dumps(_ACCESS))
        for key, json5 in self.identity.credentials.of_router().items():
            insert(config, key, json5)
        return config

    # Origins

    def _feed(self, samples: list[Sample]) -> None:
        """Hand what came to its line, in the thread that reads all lines."""
        by_line: dict[str, list[bytes]] = {}
        for sample in samples:
            name = str(sample.key_expr).split("/")[1]
            by_line.setdefault(name, []).append(sample.payload.to_bytes())
        for name, sealed in by_line.items():
            if found := self._lines.get(name):
                found[1].put(sealed)

    def _origins(self, samples: list[Sample]) -> None:
        """Notice origins that went."""
        for sample in samples:
            key, is_alive = token_change(sample)
            if not is_alive and not self._loop.is_closed():
                self._loop.call_soon_threadsafe(self._left, key.split("/")[1])

    def _left(self, name: str) -> None:
        found = self._lines.pop(name, None)
        if found is not None and found[0].line is found[1].line:
            found[0].hang_up()
        self._forget_lines()

    def _forget_lines(self) -> None:
        for name, (_, inbox) in tuple(self._lines.items()):
            if inbox.line.closed:
                del self._lines[name]
                inbox.close()

    def _claims(self, queries: list[Query]) -> None:
        for query in queries:
            try:
                if query.payload is not None:
                    answer = self._answer(query.payload.to_bytes())
                    query.reply(str(query.key_expr), answer, attachment=b"")
            except (RelayError, ZError, TimeoutError) as error:
                _log.warning("A claim was refused: %s", error)
            except Exception:  # noqa: BLE001 - the claims of other studios wait behind it
                _log.exception("A claim could not be answered.")
            finally:
                query.drop()

    def _answer(self, payload: bytes) -> bytes:
        """Return the answer to a claim, in the thread that reads them.

        Raises:
            RelayError: Nobody made it who has the room.
        """
        try:
            signed = msgspec.msgpack.decode(payload, type=Signed)
            claim = msgspec.msgpack.decode(signed.body, type=Claim)
        except (msgspec.MsgspecError, UnicodeDecodeError) as error:
            raise RelayLineError(f"a claim cannot be read ({error}).") from None
        verify_room(claim.room, claim.public, signed.body, signed.signature)
        if claim.version == studio.__version__ and claim.relay != key_digest(self.identity.key):
            raise RelayLineError("a claim was made for another relay.")
        made = self._admitted(claim, signed.body)
        body = msgspec.msgpack.encode(made)
        return msgspec.msgpack.encode(Signed(body, self.identity.sign(signed.body + body)))

    def _admitted(self, claim: Claim, body: bytes) -> ClaimAnswer:
        if claim.version != studio.__version__:
            return ClaimAnswer(
                reason=f"it runs version {studio.__version__} of the studio, and this one is "
                f"{claim.version}: install the same on both."
            )
        handshake = Handshake()
        keys = handshake.keys(claim.handshake, body, is_origin=False)
        name = secrets.token_hex(8)
        admitted = asyncio.run_coroutine_threadsafe(self._admit(claim, name, keys), self._loop)
        refusal = admitted.result(_MATCHING_S)
        if refusal:
            return ClaimAnswer(reason=refusal)
        return ClaimAnswer(name, handshake.public, f"{self.address}{claim.room}/")

    async def _admit(self, claim: Claim, name: str, keys: tuple[Sealer, Opener]) -> str:
        """Connect a room with who proved that it is theirs; answers why not."""
        room = self.rooms.get(claim.room)
        if room is None:
            self._forget_rooms()
            if len(self.rooms) >= ROOMS_MAX:
                return f"it serves {ROOMS_MAX} rooms already."
            room = self.rooms[claim.room] = Room(claim.room, self._blobs, self._end_people)
        elif claim.session in room.replaced:
            return _TAKEN
        elif room.is_there and room.dial != claim.dial and room.session == claim.session:
            return f"this studio is already connected by {room.dial[:200]}: remove one of the two."
        elif room.state is not None and room.state.session != claim.session:
            room.replaced.append(room.state.session)
            room.hang_up(_TAKEN)
        else:
            room.hang_up()
        session = self._session
        assert session is not None
        up = line_keys(name)[0]

        def publisher(is_open: Callable[[], bool]) -> Outgoing:
            return declare_stream(session, up, _MATCHING_S, is_open)

        line = Line(self._loop, publisher, keys)
        self._forget_lines()
        self._lines[name] = (room, Inbox(line))
        room.dial = claim.dial
        room.connect(line)
        return ""

    def _forget_rooms(self) -> None:
        """Forget rooms that nobody is at: all that are so for long, others for a new one's sake."""
        now_s = self._loop.time()
        empty = [one for one in self.rooms.values() if not one.is_there and not one.pages]
        for room in sorted(empty, key=lambda one: one.away_since_s):
            if len(self.rooms) < ROOMS_MAX and now_s - room.away_since_s <= _FORGOTTEN_S:
                return
            del self.rooms[room.name]
            self._apps.pop(room.name, None)
            self._loop.create_task(room.close())

    def _end_people(self, are_meant: Callable[[Person], bool]) -> None:
        if self.crowd is not None:
            self.crowd.end(are_meant)

    # Browsers

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Hand a request to its room."""
        if scope["type"] == "lifespan":
            return
        path: str = scope["path"].removeprefix(self._base)
        name = path.lstrip("/").partition("/")[0]
        room = self.rooms.get(name)
        if room is not None and room.state is not None:
            await self._app_of(room)(scope, receive, send)
        elif scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1013})
        elif path in PATHS:
            await self._door(scope, receive, send)
        else:
            answer = self._own(scope, path)
            answer.headers["connection"] = "close"  # nobody is known yet who would come again
            await answer(scope, receive, send)

    def _app_of(self, room: Room) -> ASGIApp:
        """Return the application of a room, made anew for each run of its studio."""
        assert room.state is not None
        session = room.state.session
        known = self._apps.get(room.name)
        if known is None or known[0] != session:
            hosts, port, proxies = self._front
            front = Front(hosts, port, f"{self._base}/{room.name}", proxies)
            credentials = Credentials("", secrets.token_bytes(32))
            app = make_app(
                room,
                self._assets,
                credentials,
                session,
                front,
                neighbours=lambda: room.state.others if room.state else (),
            )
            known = self._apps[room.name] = session, app
        return known[1]

    def _own(self, scope: Scope, path: str) -> Response:
        """Answer what concerns no room."""
        if path.endswith("/health"):
            name = path.strip("/").partition("/")[0]
            is_known = path == "/health" or name in self.rooms
            said = "ok\n" if is_known else "no such room\n"
            status = HTTPStatus.OK if is_known else HTTPStatus.SERVICE_UNAVAILABLE
            return PlainTextResponse(said, status, {"cache-control": "no-store"})
        if path == "/metrics":
            given = Headers(scope=scope).get("authorization", "")
            if not given.lower().startswith(_BEARER) or not self.identity.proves(
                given[len(_BEARER) :].strip()
            ):
                return PlainTextResponse(
                    "Send the relay's key: Authorization: Bearer KEY\n", HTTPStatus.UNAUTHORIZED
                )
            return PlainTextResponse(metrics(self), media_type="text/plain; version=0.0.4")
        return waiting_page()
