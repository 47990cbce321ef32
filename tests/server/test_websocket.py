from __future__ import annotations

import asyncio
import contextlib
import json
import socket
import sys
import threading
import time
from typing import TYPE_CHECKING

import pytest
from websockets.exceptions import InvalidStatus
from websockets.frames import Frame, Opcode

from studio.protocol.roles import Role
from studio.server.commands import COMMAND_LIMIT_BYTES
from studio.server.crowd import VIEWER_CONNECTIONS_MAX
from studio.server.websocket import VIEWER_MESSAGE_LIMIT_BYTES, Framer, hold_little
from tests.support.strangers import frame, pour, raw_websocket, resident_bytes, until_end

if TYPE_CHECKING:
    from websockets.sync.connection import Connection

    from tests.support.web_server import RunningWeb

MB = 1 << 20
LANES = ["/control", "/data", "/d/small/viser"]


@pytest.mark.parametrize("length", [0, 1, 125, 126, 65_535, 65_536, 200_000])
@pytest.mark.parametrize("binary", [True, False])
def test_a_frame_is_as_the_websocket_library_writes_it(length: int, binary: bool):
    payload = b"x" * length
    expected = Frame(Opcode.BINARY if binary else Opcode.TEXT, payload).serialize(mask=False)
    assert Framer().frame(payload, binary=binary) == expected


def test_of_a_message_to_many_one_frame_is_made():
    framer, payload = Framer(), b"a message"
    first = framer.frame(payload, binary=True)
    assert framer.frame(payload, binary=True) is first
    assert framer.frame(payload, binary=False) != first
    assert framer.frame(b"another", binary=True).endswith(b"another")


