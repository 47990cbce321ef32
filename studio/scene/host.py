"""viser's engine in our process and on our loop: no thread, no port, one encoding for all pages.

viser opens a socket of its own and encodes every window once per client; here its server class is
replaced by one that has no socket, is fed connections by `serve`, and encodes once for all.
"""

# viser's insides are met here, in wire.py and in opened_frames.py only.
# pyright: reportPrivateUsage=false, reportUnknownMemberType=false, reportUnknownArgumentType=false

from __future__ import annotations

import asyncio
import inspect
import itertools
import logging
from contextlib import contextmanager, suppress
from functools import partial
from typing import TYPE_CHECKING, Any, cast

import rich
import viser
from typing_extensions import override
from viser import _messages, infra
from viser.infra import _infra
from viser.infra._async_message_buffer import AsyncMessageBuffer

from studio.errors import SceneError
from studio.scene.seats import RETRY_S, VISER_VERSION, Seat, Seats, Servings, listen
from studio.scene.wire import Encoder, message_type

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from studio.scene.seats import Connection

VIEWER_MESSAGES = frozenset({"ViewerCameraMessage"})
"""Messages that a read-only page sends to viser."""
NEVER_ALLOWED = frozenset({"ShareUrlRequest", "ShareUrlDisconnect"})
"""Opens a public tunnel on a foreign server: refused whatever the role."""
CAMERA_PERIOD_S = 0.2
"""Orbiting pages send up to 50 a second, more than anybody needs."""
WINDOW_S = 1 / 60
"""Frames follow each other no faster than this, but for `flush`."""
_WINDOW_SIZE = 1 << 14  # messages: an atomic batch is never split over two frames
logger = logging.getLogger(__name__)


class CameraGate:
    """Lets one camera message through per period: the first at once, later the newest."""

    def __init__(self, loop: asyncio.AbstractEventLoop, deliver: Callable[[Any], None]) -> None:
        self._loop, self._deliver = loop, deliver
        self._timer: asyncio.TimerHandle | None = None
        self._newest: object | None = None

    def offer(self, message: object) -> None:
        """Deliver now or, when the last one was a moment ago, soon."""
        if self._timer is None:
            self._deliver(message)
            self._timer = self._loop.call_later(CAMERA_PERIOD_S, self._again)
        else:
            self._newest = message

    def close(self) -> None:
        """Forget the message that waits."""
        if self._timer is not None:
            self._timer.cancel()
        self._newest = None

    def _again(self) -> None:
        self._timer = None
        newest, self._newest = self._newest, None
        if newest is not None:
            self.offer(newest)


def check_version() -> None:
    """Refuse any viser but the one whose insides we know.

    Raises:
        SceneError: Another version is installed.
    """
    if viser.__version__ != VISER_VERSION:
        raise SceneError(
            f"viser {viser.__version__} is installed, but the 3D view needs {VISER_VERSION}: "
            f"install viser=={VISER_VERSION}."
        )


def make_server(loop: asyncio.AbstractEventLoop) -> tuple[viser.ViserServer, HostedServer]:
    """Return a viser server that opens no port and prints nothing; call on the loop's thread.

    Raises:
        SceneError: Another version of viser is installed.
    """
    check_version()
    with _hosted(loop):
        server = viser.ViserServer(verbose=False)
    hosted = cast("HostedServer", server._websock_server)
    for refused in (_messages.ShareUrlRequest, _messages.ShareUrlDisconnect):
        hosted.unregister_handler(refused)
    server.gui.configure_theme(show_logo=False, show_share_button=False)
    return server, hosted


def forget_removed(server: viser.ViserServer) -> None:
    """Let viser drop its records of nodes that are removed on every page."""
    server._run_garbage_collector()


@contextmanager
def _hosted(loop: asyncio.AbstractEventLoop) -> Generator[None]:
    """Within this context, viser builds its server from our class and prints no banner."""
    server_class, show = infra.WebsockServer, rich.print

    infra.WebsockServer = partial(HostedServer, loop)  # pyright: ignore[reportAttributeAccessIssue]
    rich.print = _silence  # pyright: ignore[reportAttributeAccessIssue]
    try:
        yield
    finally:
        infra.WebsockServer = server_class
        rich.print = show


def _silence(*_: object, **__: object) -> None:
    return


