from __future__ import annotations

import json
import struct
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from studio.engine.roles import Role
from tests.support.hearers import read_frame
from tests.support.small_engine import FLOOD

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

    import httpx2
    from websockets.sync.connection import Connection

    from tests.support.hearers import Came
    from tests.support.web_server import RunningWeb

LENGTH = struct.Struct("<I")
FLOODED = 1 << 20


def ask_key(lane: Connection) -> str:
    lane.send('{"type": "ask_bulk"}')
    told: dict[str, Any] = json.loads(lane.recv(timeout=60))
    assert told["type"] == "bulk_key"
    return told["key"]


@contextmanager
def bulk_lane(web: RunningWeb, key: str, role: Role = Role.VIEWER) -> Generator[httpx2.Response]:
    with web.client(role) as client, client.stream("GET", "/bulk", params={"key": key}) as answer:
        yield answer


def messages(answer: httpx2.Response) -> Iterator[Came]:
    """What comes, as it comes, whatever the pieces."""
    held = b""
    for piece in answer.iter_raw():
        held += piece
        while len(held) >= 4 and len(held) - 4 >= LENGTH.unpack_from(held)[0]:
            end = 4 + LENGTH.unpack_from(held)[0]
            frame, held = held[4:end], held[end:]
            yield from read_frame(frame)[1]


def flood(lane: Connection) -> None:
    lane.send('{"type": "hear", "wish": 1, "topic": "/flood", "mode": "every"}')


def came_on(lane: Connection) -> Iterator[Came]:
    """Until words are said."""
    while isinstance(message := lane.recv(timeout=60), bytes):
        yield from read_frame(message)[1]


@pytest.mark.parametrize("role", list(Role))
def test_whoever_may_look_gets_the_first_large_message_on_the_data_lane_and_then_here(
    web: RunningWeb, role: Role
):
    with web.websocket("/data", role) as lane, bulk_lane(web, ask_key(lane), role) as bulk:
        assert bulk.status_code == 200
        flood(lane)
        first = list(came_on(lane))
        assert sorted(one.channel for one in first) == [1, 2]
        for one in messages(bulk):
            if (one.channel, one.payload.rstrip(b"\0")) == (2, b"%d" % (FLOOD - 1)):
                break
