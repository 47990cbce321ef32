"""A look at an endpoint tells a router from nobody and from any other program."""

from __future__ import annotations

import socket
import socketserver
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, cast

import pytest

from studio.ros.wire.endpoints import ProbeResult, parse_endpoint, probe
from tests.support.wire import free_endpoint, open_test_session, running_router

if TYPE_CHECKING:
    from collections.abc import Generator


def looked_at(endpoint: str) -> ProbeResult:
    return probe(parse_endpoint(endpoint))


@contextmanager
def program_that_says(words: bytes) -> Generator[str]:
    """Anything that listens, says something to whoever comes, and hangs up."""

    class Speaker(socketserver.BaseRequestHandler):
        def handle(self) -> None:
            link = cast("socket.socket", self.request)
            link.recv(1000)
            link.sendall(words)

    with socketserver.TCPServer(("127.0.0.1", 0), Speaker) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.01,))
        thread.start()
        yield f"tcp/127.0.0.1:{server.server_address[1]}"
        server.shutdown()
        thread.join()


def test_nobody_is_where_nobody_listens():
    assert looked_at(free_endpoint()) is ProbeResult.NOBODY


def test_a_router_answers_and_goes_on_as_before():
    with running_router() as endpoint:
        assert [looked_at(endpoint) for _ in range(3)] == [ProbeResult.ZENOH] * 3
        with open_test_session(endpoint) as wire:
            assert len(list(wire.zenoh.info.routers_zid())) == 1


@pytest.mark.parametrize(
    "words",
    [
        b"",
        b"H",
        b"HTTP/1.1 400 Bad Request\r\n\r\n",
        b"SSH-2.0-OpenSSH_9.6\r\n",
        b"\x13\x00\x01\x09\xf2" + bytes(16),
        bytes(300),
    ],
    ids=["silence", "a letter", "HTTP", "SSH", "an echo", "zeros"],
)
def test_any_other_program_is_no_router(words: bytes):
    with program_that_says(words) as endpoint:
        assert looked_at(endpoint) is ProbeResult.OTHER


@pytest.mark.parametrize("endpoint", ["udp/127.0.0.1:7447", "unixsock-stream//tmp/none"])
def test_of_what_is_no_stream_nothing_is_known(endpoint: str):
    assert looked_at(endpoint) is ProbeResult.UNKNOWN


def test_who_hung_up_because_it_ended_is_nobody():
    """As a router in its last moments: whoever knocks meanwhile is not told of a stranger."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        endpoint = f"tcp/127.0.0.1:{listening.getsockname()[1]}"

        def end() -> None:
            link, _ = listening.accept()
            listening.close()
            link.close()

        thread = threading.Thread(target=end)
        thread.start()
        assert looked_at(endpoint) is ProbeResult.NOBODY
        thread.join()


def test_behind_tls_only_zenoh_can_look():
    with program_that_says(b"") as endpoint:
        assert looked_at(endpoint.replace("tcp/", "tls/")) is ProbeResult.TLS
