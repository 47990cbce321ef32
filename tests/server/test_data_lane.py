from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from studio.protocol.roles import Role
from studio.server.assets import Assets
from tests.support.hearers import read_frame
from tests.support.small_engine import FLOOD
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from websockets.sync.connection import Connection

    from tests.support.hearers import Came
    from tests.support.web_server import RunningWeb


def hear(lane: Connection) -> dict[str, Any]:
    text = lane.recv(timeout=60)
    assert isinstance(text, str), text
    return json.loads(text)


@pytest.mark.parametrize("role", list(Role))
def test_whoever_may_look_may_hear(web: RunningWeb, role: Role):
    before = len(web.engine.browser_topics.commands)
    with web.websocket("/data", role) as lane:
        lane.send(
            json.dumps({"type": "subscribe", "subscription": 7, "topic": "/x", "mode": "every"})
        )
        assert hear(lane)["subscription"] == 7
        lane.send(json.dumps({"type": "unsubscribe", "subscription": 7}))
        assert hear(lane)["subscription"] == 7
    assert [one.type for one in web.engine.browser_topics.commands[before:]] == [
        "subscribe",
        "unsubscribe",
    ]


def frames_until_words(lane: Connection) -> Iterator[tuple[int, list[Came]]]:
    while isinstance(message := lane.recv(timeout=60), bytes):
        yield read_frame(message)


def test_a_slow_browser_gets_the_newest_is_told_what_it_missed_and_the_lane_goes_on(
    web: RunningWeb,
):
    flooded = web.engine.browser_topics.flooded
    with web.websocket("/data") as lane:
        lane.send(
            json.dumps({"type": "subscribe", "subscription": 1, "topic": "/flood", "mode": "every"})
        )
        # Nothing is read before: a browser that keeps up misses nothing.
        wait_until("the flood", lambda: web.engine.browser_topics.flooded == flooded + FLOOD)
        frames = list(frames_until_words(lane))
    came = [one for _, messages in frames for one in messages]
    dropped = max(count for count, _ in frames)
    newest = [one.payload.rstrip(b"\0") for one in came if one.channel == 2]
    every = [int(one.payload.rstrip(b"\0")) for one in came if one.channel == 1]
    assert newest[-1] == b"%d" % (FLOOD - 1)
    assert every == sorted(every)
    assert len(every) + dropped == FLOOD
    assert dropped > 0


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[" * 4000,
        '{"type": "subscribe"}',
        '{"type": "subscribe", "subscription": -1, "topic": "/x", "mode": "every"}',
        '{"type": "subscribe", "subscription": 1, "topic": "/x", "mode": "every", "most_hz": 1e9}',
        '{"type": "subscribe", "subscription": 1, "topic": "/x", "mode": "every", "more": 1}',
        '{"type": "unsubscribe", "subscription": "' + "x" * 5000 + '"}',
        b"\xff\xfe",
    ],
)
def test_a_malformed_wish_is_refused_in_a_sentence_and_the_lane_goes_on(
    web: RunningWeb, text: str | bytes
):
    with web.websocket("/data") as lane:
        lane.send(text)
        refused = hear(lane)
        assert refused["type"] == "not_subscribed"
        assert 10 < len(refused["reason"]) <= 300
        lane.send('{"type": "unsubscribe", "subscription": 3}')
        assert hear(lane) == {
            "type": "not_subscribed",
            "subscription": 3,
            "reason": "there is no such topic",
        }


def test_a_worker_may_open_the_lane_and_load_its_scripts_and_nothing_else(
    web: RunningWeb, assets_folder: Path
):
    base = Assets(assets_folder).current().base
    with web.client(Role.GUEST) as client:
        policies = [
            client.get(base + path).headers["content-security-policy"]
            for path in ("workers/data.js", "app/main.js")
        ]
    assert "connect-src 'self'" in policies[0]
    assert policies[0].startswith("default-src 'none'; script-src 'self'")
    assert "connect-src" not in policies[1]
