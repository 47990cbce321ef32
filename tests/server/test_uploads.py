from __future__ import annotations

import socket
import sys
from typing import TYPE_CHECKING

import pytest

from studio.protocol.roles import Role
from tests.support.small_engine import SmallUploads
from tests.support.strangers import pour, resident_bytes
from tests.support.studio_page import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.support.web_server import RunningWeb


@pytest.fixture(autouse=True)
def _nothing_sent(web: RunningWeb) -> None:
    web.engine.uploads = SmallUploads()


def test_the_first_line_announces_and_the_rest_is_bytes(web: RunningWeb):
    with web.client(Role.PRESENTER) as client:
        answer = client.post("/api/uploads", content=b"[names]\nfirst\nsecond")
        assert (answer.status_code, answer.json()) == (200, {"document": "small"})
    assert web.engine.uploads.taken == [(b"[names]", b"first\nsecond")]


def test_a_body_in_many_pieces_is_put_together(web: RunningWeb):
    def pieces() -> Iterator[bytes]:
        yield b"[na"
        yield b"mes]\n"
        for _ in range(50):
            yield bytes(10_000)

    with web.client(Role.PRESENTER) as client:
        assert client.post("/api/uploads", content=pieces()).status_code == 200
    assert web.engine.uploads.taken == [(b"[names]", bytes(500_000))]


def test_a_refusal_comes_as_a_sentence_after_all_was_read(web: RunningWeb):
    with web.client(Role.PRESENTER) as client:
        answer = client.post("/api/uploads", content=b"refuse\n" + bytes(3 << 20))
        assert answer.status_code == 409
        assert answer.json() == {
            "kind": "UploadError",
            "reason": "Nothing was uploaded: the small engine is in no mood.",
        }


@pytest.mark.parametrize("body", [b"", b"no line", bytes(5 << 20)])
def test_a_body_without_its_first_line_is_refused(web: RunningWeb, body: bytes):
    with web.client(Role.PRESENTER) as client:
        answer = client.post("/api/uploads", content=body)
        assert answer.status_code == 409
        assert "list of files is missing" in answer.json()["reason"]


@pytest.mark.parametrize("role", [Role.HELPER, Role.STUDENT, Role.GUEST, None])
def test_nobody_but_the_presenter_sends_anything_though_they_had_control(
    web: RunningWeb, role: Role | None
):
    with web.client(role) as client, web.in_control(role or Role.PRESENTER):
        assert client.post("/api/uploads", content=b"[]\n").status_code == 403
    assert web.engine.uploads.taken == []


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.parametrize(
    ("path", "status"), [("/api/uploads", 403), ("/api/commands", 422), ("/join", 200)]
)
def test_of_a_students_body_without_end_nothing_is_kept(web: RunningWeb, path: str, status: int):
    head = (
        f"POST {path} HTTP/1.1\r\nHost: 127.0.0.1:{web.port}\r\nOrigin: {web.origin}\r\n"
        f"Cookie: {web.cookie(Role.STUDENT)}\r\nContent-Length: {1 << 40}\r\n\r\n"
    )
    before = resident_bytes()
    with socket.create_connection(("127.0.0.1", web.port), timeout=60) as line:
        line.sendall(head.encode())
        pour(line, bytes(1 << 16), 128 << 20)
        assert line.recv(12) == f"HTTP/1.1 {status}".encode()
        assert resident_bytes() - before < 32 << 20
    assert web.engine.uploads.taken == []


def test_another_site_sends_nothing_with_our_cookie(web: RunningWeb):
    headers = {"cookie": web.cookie(Role.PRESENTER), "origin": "http://evil.example"}
    with web.client(headers=headers) as client:
        assert client.post("/api/uploads", content=b"[]\n").status_code == 403
    assert web.engine.uploads.taken == []


def test_who_goes_away_in_the_middle_has_sent_nothing(web: RunningWeb):
    head = (
        f"POST /api/uploads HTTP/1.1\r\nHost: 127.0.0.1:{web.port}\r\nOrigin: {web.origin}\r\n"
        f"Cookie: {web.cookie(Role.PRESENTER)}\r\nContent-Length: 1000\r\n\r\n[names]\nhalf"
    )
    with socket.create_connection(("127.0.0.1", web.port)) as line:
        line.sendall(head.encode())
        wait_until("the sending to begin", lambda: web.engine.uploads.begun > 0)
    wait_until("the sending to end", lambda: web.engine.uploads.broken > 0)
    assert web.engine.uploads.taken == []
