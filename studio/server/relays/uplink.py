"""An Uplink: a relay that the origin dials, claims its room at, and dials again when lost."""

from __future__ import annotations

import asyncio
import json
import logging
import re
from contextlib import suppress
from typing import TYPE_CHECKING, Final, NamedTuple

import msgspec

import studio
from studio.errors import RelayError, RelayLineError, RelayRefusedError
from studio.ros.wire.zenoh import (
    Incoming,
    ReadingThread,
    ZError,
    ask,
    close,
    declare_stream,
    declare_subscription,
    declare_token,
    insert,
    open_zenoh,
    read_config,
    router_change,
    use_few_threads,
    watch_transports,
)
from studio.server.relays.line import Line
from studio.server.relays.messages import UP_BYTES_MAX, Claim, ClaimAnswer, Signed
from studio.server.relays.sealing import Handshake
from studio.server.relays.wire import CLAIM_KEY, SAMPLES_MAX, key_digest, line_keys, set_limits

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.protocol.relays import RelayStatus
    from studio.ros.wire.zenoh import Config, Sample, Session, TransportEvent
    from studio.server.relays.keys import RelayAddress
    from studio.server.relays.origin_end import OriginEnd
    from studio.server.relays.tickets import RoomIdentity

_REASON_MAX: Final = 200
_ADDRESS: Final = re.compile(r"https?://[A-Za-z0-9.:\[\]-]{1,260}/[A-Za-z0-9._~%/-]{0,260}")
"""Of a page; it is shown to people, and other relays send theirs there."""
_CLAIM_TIMEOUT_S: Final = 5.0
_MATCHING_TIMEOUT_S: Final = 5.0
_LINE: Final = re.compile(r"[0-9a-f]{16}")
_RETRY_S: Final = (0.25, 0.5, 1.0, 2.0)
"""From one attempt to the next, unless the first took longer."""
_OPEN_MS: Final = (3_000, 3_000, 3_000, 6_000)
"""So long an attempt is given, in turn: one that was begun while the cable was cut may never be
answered, and a slow line is to be reached as well."""
_log = logging.getLogger(__name__)


class Claimed(NamedTuple):
    """An open line."""

    line: Line
    address: str
    close: Callable[[], None]


