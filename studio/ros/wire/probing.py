"""What answers at an endpoint: nothing, Zenoh, or something else that holds the port."""

from __future__ import annotations

import secrets
import socket
import time
from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from studio.ros.wire.endpoints import Endpoint

CONNECT_TIMEOUT_S = 3.0
ANSWER_TIMEOUT_S = 4.0
_HANG_UPS_MAX = 4
_HANG_UP_PAUSE_S = 0.2
_INIT = 0x01
_IS_ANSWER = 0x20
_CLOSE = 0x03
_MESSAGE_ID = 0x1F
_PROTOCOL_VERSION = 9
# A client (2) with an id of 16 bytes, one less than which stands in the upper half.
_CLIENT_WITH_LONG_ID = 0xF2


class Answer(StrEnum):
    """What was found at an endpoint."""

    NOBODY = "nobody"
    ZENOH = "zenoh"
    OTHER = "other"
    TLS = "tls"
    """Something is there, behind TLS, where only Zenoh itself can look."""
    UNKNOWN = "unknown"
    """There is no looking without Zenoh."""


def probe(endpoint: Endpoint) -> Answer:
    """Knock at an endpoint and leave; takes 7 s at most, and 1 ms for a router of this machine."""
    if not endpoint.is_stream:
        return Answer.UNKNOWN
    for left in reversed(range(_HANG_UPS_MAX)):
        answer = _knock(endpoint)
        if answer is not None:
            return answer
        if left:
            time.sleep(_HANG_UP_PAUSE_S)
    return Answer.OTHER


def _knock(endpoint: Endpoint) -> Answer | None:
    """Knock once; None when somebody hung up without a word, as a router does that is ending."""
    try:
        link = socket.create_connection((endpoint.host, endpoint.port), CONNECT_TIMEOUT_S)
    except OSError:
        return Answer.NOBODY
    with link:
        if link.getsockname() == link.getpeername():
            return Answer.NOBODY  # a port that nobody holds may be lent to the one who asks for it
        if endpoint.protocol == "tls":
            return Answer.TLS
        return _answer_on(link)


def _answer_on(link: socket.socket) -> Answer | None:
    """Send the first message of Zenoh's handshake; only Zenoh knows the second."""
    link.settimeout(ANSWER_TIMEOUT_S)
    message = bytes((_INIT, _PROTOCOL_VERSION, _CLIENT_WITH_LONG_ID)) + secrets.token_bytes(16)
    try:
        link.sendall(len(message).to_bytes(2, "little") + message)
        answer = link.recv(3, socket.MSG_WAITALL)
    except TimeoutError:
        return Answer.OTHER
    except OSError:
        return None
    if not answer:
        return None
    return Answer.ZENOH if _is_zenoh(answer) else Answer.OTHER


def _is_zenoh(answer: bytes) -> bool:
    if len(answer) < 3:
        return False
    length, kind = int.from_bytes(answer[:2], "little"), answer[2] & _MESSAGE_ID
    # A router that wants a name and password hangs up on who gives none, and says so.
    hung_up = kind == _CLOSE and length == 2
    return hung_up or (kind == _INIT and bool(answer[2] & _IS_ANSWER))
