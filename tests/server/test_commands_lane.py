from __future__ import annotations

import json
from collections import deque
from functools import partial
from typing import TYPE_CHECKING, Any

import pytest
from websockets.exceptions import ConnectionClosed

import studio
from studio.protocol.roles import Role
from tests.support.small_engine import FLOOD

if TYPE_CHECKING:
    from websockets.sync.connection import Connection

    from tests.support.web_server import RunningWeb


def say(lane: Connection, **command: object) -> None:
    lane.send(json.dumps(command))


def hear(lane: Connection) -> dict[str, Any]:
    message = lane.recv(timeout=60)
    assert isinstance(message, str), message
    return json.loads(message)


def greet(lane: Connection) -> dict[str, Any]:
    """Hear what comes before any command is given."""
    hello = hear(lane)
    assert hear(lane)["type"] == "documents"
    return hello


@pytest.mark.parametrize("role", list(Role))
def test_the_lane_says_who_you_are_first(web: RunningWeb, role: Role):
    with web.websocket("/control", role) as lane:
        assert hear(lane) == {
            "type": "hello",
            "role": role.value,
            "version": studio.__version__,
            "session": "session",
        }
        assert hear(lane)["documents"][0]["id"] == "small"


def test_a_command_is_carried_out_and_its_number_repeated(web: RunningWeb):
    with web.websocket("/control") as lane:
        greet(lane)
        say(lane, type="get_urdf", request=7, document="small")
        assert hear(lane) == {"type": "urdf", "request": 7, "text": "<robot name='small'/>"}
        assert hear(lane) == {"type": "done", "request": 7}


def test_binary_frames_and_text_keep_their_order(web: RunningWeb):
    with web.websocket("/control") as lane:
        greet(lane)
        say(lane, type="zero_joints", request=1)
        assert [lane.recv(timeout=60) for _ in range(3)] == [b"\x01\x00", b"\x01\x01", b"\x01\x02"]
        assert hear(lane)["type"] == "done"


@pytest.mark.parametrize(
    ("text", "request_number"),
    [
        ("", 0),
        ("nonsense", 0),
        ("[]", 0),
        ("null", 0),
        ('{"request": 3}', 3),
        ('{"type": "no_such", "request": 4}', 4),
        ('{"type": "undo", "request": 5, "extra": 1}', 5),
        ('{"type": "undo", "request": "x"}', 0),
        ('{"type": "edit_site", "request": 6, "site": "a"}', 6),
        ('{"type": "edit_site", "request": 6, "site": "a", "text": "' + "x" * 100_001 + '"}', 6),
        ('{"type": "set_joints", "request": 7, "positions": {"a": NaN}}', 7),
        ('{"type": "set_joints", "request": 8, "positions": {"a": 1e999}}', 8),
        ('{"type": "set_joints", "request": 9, "positions": {"a": "\\ud800"}}', 0),
        ("[" * 100_000, 0),
        (b"\xff\xfe", 0),
    ],
)
def test_a_malformed_command_is_refused_and_the_lane_goes_on(
    web: RunningWeb, text: str | bytes, request_number: int
):
    before = len(web.engine.executed)
    with web.websocket("/control") as lane:
        greet(lane)
        lane.send(text)
        refused = hear(lane)
        assert (refused["type"], refused["kind"]) == ("refused", "CommandError")
        assert refused["request"] == request_number
        assert 10 < len(refused["reason"]) <= 300
        assert "\n" not in refused["reason"]
        assert len(web.engine.executed) == before
        say(lane, type="watch", request=9, document="small")
        assert hear(lane) == {"type": "done", "request": 9}


def test_what_the_engine_refuses_is_an_answer_with_its_kind(web: RunningWeb):
    with web.websocket("/control") as lane:
        greet(lane)
        say(lane, type="save", request=2, document="small")
        refused = hear(lane)
        assert (refused["request"], refused["kind"]) == (2, "SaveConflictError")
        assert "reload it first" in refused["reason"]


def test_a_bug_is_an_answer_and_the_lane_goes_on(web: RunningWeb, caplog: pytest.LogCaptureFixture):
    with web.websocket("/control") as lane:
        greet(lane)
        say(lane, type="undo", request=2)
        assert hear(lane)["kind"] == "InternalError"
        say(lane, type="watch", request=3)
        assert hear(lane)["type"] == "done"
    assert "a bug" in caplog.text


def test_a_command_whose_document_is_closed_meanwhile_is_answered(web: RunningWeb):
    with web.websocket("/control") as lane:
        greet(lane)
        say(lane, type="close_document", request=4, document="small")
        refused = hear(lane)
        assert (refused["request"], refused["kind"]) == (4, "ClosedError")
        say(lane, type="watch", request=5)
        assert hear(lane) == {"type": "done", "request": 5}


def test_a_viewer_is_refused_and_the_engine_hears_nothing(web: RunningWeb):
    before = len(web.engine.executed)
    with web.websocket("/control", Role.GUEST) as lane:
        greet(lane)
        say(lane, type="save", request=2, document="small")
        refused = hear(lane)
        assert (refused["kind"], refused["request"]) == ("NotAllowedError", 2)
    assert len(web.engine.executed) == before


def test_a_slow_command_does_not_hold_up_the_next(web: RunningWeb):
    with web.websocket("/control") as lane:
        greet(lane)
        say(lane, type="redo", request=1)  # waits until `reload`
        say(lane, type="watch", request=2)
        assert hear(lane) == {"type": "done", "request": 2}
        say(lane, type="reload", request=3)
        assert {hear(lane)["request"], hear(lane)["request"]} == {1, 3}


def test_the_engine_forgets_a_lane_that_was_closed(web: RunningWeb):
    with web.websocket("/control") as lane:
        greet(lane)
        assert len(web.engine.listeners) == 1
    with web.websocket("/control") as lane:
        greet(lane)
        assert len(web.engine.listeners) == 1


def test_a_browser_that_does_not_read_is_sent_away_and_others_do_not_notice(web: RunningWeb):
    with web.websocket("/control") as slow, web.websocket("/control") as quick:
        greet(slow)
        greet(quick)
        say(slow, type="randomize_joints", request=1)
        say(quick, type="watch", request=2)
        assert hear(quick) == {"type": "done", "request": 2}
        with pytest.raises(ConnectionClosed) as closed:
            deque(iter(partial(slow.recv, timeout=60), None), maxlen=0)
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1013


def test_a_slow_browser_gets_the_newest_of_a_key(web: RunningWeb):
    with web.websocket("/control") as slow:
        greet(slow)
        say(slow, type="animate_joints", request=1, running=True)
        frames: list[bytes] = []
        while isinstance(message := slow.recv(timeout=60), bytes):
            frames.append(message)
        assert json.loads(message) == {"type": "done", "request": 1}
        assert frames[-1].startswith(b"%d\0" % (FLOOD - 1))
        assert len(frames) < FLOOD