class Uplink:
    """Runs on the event loop; whatever waits for the network does so in threads.

    Args:
        relay: Where it is, and its key.
        identity: Of the room.
        session: Of this run of the studio.
        make_end: Makes what speaks on a line, once there is one.
        changed: Called when the state is another.
    """

    def __init__(
        self,
        relay: RelayAddress,
        identity: Callable[[], RoomIdentity],
        session: str,
        make_end: Callable[[Line, Uplink], OriginEnd],
        changed: Callable[[], object],
    ) -> None:
        self.relay, self._identity, self._session = relay, identity, session
        self._make_end, self._changed = make_end, changed
        self.state: RelayStatus = "connecting"
        self.reason = ""
        self.address = ""
        """Of the room's page at the relay; kept while the line is lost."""
        self.line: Line | None = None
        self.end: OriginEnd | None = None
        self._ended = asyncio.Event()
        self._task = asyncio.get_running_loop().create_task(self._run())

    async def close(self) -> None:
        """End the line, and dial no more."""
        self._task.cancel()
        await asyncio.gather(self._task, return_exceptions=True)

    def hang_up(self, reason: str = "", *, refused: bool = False) -> None:
        """End the line as it is; it is dialled again, unless the relay `refused` us."""
        if refused:
            self._set("refused", str(RelayRefusedError(self.relay.endpoint, reason)))
        self._ended.set()

    async def _run(self) -> None:
        use_few_threads()
        attempts = 0
        loop = asyncio.get_running_loop()
        while self.state != "refused":
            next_s = loop.time() + _RETRY_S[min(attempts, len(_RETRY_S) - 1)]
            try:
                claimed = await self._dialled(_OPEN_MS[attempts % len(_OPEN_MS)])
            except RelayRefusedError as error:
                self._set("refused", str(error))
                return
            except RelayError as error:
                self._set("lost" if self.address else "connecting", str(error))
                await asyncio.sleep(next_s - loop.time())
                attempts += 1
                continue
            attempts = 0
            await self._serve(claimed)
            await asyncio.sleep(next_s - loop.time())

    async def _dialled(self, patience_ms: int) -> Claimed:
        """Dial in a thread; if that is given up meanwhile, what comes of it is ended.

        Raises:
            RelayError: As `_dial` does.
        """
        self._ended.clear()
        dialling = asyncio.ensure_future(asyncio.to_thread(self._dial, patience_ms))
        try:
            return await asyncio.shield(dialling)
        except asyncio.CancelledError:
            dialling.add_done_callback(_let_go)
            raise

    async def _serve(self, claimed: Claimed) -> None:
        """Speak on the line until it ends."""
        try:
            self.line, self.address = claimed.line, claimed.address
            self.end = self._make_end(claimed.line, self)
            claimed.line.begin(self.end)
            self._set("there", "")
            await self._ended.wait()
        finally:
            if self.end is not None:
                self.end.close()
            self.line = self.end = None
            claimed.line.close()
            await asyncio.to_thread(claimed.close)
            if self.state != "refused":
                self._set("lost", "The line to the relay is cut: it is dialled again.")

    def _set(self, state: RelayStatus, reason: str) -> None:
        if (state, reason) != (self.state, self.reason):
            self.state, self.reason = state, reason
            self._changed()

    def _dial(self, patience_ms: int) -> Claimed:
        """Open a session, which may take so long, and claim the room, in a thread.

        Raises:
            RelayRefusedError: The relay does not take this studio.
            RelayError: Nobody answers.
        """
        endpoint = self.relay.endpoint
        try:
            session = open_zenoh(session_config(self.relay, patience_ms))
        except ZError as error:
            raise RelayError(
                f"No relay answers at {endpoint}: check that `studio relay` runs there, that its "
                "port is open, and that the key is its own."
            ) from error
        watch: ReadingThread[TransportEvent] | None = None
        try:
            watch = _watch_router(session, self._task.get_loop(), self._ended.set)
            return self._claim(session, watch)
        except BaseException as error:
            if watch is not None:
                watch.close()
            close(session)
            if isinstance(error, ZError):
                raise RelayLineError(f"{error}.") from None
            raise

    def _claim(self, session: Session, watch: ReadingThread[TransportEvent]) -> Claimed:
        handshake, identity = Handshake(), self._identity()
        claim = Claim(
            *(studio.__version__, identity.id, identity.public, handshake.public, self._session),
            *(key_digest(self.relay.key), self.relay.endpoint),
        )
        body = msgspec.msgpack.encode(claim)
        signed = msgspec.msgpack.encode(Signed(body, identity.sign(body)))
        found = ask(session, CLAIM_KEY, signed, _CLAIM_TIMEOUT_S)
        if found is None:
            raise RelayError(f"What answers at {self.relay.endpoint} is no relay of a studio.")
        answer = self._checked(found, body)
        if answer.reason:
            raise RelayRefusedError(self.relay.endpoint, answer.reason[:_REASON_MAX])
        if not (_ADDRESS.fullmatch(answer.address) and _LINE.fullmatch(answer.line)):
            raise RelayLineError("its answer names no line, or no address of a page.")
        keys = handshake.keys(answer.handshake, body, is_origin=True)
        up, down, alive = line_keys(answer.line)
        incoming = declare_subscription(session, up, SAMPLES_MAX, reliable=True)
        publisher = declare_stream(session, down, _MATCHING_TIMEOUT_S)
        line = Line(self._task.get_loop(), lambda _: publisher, keys, UP_BYTES_MAX)
        reading = _reading(incoming, line)
        token = declare_token(session, alive)

        def end() -> None:
            with suppress(ZError):  # the session has ended already
                token.undeclare()
            watch.close()
            reading.close()
            close(session)

        return Claimed(line, answer.address, end)

    def _checked(self, found: bytes, body: bytes) -> ClaimAnswer:
        try:
            signed = msgspec.msgpack.decode(found, type=Signed)
            self.relay.verify(body + signed.body, signed.signature)
            return msgspec.msgpack.decode(signed.body, type=ClaimAnswer)
        except msgspec.MsgspecError as error:
            raise RelayLineError(f"its answer cannot be read ({error}).") from None


def _let_go(dialled: asyncio.Future[Claimed]) -> None:
    if not dialled.cancelled() and dialled.exception() is None:
        claimed = dialled.result()
        claimed.line.close()
        claimed.close()


def _reading(incoming: Incoming[Sample], line: Line) -> ReadingThread[Sample]:
    def feed(samples: list[Sample]) -> None:
        line.feed([one.payload.to_bytes() for one in samples])

    return ReadingThread("relay-line", incoming, feed)


def _watch_router(
    session: Session, loop: asyncio.AbstractEventLoop, gone: Callable[[], object]
) -> ReadingThread[TransportEvent]:
    def take(events: list[TransportEvent]) -> None:
        for event in events:
            changed = router_change(event)
            if changed is not None and not changed[1] and not loop.is_closed():
                loop.call_soon_threadsafe(gone)

    return ReadingThread("relay-watch", watch_transports(session), take)


def session_config(relay: RelayAddress, open_ms: int) -> Config:
    """Return Zenoh's configuration of who dials a relay, and gives an attempt so long."""
    config = read_config()
    insert(config, "mode", '"client"')
    insert(config, "connect/endpoints", json.dumps([relay.endpoint]))
    insert(config, "transport/unicast/open_timeout", str(open_ms))
    set_limits(config)
    for key, json5 in relay.credentials.of_session().items():
        insert(config, key, json5)
    return config
