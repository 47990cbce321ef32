"""InteractiveMarkerClient: follows the markers of a server from its first answer on."""

from __future__ import annotations

import threading
import time
from collections import deque
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from studio.errors import CdrError, FrameError, RosNameError, WireError
from studio.ros.cdr import codec_of
from studio.ros.interactive_markers.message_context import MessageContext
from studio.ros.interactive_markers.names import (
    DEPTH,
    FEEDBACK,
    FEEDBACK_TOPIC,
    SERVICE,
    SERVICE_NAME,
    UPDATE,
    UPDATE_TOPIC,
    UpdateKind,
)
from studio.ros.interactive_markers.tools import auto_complete, normalize

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.interactive_markers.message_context import Lookup
    from studio.ros.node.node import Node
    from studio.ros.node.publisher import Publisher
    from studio.ros.node.service_client import Client
    from studio.ros.node.subscription import Subscription
    from studio.ros.node.task import Future
    from studio.ros.types.classes import MessageValue

MessageCallback: TypeAlias = "Callable[[MessageValue], object]"
"""Is called with an answer of the service, or with an update."""
StatusCallback: TypeAlias = "Callable[[ClientStatus, str], object]"
_QUEUE_MAX: Final = 100
_BYTES_MAX: Final = 32 << 20
"""Limit of the answer, of one update, and of all that wait."""
_NO_NUMBER: Final = -1
_PATIENCE_MAX_S: Final = 60.0
"""A large answer takes its time on a slow network: given up early, it would never come."""
_PAUSE_S: Final = 0.2
"""Between a failure and the next request."""


class ClientState(IntEnum):
    """What a client does."""

    IDLE = 0
    INITIALIZE = 1
    RUNNING = 2


class ClientStatus(IntEnum):
    """How serious a status is."""

    DEBUG = 0
    INFO = 1
    WARN = 2
    ERROR = 3


