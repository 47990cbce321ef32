from __future__ import annotations

import json
import struct
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, Any

import httpx2
import pytest

from studio.protocol.roles import Role
from tests.support.hearers import read_frame
from tests.support.small_engine import FLOOD

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

    from websockets.sync.connection import Connection

    from tests.support.hearers import Came
    from tests.support.web_server import RunningWeb

LENGTH = struct.Struct("<I")
TABS, STREAMS, CONNECTIONS = 8, 3, 6
"""Open tabs, those with a bulk lane, and connections that a browser has to one address."""


def ask_key(lane: Connection) -> str:
    lane.send('{"type": "ask_bulk"}')
    told: dict[str, Any] = json.loads(lane.recv(timeout=60))
    assert told["type"] == "bulk_key"
    return told["key"]


@contextmanager
def bulk_lane(web: RunningWeb, key: str, role: Role = Role.GUEST) -> Generator[httpx2.Response]:
    with web.client(role) as client, client.stream("GET", "/bulk", params={"key": key}) as answer:
        assert answer.status_code == 200
        yield answer


def frames(answer: httpx2.Response) -> Iterator[tuple[int, list[Came]]]:
    """What comes, as it comes, whatever the pieces."""
    held = b""
    for piece in answer.iter_raw():
        held += piece
        while len(held) >= 4 and len(held) - 4 >= LENGTH.unpack_from(held)[0]:
            end = 4 + LENGTH.unpack_from(held)[0]
            frame, held = held[4:end], held[end:]
            yield read_frame(frame)
    assert held == b"", "the stream ended within a frame"


def number(came: Came) -> int:
    return int(came.payload.rstrip(b"\0"))


def is_newest(came: Came) -> bool:
    return came.channel == 2 and number(came) == FLOOD - 1


def flood(lane: Connection) -> list[Came]:
    """Have the studio send it all; gives what comes on the data lane."""
    lane.send('{"type": "subscribe", "subscription": 1, "topic": "/flood", "mode": "every"}')
    found: list[Came] = []
    while isinstance(message := lane.recv(timeout=60), bytes):
        found += read_frame(message)[1]
    return found


@pytest.mark.parametrize("role", list(Role))
def test_whoever_may_look_gets_a_large_message_on_the_data_lane_and_the_next_ones_here(
    web: RunningWeb, role: Role
):
    with web.websocket("/data", role) as lane, bulk_lane(web, ask_key(lane), role) as bulk:
        assert [(one.channel, number(one)) for one in flood(lane)] == [(1, 0), (2, 0)]
        assert any(is_newest(one) for _, came in frames(bulk) for one in came)


def test_only_the_key_of_an_open_data_lane_opens_it(web: RunningWeb):
    with web.websocket("/data") as lane:
        key = ask_key(lane)
        assert ask_key(lane) == key
    with web.client(Role.PRESENTER) as client:
        for wrong in ("", "x", key[:-1]):
            refused = client.get("/bulk", params={"key": wrong})
            assert (refused.status_code, refused.json()["kind"]) == (403, "UnknownLaneError")
        while client.get("/bulk", params={"key": key}).status_code != 403:
            pass  # the studio sees at its own time that the lane was closed


def test_the_key_alone_opens_nothing(web: RunningWeb):
    with web.websocket("/data") as lane, web.client() as stranger:
        assert stranger.get("/bulk", params={"key": ask_key(lane)}).status_code == 403


def test_a_slow_reader_is_owed_little_and_gets_the_newest_and_is_told_what_it_missed(
    web: RunningWeb,
):
    with web.websocket("/data") as lane, bulk_lane(web, ask_key(lane)) as bulk:
        flood(lane)
        every: list[int] = []
        newest: list[int] = []
        dropped = 0
        for count, came in frames(bulk):
            dropped = max(dropped, count)
            every += [number(one) for one in came if one.channel == 1]
            newest += [number(one) for one in came if one.channel == 2]
            if len(every) + dropped == FLOOD - 1 and newest[-1:] == [FLOOD - 1]:
                break
        assert 0 < dropped < FLOOD
        assert every[-1] == FLOOD - 1
        assert every == sorted(every)
        assert newest == sorted(newest)


def test_small_messages_wait_for_no_large_ones(web: RunningWeb):
    with web.websocket("/data") as lane, bulk_lane(web, ask_key(lane)):
        flood(lane)
        assert len(flood(lane)) == 0
        lane.send('{"type": "unsubscribe", "subscription": 1}')
        assert json.loads(lane.recv(timeout=60))["type"] == "not_subscribed"


def test_it_ends_with_its_data_lane(web: RunningWeb):
    with web.websocket("/data") as lane, bulk_lane(web, ask_key(lane)) as bulk:
        lane.close()
        assert list(frames(bulk)) == []


def test_who_reads_slowly_is_not_waited_for_at_the_end(
    web: RunningWeb, caplog: pytest.LogCaptureFixture
):
    with web.websocket("/data") as lane, bulk_lane(web, ask_key(lane)) as bulk:
        flood(lane)
        lane.close()
        with pytest.raises(httpx2.TransportError):
            list(frames(bulk))
    assert caplog.messages == []


def test_another_one_takes_its_place(web: RunningWeb):
    with (
        web.websocket("/data") as lane,
        bulk_lane(web, ask_key(lane)) as first,
        bulk_lane(web, ask_key(lane)) as second,
    ):
        assert list(frames(first)) == []
        flood(lane)
        assert any(is_newest(one) for _, came in frames(second) for one in came)


def test_once_it_is_closed_large_messages_come_on_the_data_lane_again(web: RunningWeb):
    with web.websocket("/data") as lane:
        with bulk_lane(web, ask_key(lane)):
            flood(lane)
        came = flood(lane)
        while not any(is_newest(one) for one in came):
            came = flood(lane)  # the studio sees at its own time that it was closed


def test_eight_tabs_of_one_browser_still_save_and_load_while_three_have_one(web: RunningWeb):
    limits = httpx2.Limits(max_connections=CONNECTIONS)
    headers = {"cookie": web.cookie(Role.PRESENTER), "origin": web.origin}
    with ExitStack() as stack:
        lanes = [stack.enter_context(web.websocket("/data")) for _ in range(TABS)]
        browser = stack.enter_context(
            httpx2.Client(
                base_url=web.origin, headers=headers, limits=limits, timeout=60, trust_env=False
            )
        )
        for lane in lanes[:STREAMS]:
            opened = browser.stream("GET", "/bulk", params={"key": ask_key(lane)})
            stack.enter_context(opened)
            flood(lane)  # and nobody reads it

        def save_and_load(_: int) -> tuple[int, int]:
            command = {"type": "zero_joints", "document": "small"}
            saved = browser.post("/api/commands", json=command)
            return saved.status_code, browser.get("/d/small").status_code

        with ThreadPoolExecutor(TABS) as tabs:
            assert set(tabs.map(save_and_load, range(TABS))) == {(200, 200)}
