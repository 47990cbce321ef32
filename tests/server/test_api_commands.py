from __future__ import annotations

import json
import select
import socket
from typing import TYPE_CHECKING

import pytest

from studio.protocol.roles import Role
from studio.server import crowd
from tests.support.web_server import RunningWeb, running_web

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.network
AT_ONCE = 3


class Sparing(crowd.Account):
    """Of whom all but the presenter may send three small commands, and no more."""

    def __init__(self, role: Role) -> None:
        super().__init__(role)
        if role is not Role.PRESENTER:
            self._own = crowd.Allowance(0.001, 1.2 * AT_ONCE)


def test_who_sends_too_many_commands_waits_and_nobody_else_does(
    assets_folder: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(crowd, "Account", Sparing)
    with running_web(assets_folder) as web:
        body = json.dumps({"type": "get_urdf", "document": "small"})
        with web.client(Role.STUDENT) as student, web.client(Role.PRESENTER) as presenter:
            for _ in range(AT_ONCE):
                assert student.post("/api/commands", content=body).status_code == 200
            with socket.create_connection(("127.0.0.1", web.port), timeout=60) as late:
                late.sendall(request(web, body))
                for _ in range(20):
                    assert presenter.post("/api/commands", content=body).status_code == 200
                assert select.select([late], [], [], 0) == ([], [], [])
        assert len(web.engine.executed) == AT_ONCE + 20


def request(web: RunningWeb, body: str) -> bytes:
    """A command of the same student, as it is sent."""
    lines = (
        "POST /api/commands HTTP/1.1",
        f"Host: 127.0.0.1:{web.port}",
        f"Origin: {web.origin}",
        f"Cookie: {web.cookie(Role.STUDENT)}",
        f"Content-Length: {len(body)}",
    )
    return ("\r\n".join(lines) + "\r\n\r\n" + body).encode()
