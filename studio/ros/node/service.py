"""Service: answers requests, each on the key and with the number that it came with."""

from __future__ import annotations

import asyncio
import contextlib
import inspect
import threading
import time
from collections import Counter, deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from studio.errors import AttachmentError, CdrError
from studio.ros.attachment import GID_BYTES, Attachment, packed, unpack
from studio.ros.cdr import check_kind, codec_of
from studio.ros.node.logger import get_logger
from studio.ros.node.service_end import ServiceEnd
from studio.ros.qos import DEPTH_DEFAULT
from studio.ros.types.classes import definition_of
from studio.ros.wire.bridges.dialect import request_number
from studio.ros.wire.zenoh import ZError, declare_queryable

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

    from studio.ros.node.base import Endpoint
    from studio.ros.node.work import CallbackGroup
    from studio.ros.types.library import ServiceKind
    from studio.ros.wire.zenoh import Incoming, Query

_RING = 4_096
_NO_FIELDS = b"\x00\x01\x00\x00\x00"
"""The CDR of a request without fields, which a bridge may leave out."""
_NOBODY = bytes(GID_BYTES)
PENDING_MAX = 10_000
PENDING_OF_CLIENT_MAX = 1_000
"""Requests without an answer: an asynchronous callback may take as long as it likes."""


@dataclass(frozen=True, slots=True)
class _Request:
    """A query that waits, and what it came with; from a bridge to DDS the answer has no number."""

    query: Query
    payload: bytes
    attachment: Attachment
    is_bridged: bool

    @property
    def number(self) -> tuple[bytes, int]:
        return self.attachment.gid, self.attachment.sequence