@pytest.mark.network
@pytest.mark.skipif(not hasattr(socket, "TCP_NOTSENT_LOWAT"), reason="the system has no such limit")
def test_what_a_browser_does_not_take_waits_with_us_where_what_is_newer_replaces_it():
    async def scenario() -> None:
        arrived: asyncio.Future[asyncio.StreamWriter] = asyncio.Future()
        listener = await asyncio.start_server(lambda _, to: arrived.set_result(to), "127.0.0.1", 0)
        deaf = socket.create_connection(listener.sockets[0].getsockname())
        writer = await arrived
        hold_little(writer.transport)
        for _ in range(64):
            writer.write(bytes(MB // 16))
            await asyncio.sleep(0)
        assert writer.transport.get_write_buffer_size() > 3 * MB
        writer.transport.abort()
        deaf.close()
        listener.close()

    asyncio.run(scenario())


def closing(code: int) -> bytes:
    """How a closing frame from the server begins, after its length."""
    return code.to_bytes(2, "big")


def slowest_answer_s(lane: Connection, flood: threading.Thread) -> float:
    """How long the slowest of the presenter's commands waited while somebody floods."""
    slowest_s = 0.0
    flood.start()
    for number in range(20):
        began_s = time.monotonic()
        lane.send(json.dumps({"type": "watch", "request": number + 1, "document": "small"}))
        while True:
            heard = json.loads(lane.recv(timeout=60))
            if heard.get("request") == number + 1:
                break
        slowest_s = max(slowest_s, time.monotonic() - began_s)
    return slowest_s


@pytest.mark.network
@pytest.mark.parametrize(
    "part",
    [
        frame(Opcode.CONT, b"x", final=False),
        frame(Opcode.PING, b"x"),
        frame(Opcode.PONG),
        frame(Opcode.TEXT, b"{}"),
    ],
    ids=["fragments", "pings", "pongs", "commands"],
)
def test_a_viewer_s_flood_of_frames_holds_up_no_presenter(web: RunningWeb, part: bytes):
    with contextlib.ExitStack() as opened:
        viewers = [opened.enter_context(raw_websocket(web, "/control")) for _ in range(3)]
        lane = opened.enter_context(web.websocket("/control"))
        for one in viewers:
            one.sendall(frame(Opcode.BINARY, b"x", final=False) if part[0] == 0 else b"")
            one.settimeout(0.5)
        end = threading.Event()

        def flood() -> None:
            with contextlib.suppress(OSError):
                while not end.is_set():
                    for one in viewers:
                        one.send(part * 10_000)

        thread = threading.Thread(target=flood)
        try:
            slowest_s = slowest_answer_s(lane, thread)
        finally:
            end.set()
            thread.join(60)
        assert slowest_s < 1.0


@pytest.mark.network
@pytest.mark.parametrize("path", LANES)
@pytest.mark.parametrize(
    ("role", "limit_bytes"),
    [(Role.GUEST, VIEWER_MESSAGE_LIMIT_BYTES), (Role.PRESENTER, COMMAND_LIMIT_BYTES)],
)
def test_a_message_that_is_too_large_is_refused_before_it_is_read(
    web: RunningWeb, path: str, role: Role, limit_bytes: int
):
    whole = frame(Opcode.BINARY, bytes(limit_bytes + 1))
    with raw_websocket(web, path, role) as opened:
        opened.sendall(whole[:20])  # its length is known by now
        assert closing(1009) in until_end(opened)
    with raw_websocket(web, path, role) as opened:
        opened.sendall(frame(Opcode.BINARY, bytes(limit_bytes // 2 + 1), final=False))
        opened.sendall(frame(Opcode.CONT, bytes(limit_bytes // 2 + 1))[:20])
        assert closing(1009) in until_end(opened)


@pytest.mark.network
def test_a_presenter_s_command_of_nearly_a_megabyte_is_answered(web: RunningWeb):
    with web.websocket("/control") as lane:
        lane.send(json.dumps({"type": "none", "request": 5, "a": "x" * (COMMAND_LIMIT_BYTES - 50)}))
        heard = [json.loads(lane.recv(timeout=60)) for _ in range(3)]
        assert heard[-1]["type"] == "refused"


@pytest.mark.network
@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_unfinished_messages_take_little_memory(web: RunningWeb):
    before = resident_bytes()
    with contextlib.ExitStack() as opened:
        for _ in range(10):
            one = opened.enter_context(raw_websocket(web, "/control"))
            one.settimeout(0.2)
            one.sendall(frame(Opcode.TEXT, b"x", final=False))
            with contextlib.suppress(TimeoutError):
                pour(one, frame(Opcode.CONT, bytes(4_000), final=False), 8 * MB)
        assert resident_bytes() - before < 20 * MB


@pytest.mark.network
@pytest.mark.parametrize("final", [True, False])
def test_a_message_of_very_many_fragments_is_refused(web: RunningWeb, final: bool):
    with raw_websocket(web, "/control", Role.PRESENTER) as opened:
        opened.sendall(frame(Opcode.TEXT, b"{", final=False))
        opened.sendall(frame(Opcode.CONT, b"", final=False) * 2_000)
        if final:
            opened.sendall(frame(Opcode.CONT, b"}"))
        assert closing(1009) in until_end(opened)


@pytest.mark.network
@pytest.mark.parametrize("path", LANES)
def test_text_that_is_none_ends_the_websocket_without_a_line(
    web: RunningWeb, path: str, caplog: pytest.LogCaptureFixture
):
    with raw_websocket(web, path) as opened:
        opened.sendall(frame(Opcode.TEXT, b"\xff\xfe"))
        assert closing(1007) in until_end(opened)
    assert caplog.messages == []


@pytest.mark.network
@pytest.mark.parametrize(
    "said", [b"\xff\xff", b"\x81\x00", b"\x88\x81\0\0\0\0\0", b"\x83\x80\0\0\0\0"]
)
def test_what_is_no_websocket_is_ended_without_a_line(
    web: RunningWeb, said: bytes, caplog: pytest.LogCaptureFixture
):
    with raw_websocket(web, "/control") as opened:
        opened.sendall(said)
        assert closing(1002) in until_end(opened)
    assert caplog.messages == []


@pytest.mark.network
def test_a_viewer_who_opens_too_many_websockets_is_refused_and_the_presenter_is_not(
    web: RunningWeb,
):
    cookie = {"Cookie": web.cookie(Role.GUEST)}
    with contextlib.ExitStack() as opened:
        for _ in range(VIEWER_CONNECTIONS_MAX):
            opened.enter_context(web.websocket("/control", None, headers=cookie))
        with pytest.raises(InvalidStatus) as refused:
            opened.enter_context(web.websocket("/control", None, headers=cookie))
        assert refused.value.response.status_code == 503
        for role in Role:  # another viewer, and the presenter
            opened.enter_context(web.websocket("/control", role))
