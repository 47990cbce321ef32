from __future__ import annotations

from collections import deque
from functools import partial
from typing import TYPE_CHECKING

import pytest
from websockets.exceptions import ConnectionClosed

from studio.protocol.roles import Role
from tests.support.web_server import TOKEN, running_web

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.network


def test_logging_out_ends_every_cookie_and_websocket_and_the_printed_address_leads_in_again(
    assets_folder: Path,
):
    with running_web(assets_folder) as web, web.client(headers={"origin": web.origin}) as page:
        page.get(f"/?token={TOKEN}")
        with web.websocket("/control", Role.GUEST) as lane, web.client(Role.GUEST) as viewer:
            assert viewer.post("/api/log-out").status_code == 403
            assert page.post("/api/log-out").status_code == 204
            with pytest.raises(ConnectionClosed):
                deque(iter(partial(lane.recv, timeout=60), None), maxlen=0)
            for client in (page, viewer):
                assert client.get("/api/health").status_code == 403
        page.get(f"/?token={TOKEN}")
        assert page.get("/api/health").status_code == 200