class HostedServer(infra.WebsockServer):
    """viser's server without a socket. Everything runs on `loop`, whose thread calls `start`."""

    def __init__(self, loop: asyncio.AbstractEventLoop, **arguments: Any) -> None:  # noqa: ANN401
        super().__init__(**arguments)
        self._loop = loop
        self._seats = Seats(self._newest, self._frame_for)
        self._ids = itertools.count()
        self._encoder = Encoder()
        self._servings = Servings(loop)

    @override
    def start(self) -> None:
        """Begin to send; no thread, no port."""
        self._background_event_loop = self._loop
        self._stop_event = asyncio.Event()
        self._broadcast_buffer = AsyncMessageBuffer(
            self._loop, persistent_messages=True, max_window_size=_WINDOW_SIZE
        )
        # viser forgets what all seats have.
        self._broadcast_buffer.generator_cursors = self._seats.cursors
        self._servings.start(self._send_forever())

    @override
    def stop(self) -> None:
        """End all pages' connections on our side; web closes their sockets."""
        self._broadcast_buffer.set_done()
        self._servings.stop()

    @override
    def flush(self) -> None:
        """Send what is queued at once; on the loop's thread before this returns."""
        self.send_window()

    async def serve(self, connection: Connection, allowed: Callable[[str], bool]) -> None:
        """Serve one page until it or the document closes; never raises for what the page sends.

        Args:
            connection: An accepted websocket.
            allowed: Whether the page may send a message of this type name.
        """
        await self._servings.run(self._serve(connection, allowed))

    async def _serve(self, connection: Connection, allowed: Callable[[str], bool]) -> None:
        client_id = _infra.ClientId(next(self._ids))
        state = _infra._ClientHandleState(
            AsyncMessageBuffer(self._loop, persistent_messages=False), self._loop
        )
        client = _infra.WebsockClientConnection(client_id, state)
        self._client_state_from_id[client_id] = state
        seat = Seat(client_id, connection, self._seats.catch_up)
        connection.on_drain(partial(self._go_on, seat))
        private = self._loop.create_task(
            _infra._message_producer(cast("Any", seat), state.message_buffer, client_id)
        )
        try:
            await _call_all(self._client_connect_cb, client)
            self._join(seat)
            await self._listen(connection, allowed, client)
        finally:
            private.cancel()
            self._seats.leave(seat)
            state.message_buffer.set_done()
            self._client_state_from_id.pop(client_id, None)
            await _call_all(self._client_disconnect_cb, client)

    def _join(self, seat: Seat) -> None:
        self._seats.join(seat)
        if self._broadcast_buffer.atomic_counter == 0:
            seat.resync()
        self._broadcast_buffer.message_event.set()

    def _go_on(self, seat: Seat) -> None:
        """Resume at once when there is room: large clouds would wait a third of their time."""
        if self._broadcast_buffer.atomic_counter == 0:
            seat.outlet.resume()

    async def _listen(
        self,
        connection: Connection,
        allowed: Callable[[str], bool],
        client: _infra.WebsockClientConnection,
    ) -> None:
        def deliver(message: _messages.Message) -> None:
            self._servings.start(self._handle(client, message))

        def take(raw: bytes) -> None:
            message = _understood(raw, allowed)
            if isinstance(message, _messages.ViewerCameraMessage):
                cameras.offer(message)
            elif message is not None:
                deliver(message)

        cameras = CameraGate(self._loop, deliver)
        try:
            await listen(connection, take)
        finally:
            cameras.close()

    async def _handle(
        self, client: _infra.WebsockClientConnection, message: _messages.Message
    ) -> None:
        """Run the handlers of the document, then those of this client."""
        client_id = cast("_infra.ClientId", client.client_id)
        try:
            await self._handle_incoming_message(client_id, message)
            await client._handle_incoming_message(client_id, message)
        except Exception:
            # A page may send what a handler does not expect; it must not end the page's socket.
            logger.exception("A handler of %s failed.", type(message).__name__)

    async def _send_forever(self) -> None:
        buffer = self._broadcast_buffer
        while True:
            retry_s = RETRY_S if self._seats.is_behind else None
            with suppress(TimeoutError):
                await asyncio.wait_for(buffer.message_event.wait(), retry_s)
            buffer.message_event.clear()
            try:
                sent = self.send_window()
            except Exception:
                # One drawing that cannot be encoded must not freeze the view for good.
                logger.exception("A frame for the 3D view could not be made.")
                self._seats.published, sent = self._newest(), True
            if sent:
                await asyncio.sleep(WINDOW_S)

    def send_window(self) -> bool:
        """Send what is queued, unless an atomic batch is open.

        Returns whether there was anything to send.
        """
        buffer = self._broadcast_buffer
        if buffer.atomic_counter > 0:
            return False
        newest = self._newest()
        window = self._since(self._seats.published, newest)
        excluded = {message.excluded_self_client for message in window}
        frame = self._encoder.frame(window) if window and self._seats else b""
        self._seats.publish(frame, newest, excluded)
        return bool(window)

    def _newest(self) -> int:
        return self._broadcast_buffer.message_counter - 1

    def _frame_for(self, seat: Seat, newest: int) -> tuple[bytes, bool]:
        missed = self._since(seat.cursor, newest)
        wanted = [m for m in missed if m.excluded_self_client != seat.id]
        is_shared = len(wanted) == len(missed)
        if not seat.replayed and self._backlog_done_message is not None:
            wanted.append(self._backlog_done_message)
        return (self._encoder.frame(wanted) if wanted else b""), is_shared

    def _since(self, cursor: int, newest: int) -> list[infra.Message]:
        """Messages newer than `cursor` that no later one has replaced, oldest first."""
        buffer = self._broadcast_buffer
        with buffer.buffer_lock:
            if newest - cursor > len(buffer.message_from_id):
                ids = [i for i in buffer.message_from_id if cursor < i <= newest]
            else:
                ids = [i for i in range(cursor + 1, newest + 1) if i in buffer.message_from_id]
            return [buffer.message_from_id[i] for i in ids]


def _understood(raw: bytes, allowed: Callable[[str], bool]) -> _messages.Message | None:
    """Return the message, or None when this page may not send its kind.

    Raises:
        SceneError: It is none of viser's, or its fields are not what they must be.
    """
    name = message_type(raw)
    if name in NEVER_ALLOWED or not allowed(name):
        return None
    try:
        return cast("_messages.Message", _messages.Message.deserialize(raw))
    except (KeyError, TypeError, ValueError, AttributeError, IndexError) as error:
        raise SceneError(f"A {name} to the 3D view is malformed ({error}).") from error


async def _call_all(
    callbacks: list[Callable[[_infra.WebsockClientConnection], Any]],
    client: _infra.WebsockClientConnection,
) -> None:
    for callback in tuple(callbacks):
        answer = callback(client)
        if inspect.isawaitable(answer):
            await answer
