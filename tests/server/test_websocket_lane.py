"""Browsers that read nothing any more, or are gone unsaid: each ends, and holds up nobody."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from studio.outlet import GATE_BYTES
from tests.support.deaf_browser import deaf_browser
from tests.support.small_engine import FLOOD
from tests.support.web_server import running_web
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.support.web_server import RunningWeb

pytestmark = [pytest.mark.network, pytest.mark.timeout(120)]

FLOODED = {"type": "subscribe", "subscription": 1, "topic": "/flood", "mode": "every"}
MESSAGE_BYTES = 1 << 20
"""Each of the flood, of which two go out in one frame."""
LARGEST_FRAME = 3 * MESSAGE_BYTES


@pytest.fixture
def impatient(assets_folder: Path) -> Iterator[RunningWeb]:
    """A server that asks browsers again and again whether they are there."""
    with running_web(assets_folder, patience_s=5.0) as running:
        yield running


def test_a_browser_that_reads_nothing_costs_little_and_is_given_up_unanswered(
    impatient: RunningWeb,
):
    web = impatient
    with web.websocket("/data") as other, deaf_browser(web, "/data") as deaf:
        deaf.say(**FLOODED)
        wait_until("both to be there", lambda: len(web.engine.browser_topics.hearers) == 2)
        wait_until("all of the flood", lambda: web.engine.browser_topics.flooded == FLOOD)
        assert 0 < max(web.pending_bytes()) <= GATE_BYTES + LARGEST_FRAME
        wait_until(
            "the deaf one to be given up", lambda: len(web.engine.browser_topics.hearers) == 1
        )
        wait_until("its bytes to be forgotten", lambda: web.pending_bytes() == [0])
        other.send(json.dumps({"type": "unsubscribe", "subscription": 3}))
        assert json.loads(other.recv(timeout=60))["subscription"] == 3


def test_a_browser_that_is_owed_too_much_is_let_go_though_it_takes_no_goodbye(web: RunningWeb):
    before = len(web.engine.listeners)
    with deaf_browser(web, "/control") as deaf:
        wait_until("it to be there", lambda: len(web.engine.listeners) == before + 1)
        deaf.say(type="randomize_joints", document="small", request=1)
        wait_until("it to be let go", lambda: len(web.engine.listeners) == before)
