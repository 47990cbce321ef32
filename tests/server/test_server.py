from __future__ import annotations

import signal
from collections import deque
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import TYPE_CHECKING

import httpx2
import pytest
from websockets.exceptions import ConnectionClosed

from studio.protocol.roles import Role
from tests.support.server import running_process

if TYPE_CHECKING:
    from pathlib import Path

    from tests.support.web_server import RunningWeb

SMALL = "tests.support.small_studio"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_with_open_websockets_within_two_seconds(
    assets_folder: Path, tmp_path: Path, number: signal.Signals
):
    with running_process([SMALL, str(assets_folder)], tmp_path / "stderr") as small:
        lane = small.websocket("/control")
        lane.recv(timeout=60)
        lane.send('{"type": "redo"}')  # is still under way at the end
        code, took_s = small.stop(number)
        assert (code, took_s < 2) == (0, True)
        with pytest.raises(ConnectionClosed) as closed:
            deque(iter(partial(lane.recv, timeout=60), None), maxlen=0)
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1012  # restart: the page waits for it to return
        assert small.stderr == ""


@pytest.mark.parametrize("mood", ["stuck", "thread"])
def test_what_does_not_end_is_left_within_two_seconds(
    assets_folder: Path, tmp_path: Path, mood: str
):
    with running_process([SMALL, str(assets_folder), mood], tmp_path / "stderr") as small:
        code, took_s = small.stop()
        assert (code, took_s < 2) == (0, True)
        assert "did not end" in small.stderr


def test_a_request_under_way_does_not_hold_it_up(assets_folder: Path, tmp_path: Path):
    with (
        running_process([SMALL, str(assets_folder)], tmp_path / "stderr") as small,
        small.client() as client,
        ThreadPoolExecutor(1) as pool,
    ):
        waits = pool.submit(client.post, "/api/commands", content='{"type": "redo"}')
        _, took_s = small.stop()
        assert took_s < 2
        assert isinstance(waits.exception(60), httpx2.TransportError) or waits.result().is_error


def test_no_token_is_written_to_the_log(assets_folder: Path, tmp_path: Path):
    with running_process([SMALL, str(assets_folder)], tmp_path / "stderr") as small:
        with small.client() as client:
            assert client.get("/d/small").status_code == 200
        small.stop()
        assert small.stderr == ""


def test_messages_are_not_deflated(web: RunningWeb):
    with web.websocket("/control", Role.GUEST) as lane:
        assert lane.response is not None
        assert "Sec-WebSocket-Extensions" not in lane.response.headers
