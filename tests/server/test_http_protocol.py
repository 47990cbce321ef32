"""Strangers with raw sockets: each costs little memory and time, and the presenter has room."""

from __future__ import annotations

import contextlib
import select
import socket
import sys
import time
from typing import TYPE_CHECKING

import pytest

from studio.protocol.roles import Role
from studio.server.crowd import STRANGER_S, Crowd
from tests.support.strangers import dialled, handshake, pour, resident_bytes, until_end
from tests.support.web_server import running_web

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.support.web_server import RunningWeb

pytestmark = [pytest.mark.network, pytest.mark.timeout(120)]

MB = 1 << 20
HEAD = b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n"
POURED_BYTES = 32 * MB


@pytest.fixture
def hurried(assets_folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[RunningWeb]:
    """A server that gives strangers half a second."""
    monkeypatch.setattr("studio.server.http_protocol.STRANGER_S", 0.5)
    with running_web(assets_folder) as running:
        yield running


def test_a_stranger_has_ten_seconds():
    assert STRANGER_S == 10


@pytest.mark.parametrize(
    ("begin", "part"),
    [
        (b"GET /", b"x" * 65_536),
        (HEAD + b"X: ", b"x" * 65_536),
        (HEAD + b"X", b"x" * 65_536),
        (HEAD, b"X: y\r\n" * 10_000),
        (HEAD, (b"X: " + b"y" * 8_000 + b"\r\n") * 8),
        (HEAD + b"Transfer-Encoding: chunked\r\n\r\n0\r\nX: ", b"x" * 65_536),
        (HEAD + b"Cookie: ", b"a=b; " * 10_000),
        (b"", b"GET / HTTP/1.1\r\nHost: x\r\n\r\n" * 2_000),
        (b"POST / HTTP/1.1\r\nContent-Length: 99999999999\r\n\r\n", b"x" * 65_536),
        (b"POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n", b"1\r\nx\r\n" * 10_000),
    ],
    ids=[
        "address",
        "value",
        "name",
        "headers",
        "long",
        "trailer",
        "cookie",
        "many",
        "body",
        "chunks",
    ],
)
@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_what_does_not_end_is_not_read_for_long(web: RunningWeb, begin: bytes, part: bytes):
    before = resident_bytes()
    with dialled(web) as stranger:
        stranger.sendall(begin)
        taken = pour(stranger, part, POURED_BYTES)
        assert taken < POURED_BYTES / 2
    assert resident_bytes() - before < 8 * MB


@pytest.mark.parametrize(
    ("head", "status"),
    [
        (b"GET /" + b"x" * 20_000 + b" HTTP/1.1\r\nHost: x\r\n\r\n", 414),
        (HEAD + b"X: " + b"y" * 100_000 + b"\r\n\r\n", 431),
        (HEAD + b"X: y\r\n" * 150 + b"\r\n", 431),
        (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc", 400),
    ],
)
def test_a_head_that_is_too_large_or_none_is_told_so(web: RunningWeb, head: bytes, status: int):
    with dialled(web) as stranger:
        stranger.sendall(head)
        assert until_end(stranger).startswith(b"HTTP/1.1 %d " % status)


@pytest.mark.parametrize(
    "said",
    [b"", b"GE", HEAD, b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 9\r\n\r\n", b"\r\n"],
    ids=["nothing", "method", "head", "body", "line"],
)
def test_who_says_too_little_is_let_go(hurried: RunningWeb, said: bytes):
    with dialled(hurried) as stranger:
        stranger.sendall(said)
        until_end(stranger)  # it ends, though nothing more is said


def test_who_says_a_byte_now_and_then_is_let_go(hurried: RunningWeb):
    with dialled(hurried) as stranger:
        began_s = time.monotonic()
        stranger.sendall(HEAD + b"X: ")
        with contextlib.suppress(ConnectionError):
            while not select.select([stranger], [], [], 0.05)[0]:
                stranger.sendall(b"x")
        assert time.monotonic() - began_s < 30


def test_who_asks_for_files_again_and_again_is_let_go(hurried: RunningWeb):
    with dialled(hurried) as stranger:
        stranger.sendall(b"GET /favicon.ico HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        assert b"connection: close" in until_end(stranger)


def test_who_has_the_key_keeps_the_connection(hurried: RunningWeb):
    with hurried.client(Role.GUEST) as client:
        for _ in range(2):
            answer = client.get("/api/health")
            assert "connection" not in answer.headers
    asked = (
        f"GET /api/health HTTP/1.1\r\nHost: 127.0.0.1:{hurried.port}\r\n"
        f"Cookie: {hurried.cookie(Role.GUEST)}\r\n\r\n"
    )
    with dialled(hurried) as viewer:
        viewer.sendall(asked.encode())
        assert viewer.recv(65_536).startswith(b"HTTP/1.1 200")
        readable, _, _ = select.select([viewer], [], [], 1.0)  # twice what a stranger has
        assert not readable
        viewer.sendall(b"GET /api/he")  # and a slow head has no more time than a stranger's
        until_end(viewer)


@pytest.mark.parametrize("more", ["X: " + "y" * 9_000, *["\r\n".join(["X: y"] * 99)]])
def test_a_websocket_s_head_that_is_not_read_ends_the_connection(web: RunningWeb, more: str):
    with dialled(web) as stranger:
        stranger.sendall(handshake(web, "/control", None, more))
        until_end(stranger)


def test_silent_strangers_take_no_room_from_who_has_the_key(web: RunningWeb):
    with contextlib.ExitStack() as held:
        most = Crowd().strangers_max
        silent = [held.enter_context(dialled(web)) for _ in range(most + 100)]
        with web.client(Role.PRESENTER) as client:
            assert client.get("/api/health").status_code == 200
        with web.websocket("/control") as lane:
            assert lane.recv(timeout=60)
        assert sum(is_open(one) for one in silent) <= most


def is_open(one: socket.socket) -> bool:
    """Whether the server still holds it."""
    one.setblocking(False)
    try:
        return one.recv(1) != b""
    except BlockingIOError:
        return True
    except ConnectionError:
        return False


def test_refused_strangers_cost_one_line(web: RunningWeb, caplog: pytest.LogCaptureFixture):
    for said in (b"\x16\x03\x01", b"nonsense\r\n\r\n", handshake(web, "/control", None)) * 10:
        with dialled(web) as stranger:
            stranger.sendall(said)
            until_end(stranger)
    assert len(caplog.records) <= 1


def test_who_leaves_in_the_middle_costs_no_line(web: RunningWeb, caplog: pytest.LogCaptureFixture):
    cookie = f"Cookie: {web.cookie(Role.PRESENTER)}\r\nOrigin: {web.origin}\r\n"
    body = f"Host: 127.0.0.1:{web.port}\r\n{cookie}Content-Length: 10\r\n\r\nab"
    leaving = [
        f"POST /api/commands HTTP/1.1\r\n{body}".encode(),
        f"POST /api/uploads HTTP/1.1\r\n{body}".encode(),
        *(handshake(web, path, Role.GUEST) for path in ("/control", "/data", "/d/small/viser")),
        handshake(web, "/d/gone/viser", Role.GUEST),
    ]
    for said in leaving * 3:
        with dialled(web) as one:
            one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
            one.sendall(said)
            select.select([one], [], [], 0.05)  # at different moments
    with dialled(web) as one:
        one.sendall(handshake(web, "/d/gone/viser", Role.GUEST))
        assert until_end(one).startswith(b"HTTP/1.1 404")
    with web.client(Role.GUEST) as client:
        assert client.get("/api/health").status_code == 200
    assert [one.getMessage() for one in caplog.records] == []