class InteractiveMarkerClient:
    """Follows the server of one namespace; `update` does the work and calls back.

    Idle, it waits for the server. Then it asks for all markers by the service, and keeps the
    updates that come meanwhile. Running, it hands on one update after the other. When one is
    missing, a transform cannot be known, or the server is gone, it begins again: the reset
    callback is called, and what was shown is void.

    Markers are completed before they are handed on. Messages come in by threads of the node; all
    else is for one thread at a time.

    Args:
        node: Its name is the client's id in feedback.
        lookup: Where frames are; None: markers are handed on in their own frames, at once.
        target_frame: Markers with a stamp are brought into it.
        topic_namespace: Of the server; if one is given, it connects at once.
        request_timeout_s: After this time without an answer it asks again, and waits twice as long.
        controls_max: So many controls of one message are completed and handed on.
        update_sub_qos: Depth of the subscription to updates.
        feedback_pub_qos: Depth of the publisher of feedback.
    """

    def __init__(  # noqa: PLR0913 - as upstream
        self,
        node: Node,
        lookup: Lookup | None = None,
        target_frame: str = "",
        topic_namespace: str = "",
        *,
        request_timeout_s: float = 1.0,
        controls_max: int | None = None,
        update_sub_qos: int = DEPTH,
        feedback_pub_qos: int = DEPTH,
    ) -> None:
        self.client_id = node.get_fully_qualified_name()
        self.topic_namespace = ""
        self.left_out = 0
        """Controls that were too many, in all."""
        self._controls_max = controls_max
        self._node, self._lookup, self._target = node, lookup, target_frame
        self._timeout_s = self._patience_s = request_timeout_s
        self._depths = update_sub_qos, feedback_pub_qos
        self._service = node.wire.types.service(SERVICE)
        self._codec = codec_of(node.wire.types.message(UPDATE))
        self._answer_codec = codec_of(self._service.Response)
        self._on_initialize: MessageCallback = _ignore
        self._on_update: MessageCallback = _ignore
        self._on_reset: Callable[[], object] = _do_nothing
        self._on_status: StatusCallback = _ignore_status
        self._transparent = True
        self._state = ClientState.IDLE
        self._lock = threading.Lock()
        """Of what comes in by other threads: `_incoming`, `_answers`."""
        self._incoming: deque[bytes] = deque()
        self._incoming_bytes = 0
        self._overflowed = ""
        self._future: Future[Any] | None = None
        self._asked_s = float("-inf")
        self._initial: MessageContext | None = None
        self._queue: deque[MessageContext] = deque()
        self._last_number: int | None = None
        """Of the last update; None: none came yet."""
        self._answered_number = _NO_NUMBER
        """Of the answer, until the first update after it."""
        self._said: tuple[ClientStatus, str] | None = None
        self._client: Client | None = None
        self._subscription: Subscription | None = None
        self._publisher: Publisher | None = None
        if topic_namespace:
            self.connect(topic_namespace)

    @property
    def state(self) -> ClientState:
        """What it does now."""
        return self._state

    @property
    def has_news(self) -> bool:
        """Whether `update` has more to do than to look whether the server is there."""
        future = self._future
        is_answered = future is not None and future.done()
        return bool(self._incoming or self._queue or self._overflowed or is_answered)

    def set_initialize_callback(self, callback: MessageCallback) -> None:
        """Have a function called with all markers, after the server answered."""
        self._on_initialize = callback

    def set_update_callback(self, callback: MessageCallback) -> None:
        """Have a function called with each update from then on."""
        self._on_update = callback

    def set_reset_callback(self, callback: Callable[[], object]) -> None:
        """Have a function called when what was shown is void."""
        self._on_reset = callback

    def set_status_callback(self, callback: StatusCallback) -> None:
        """Have a function called with each status, a sentence."""
        self._on_status = callback

    def set_enable_autocomplete_transparency(self, enable: bool) -> None:  # noqa: FBT001
        """Choose whether handles may be seen through; it counts for markers from then on."""
        self._transparent = enable

    def set_target_frame(self, target_frame: str) -> None:
        """Bring markers into another frame; begins again."""
        if target_frame != self._target:
            self._target = target_frame
            self._say(ClientStatus.INFO, f"The target frame is now {target_frame}.")
            self._begin_again()

    def connect(self, topic_namespace: str) -> None:
        """Follow the server of another namespace; empty: of none."""
        self.disconnect()
        self.topic_namespace = topic_namespace
        if not topic_namespace:
            return
        types, (update_depth, feedback_depth) = self._node.wire.types, self._depths
        try:
            self._client = self._node.create_client(self._service, topic_namespace + SERVICE_NAME)
            self._publisher = self._node.create_publisher(
                types.message(FEEDBACK), topic_namespace + FEEDBACK_TOPIC, feedback_depth
            )
            self._subscription = self._node.create_subscription(
                types.message(UPDATE),
                topic_namespace + UPDATE_TOPIC,
                self._receive,
                update_depth,
                raw=True,
            )
        except (RosNameError, WireError) as error:
            self.disconnect()
            self._say(ClientStatus.ERROR, f"There is no connection: {error}")
            return
        self._say(ClientStatus.INFO, f"Connected on namespace: {topic_namespace}")

    def disconnect(self) -> None:
        """Follow no server."""
        client, self._client = self._client, None
        publisher, self._publisher = self._publisher, None
        subscription, self._subscription = self._subscription, None
        if client is not None:
            self._node.destroy_client(client)
        if publisher is not None:
            self._node.destroy_publisher(publisher)
        if subscription is not None:
            self._node.destroy_subscription(subscription)
        self._reset()

    def publish_feedback(self, feedback: MessageValue) -> None:
        """Send a feedback under this client's id; nothing without a connection."""
        feedback.client_id = self.client_id
        publisher = self._publisher  # `disconnect` may come between, from another thread
        if publisher is not None:
            publisher.publish(feedback)

    def update(self) -> None:
        """Take a step, and call back; call it many times a second."""
        client = self._client
        if client is None:
            return
        is_ready = client.service_is_ready()
        if not is_ready and self._state is not ClientState.IDLE:
            while_ = "running" if self._state is ClientState.RUNNING else "initialization"
            self._say(ClientStatus.WARN, f"Server not available during {while_}, resetting")
            self._begin_again()
            return
        try:
            match self._state:
                case ClientState.IDLE:
                    self._idle(client, is_ready=is_ready)
                case ClientState.INITIALIZE:
                    self._initialize(client)
                case ClientState.RUNNING:
                    self._run()
        except FrameError as error:
            self._say(ClientStatus.ERROR, f"Resetting due to transform error: {error}")
            self._begin_again()

    def _idle(self, client: Client, *, is_ready: bool) -> None:
        if is_ready and time.monotonic() - self._asked_s >= _PAUSE_S:
            self._state = ClientState.INITIALIZE
            self._ask(client)
        elif not is_ready:
            self._say(ClientStatus.WARN, f"No server on {self.topic_namespace}")

    def _ask(self, client: Client) -> None:
        if self._future is not None:
            client.remove_pending_request(self._future)
        self._asked_s = time.monotonic()
        # Raw: a large answer is read by `update`, and not by the node's thread, which others need.
        self._future = client.call_async(self._service.Request(), raw=True)
        self._say(ClientStatus.INFO, "Sending request for interactive markers")

    def _initialize(self, client: Client) -> None:
        self._take_incoming()
        if self._state is not ClientState.INITIALIZE or not self._is_answered(client):
            return
        initial = self._initial
        if initial is None:
            return
        initial.get_transforms()
        if not initial.is_ready:
            self._say(ClientStatus.DEBUG, "Initialization: Waiting for TF info")
            return
        number = initial.message.sequence_number
        while self._queue and self._queue[0].message.seq_num <= number:
            self._queue.popleft()
        if self._queue and self._queue[0].message.seq_num != number + 1:
            self._out_of_order(number + 1, self._queue[0].message.seq_num)
            return
        if not self._queue:
            self._last_number = self._answered_number = number
        self._state = ClientState.RUNNING
        self._on_initialize(initial.message)
        self._say(ClientStatus.INFO, "Initialized")

    def _is_answered(self, client: Client) -> bool:
        """Take the answer if it has come; ask again if it is late or an error."""
        if self._initial is not None:
            return True
        future = self._future
        if future is not None and future.done():
            self._future = None
            try:
                self._initial = self._completed(self._read_answer(future.result()))
            except WireError as failure:
                self._say(ClientStatus.WARN, f"The server did not answer: {failure}")
            else:
                return True
        if time.monotonic() - self._asked_s > self._patience_s:
            self._say(
                ClientStatus.WARN,
                "Did not receive response with interactive markers, resending request...",
            )
            self._patience_s = min(2 * self._patience_s, _PATIENCE_MAX_S)
            self._ask(client)
        return False

    def _read_answer(self, payload: bytes) -> MessageValue:
        if len(payload) > _BYTES_MAX:
            raise CdrError(SERVICE, f"{len(payload):,} bytes are more than {_BYTES_MAX:,}")
        return self._answer_codec.decode(payload)

    def _run(self) -> None:
        self._take_incoming()
        for one in self._queue:
            one.get_transforms()
        while self._queue and self._queue[0].is_ready and self._state is ClientState.RUNNING:
            self._on_update(self._queue.popleft().message)

    def _receive(self, payload: bytes) -> None:
        """Keep an update until `update`; a thread of the node calls it."""
        size = len(payload)
        with self._lock:
            if size + self._incoming_bytes > _BYTES_MAX or len(self._incoming) >= _QUEUE_MAX:
                self._overflowed = f"Updates of {size:,} bytes are too large or too many"
                return
            self._incoming.append(payload)
            self._incoming_bytes += size

    def _take_incoming(self) -> None:
        with self._lock:
            incoming, self._incoming = self._incoming, deque()
            self._incoming_bytes = 0
            overflowed, self._overflowed = self._overflowed, ""
        for payload in incoming:
            if not self._take(payload):
                return
        if overflowed:
            self._say(ClientStatus.WARN, f"{overflowed}, resetting")
            self._begin_again()

    def _take(self, payload: bytes) -> bool:
        """Queue an update; False: it is out of order, and all begins again."""
        try:
            update = self._codec.decode(payload)
        except CdrError as error:
            self._say(ClientStatus.ERROR, f"An update could not be read: {error}")
            return True
        if update.type == UpdateKind.KEEP_ALIVE:
            return True  # of servers of ROS 1
        if update.seq_num <= self._answered_number:
            return True  # the answer, which was quicker, has it already
        if self._last_number is not None and update.seq_num != self._last_number + 1:
            return self._out_of_order(self._last_number + 1, update.seq_num)
        if len(self._queue) >= _QUEUE_MAX:
            self._say(ClientStatus.WARN, "Too many updates wait for their transforms, resetting")
            self._begin_again()
            return False
        self._last_number, self._answered_number = update.seq_num, _NO_NUMBER
        self._queue.append(self._completed(update))
        return True

    def _completed(self, message: MessageValue) -> MessageContext:
        types = self._node.wire.types
        room = self._controls_max
        for marker in message.markers:
            if room is not None:
                self.left_out += max(0, len(marker.controls) - room)
                marker.controls = marker.controls[:room]
                room -= len(marker.controls)
            auto_complete(marker, types, transparent=self._transparent)
        for one in getattr(message, "poses", ()):
            normalize(one.pose.orientation)
        return MessageContext(message, self._lookup, self._target)

    def _out_of_order(self, expected: int, received: int) -> bool:
        self._say(
            ClientStatus.WARN,
            f"Update sequence number is out of order. {expected} (expected) vs. "
            f"{received} (received)",
        )
        self._begin_again()
        return False

    def _begin_again(self) -> None:
        self._asked_s = time.monotonic()
        self._reset()

    def _reset(self) -> None:
        self._state, self._patience_s = ClientState.IDLE, self._timeout_s
        if self._future is not None and self._client is not None:
            self._client.remove_pending_request(self._future)
        self._future = self._initial = self._last_number = None
        self._answered_number = _NO_NUMBER
        self._queue.clear()
        with self._lock:
            self._incoming.clear()
            self._incoming_bytes, self._overflowed = 0, ""
        self._on_reset()

    def _say(self, status: ClientStatus, sentence: str) -> None:
        """Report a status, unless it is the one that was reported last."""
        if (status, sentence) != self._said:
            self._said = status, sentence
            self._on_status(status, sentence)


def _ignore(_message: object) -> None:
    """Do nothing."""


def _do_nothing() -> None:
    """Do nothing."""


def _ignore_status(_status: ClientStatus, _sentence: str) -> None:
    """Do nothing."""