class Service(ServiceEnd):
    """Serves one service; the callback takes a request and a response, and returns the response.

    The last `depth` requests wait; older ones are dropped, and their clients get an error at once.
    """

    def __init__(
        self,
        endpoint: Endpoint,
        srv_type: ServiceKind,
        callback: Callable[[Any, Any], object],
        group: CallbackGroup,
    ) -> None:
        super().__init__(endpoint, srv_type, group)
        self.callback = callback
        self.refused = 0
        self.reason: str | None = None
        self._request_codec = codec_of(srv_type.Request)
        self._response_codec = codec_of(srv_type.Response)
        self._response = definition_of(srv_type.Response)
        self._depth = endpoint.token.qos.depth or DEPTH_DEFAULT
        self._waiting: deque[_Request] = deque()
        self._pending: dict[tuple[bytes, int], _Request] = {}
        self._askers: Counter[bytes] = Counter()
        self._lock = threading.Lock()
        self._unnumbered = 0
        self._incoming: Incoming[Query] | None = self._declared(endpoint.key)
        self._bridged = endpoint.for_bridges(lambda key: self._declared(key, is_of_others=True))
        endpoint.show()

    @property
    def is_ready(self) -> bool:
        """Whether a request waits."""
        return bool(self._waiting)

    def drain(self) -> int:
        """Take in requests; of the drain's thread."""
        incoming = self._incoming
        queries = [] if incoming is None else incoming.take(_RING)
        for query in queries:
            self._receive(query, is_bridged=False)
        bridged = self._bridged.declared
        asked = [] if bridged is None else bridged.take(_RING)
        for query in asked:
            self._receive(query, is_bridged=True)
        return len(queries) + len(asked)

    def take(self) -> Callable[[], object] | None:
        """Take the oldest request, and return what answers it."""
        with self._lock:
            request = self._waiting.popleft() if self._waiting else None
        return None if request is None else lambda: self._answer(request)

    def destroy(self) -> None:
        """Take it back; clients that wait learn that there will be no answer."""
        with self._lock:
            incoming, self._incoming = self._incoming, None
        if incoming is None:
            return
        self.endpoint.hide(incoming)
        for query in incoming.take(_RING):
            query.drop()
        with self._lock:
            left = list(self._pending.values())
            self._pending.clear()
            self._askers.clear()
            self._waiting.clear()
        for request in left:
            with contextlib.suppress(RuntimeError):  # another thread answers it just now
                request.query.drop()

    def _receive(self, query: Query, *, is_bridged: bool) -> None:
        payload, attachment = query.payload, query.attachment
        told = None if attachment is None else attachment.to_bytes()
        try:
            number = self._number_of_bridge(told) if is_bridged else unpack(told)
        except AttachmentError as error:
            self._refuse(query, str(error))
            return
        if payload is None and not is_bridged:
            self._refuse(query, "It came without content, which no rmw_zenoh sends.")
            return
        content = _NO_FIELDS if payload is None else payload.to_bytes()
        self._queue(_Request(query, content, number, is_bridged))

    def _number_of_bridge(self, attachment: bytes | None) -> Attachment:
        """Return who asks through a bridge; who does not tell is given a number here."""
        number = request_number(attachment)
        if number is None:
            self._unnumbered += 1
            number = Attachment(self._unnumbered, 0, _NOBODY)
        return number

    def _declared(self, key: str, *, is_of_others: bool = False) -> Incoming[Query]:
        room = max(_RING, self._depth)
        return declare_queryable(self.endpoint.wire.zenoh, key, room, is_of_others=is_of_others)

    def _queue(self, request: _Request) -> None:
        with self._lock:
            gone = self._incoming is None  # since the drain took it out of the ring
            refusal = self._refusal(request)
            if not (gone or refusal):
                self._pending[request.number] = request
                self._askers[request.attachment.gid] += 1
                self._waiting.append(request)
            late = self._waiting.popleft() if len(self._waiting) > self._depth else None
        if gone:
            request.query.drop()
        elif refusal:
            self._refuse(request.query, refusal)
        if late is not None:
            self._finish(late)
        self.announce()

    def _refusal(self, request: _Request) -> str | None:
        if request.number in self._pending:
            return "It came twice before it was answered."
        if self._askers[request.attachment.gid] >= PENDING_OF_CLIENT_MAX:
            return f"Its client waits for {PENDING_OF_CLIENT_MAX} answers already."
        if len(self._pending) >= PENDING_MAX:
            return f"Clients wait for {PENDING_MAX} answers already."
        return None

    def _refuse(self, query: Query, reason: str) -> None:
        self._count_refused(reason)
        query.drop()

    def _count_refused(self, reason: str) -> None:
        """Count a request that was not taken, and log the first."""
        if not self.refused:
            get_logger("studio.ros").warning(
                f"A request to {self.service_name} was dropped. {reason}"
            )
        self.refused += 1
        self.reason = reason

    def _answer(self, request: _Request) -> object:
        try:
            asked = self._request_codec.decode(request.payload)
        except CdrError as error:
            self._count_refused(str(error))
            self._finish(request)
            return None
        try:
            given = self.callback(asked, self.srv_type.Response())
            if inspect.iscoroutine(given):
                return self._answer_later(request, given)
            self._reply(request, given)
        except BaseException:
            self._finish(request)
            raise
        return None

    async def _answer_later(self, request: _Request, given: Coroutine[Any, Any, object]) -> None:
        try:
            self._reply(request, await given)
        except asyncio.CancelledError:
            self._count_refused("What its callback awaited was cancelled.")
            raise
        finally:
            self._finish(request)

    def _reply(self, request: _Request, given: object) -> None:
        payload = self._response_codec.encode(check_kind(self._response, given))
        number = request.attachment
        attachment = None
        if not request.is_bridged:
            attachment = packed(number.sequence, time.time_ns(), number.gid)
        try:
            request.query.reply(request.query.key_expr, payload, attachment=attachment)
        except (ZError, RuntimeError):  # RuntimeError: another thread drops it just now
            if self._incoming is not None:  # else it was taken back while the callback ran
                raise
        self._finish(request)

    def _finish(self, request: _Request) -> None:
        with self._lock:
            known = self._pending.pop(request.number, None)
            if known is not None:
                self._forget_asker(request.attachment.gid)
        if known is not None:
            request.query.drop()

    def _forget_asker(self, gid: bytes) -> None:
        self._askers[gid] -= 1
        if not self._askers[gid]:
            del self._askers[gid]
