from __future__ import annotations

import pytest

from studio.errors import ActionServerGoneError
from studio.ros.action import GoalStatus
from studio.ros.action import client as result_wait
from tests.support.demos import node_at
from tests.support.goals import ActionPair, Held, finished
from tests.support.wire import free_endpoint, router_at, wait_until

pytestmark = pytest.mark.network


def test_a_result_comes_though_the_router_was_away_meanwhile():
    held, endpoint = Held(), free_endpoint()
    router = router_at(endpoint)
    with node_at(endpoint, "server") as serving, node_at(endpoint, "client") as asking:
        pair = ActionPair(serving, asking, held)
        asked = pair.send().get_result_async()
        wait_until("it is under way", lambda: len(held.goals) == 1)
        router.close()
        wait_until("nobody is there", lambda: not asking.wire.is_connected)
        with router_at(endpoint):
            wait_until("the server is back", pair.client.server_is_ready)
            held.end("succeed")
            assert finished(asked).status == GoalStatus.SUCCEEDED


def test_a_server_that_ended_while_the_router_was_away_is_gone(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(result_wait, "RETURNS_WITHIN_S", 1.5)
    held, endpoint = Held(), free_endpoint()
    router = router_at(endpoint)
    with node_at(endpoint, "client") as asking:
        with node_at(endpoint, "server") as serving:
            pair = ActionPair(serving, asking, held)
            asked = pair.send().get_result_async()
            wait_until("it is under way", lambda: len(held.goals) == 1)
            router.close()
            wait_until("nobody is there", lambda: not asking.wire.is_connected)
        with router_at(endpoint), pytest.raises(ActionServerGoneError):
            finished(asked)


def test_a_wait_that_is_cancelled_looks_no_more():
    held, endpoint = Held(), free_endpoint()
    router = router_at(endpoint)
    with node_at(endpoint, "server") as serving, node_at(endpoint, "client") as asking:
        pair = ActionPair(serving, asking, held)
        before = len(asking.all_work)
        asked = pair.send().get_result_async()
        wait_until("it is under way", lambda: len(held.goals) == 1)
        router.close()
        wait_until("it looks", lambda: len(asking.all_work) == before + 1)
        asked.cancel()
        wait_until("it looks no more", lambda: len(asking.all_work) == before)
        assert asked.cancelled()
