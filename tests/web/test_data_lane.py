from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from studio.engine.roles import Role

if TYPE_CHECKING:
    from websockets.sync.connection import Connection

    from tests.support.web_server import RunningWeb


def hear(lane: Connection) -> dict[str, Any]:
    text = lane.recv(timeout=60)
    assert isinstance(text, str), text
    return json.loads(text)


@pytest.mark.parametrize("role", list(Role))
def test_whoever_may_look_may_hear(web: RunningWeb, role: Role):
    before = len(web.engine.hearing.wishes)
    with web.websocket("/data", role) as lane:
        lane.send(json.dumps({"type": "hear", "wish": 7, "topic": "/x", "mode": "every"}))
        assert hear(lane)["wish"] == 7
        lane.send(json.dumps({"type": "leave", "wish": 7}))
        assert hear(lane)["wish"] == 7
    assert [one.type for one in web.engine.hearing.wishes[before:]] == ["hear", "leave"]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[" * 4000,
        '{"type": "hear"}',
        '{"type": "hear", "wish": -1, "topic": "/x", "mode": "every"}',
        '{"type": "hear", "wish": 1, "topic": "/x", "mode": "every", "most_hz": 1e9}',
        '{"type": "hear", "wish": 1, "topic": "/x", "mode": "every", "more": 1}',
        '{"type": "leave", "wish": "' + "x" * 5000 + '"}',
        b"\xff\xfe",
    ],
)
def test_a_malformed_wish_is_refused_in_a_sentence_and_the_lane_goes_on(
    web: RunningWeb, text: str | bytes
):
    with web.websocket("/data") as lane:
        lane.send(text)
        refused = hear(lane)
        assert refused["type"] == "not_heard"
        assert 10 < len(refused["reason"]) <= 300
        lane.send('{"type": "leave", "wish": 3}')
        assert hear(lane) == {
            "type": "not_heard",
            "wish": 3,
            "reason": "there is nothing to hear",
        }
