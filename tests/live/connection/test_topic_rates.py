"""Rates of real topics, heard only while somebody asks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.live.connection import topic_rates
from studio.live.connection.topic_rates import TopicRates
from studio.ros.messages import message
from tests.support.node_pair import context_at
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from studio.ros.client import Node, Publisher
    from studio.ros.node.context import Context

pytestmark = pytest.mark.network
STRING = message("std_msgs/msg/String")


@pytest.fixture
def context(endpoint: str) -> Generator[Context]:
    """A session of the studio's own."""
    with context_at(endpoint) as made:
        yield made


def publishers(tester: Node, *topics: str) -> list[Publisher]:
    return [tester.create_publisher(STRING, topic, 10) for topic in topics]


def saying(outs: list[Publisher], holds: Callable[[], bool]) -> Callable[[], bool]:
    """Publishes on all before it looks again."""

    def look() -> bool:
        for out in outs:
            out.publish(STRING(data="x" * 1_000))
        return holds()

    return look


def test_nothing_is_heard_before_somebody_asks(context: Context, tester: Node):
    publishers(tester, "/quiet")
    rates = TopicRates(context)

    wait_until("the topic", lambda: bool(context.graph.publishers("/quiet")))

    assert rates.heard == ()


def test_what_is_published_has_a_rate_and_bytes(context: Context, tester: Node):
    outs, rates = publishers(tester, "/one", "/two"), TopicRates(context)

    def both_flow() -> bool:
        flows = rates.look(["/one", "/two"])
        return len(flows) == 2 and all(one.rate_hz > 0 for one in flows.values())

    wait_until("rates", saying(outs, both_flow))

    flow = rates.look(["/one"])["/one"]
    assert flow.bytes_per_s == pytest.approx(flow.rate_hz * 1_009, rel=0.01)
    assert rates.heard == ("/one", "/two")


@pytest.mark.parametrize("name", ["/nobody", "", "/**", "/on*", "relative", "/a b", "/é"])
def test_what_nobody_publishes_is_not_heard(context: Context, tester: Node, name: str):
    publishers(tester, "/one")
    rates = TopicRates(context)
    wait_until("the topic", lambda: bool(context.graph.publishers("/one")))

    assert rates.look([name]) == {}
    assert rates.heard == ()


def test_it_is_let_go_soon_after_the_last_question_and_heard_again_after_the_next(
    context: Context, tester: Node, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(topic_rates, "KEPT_S", 0.05)
    outs, rates = publishers(tester, "/one"), TopicRates(context)
    wait_until("the topic", lambda: "/one" in rates.look(["/one"]))

    wait_until("its end", saying(outs, lambda: rates.heard == ()))

    wait_until("a rate again", saying(outs, lambda: rates.look(["/one"])["/one"].rate_hz > 0))


def test_no_more_topics_are_heard_than_there_is_room_for(
    context: Context, tester: Node, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(topic_rates, "TOPICS_MAX", 2)
    names = [f"/topic_{at}" for at in range(5)]
    publishers(tester, *names)
    wait_until("all", lambda: all(context.graph.publishers(one) for one in names))
    rates = TopicRates(context)

    assert list(rates.look(names)) == names[:2]
    assert list(rates.look(names)) == names[:2]


def test_the_heaviest_rests_with_what_was_measured_and_the_others_go_on(
    context: Context, tester: Node, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(topic_rates, "BYTES_MAX", 1)
    monkeypatch.setattr(topic_rates, "_MEASURED_S", 0.0)
    monkeypatch.setattr(topic_rates, "_REST_S", 600.0)
    heavy = publishers(tester, "/heavy")
    rates = TopicRates(context)
    wait_until("the topic", lambda: "/heavy" in rates.look(["/heavy"]))

    wait_until("a rest", saying(heavy, lambda: bool(rates.look(["/heavy"])) and not rates.heard))

    assert rates.look(["/heavy"])["/heavy"].rate_hz > 0
    assert rates.heard == ()


def test_a_topic_that_rested_is_measured_again(
    context: Context, tester: Node, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(topic_rates, "BYTES_MAX", 1)
    monkeypatch.setattr(topic_rates, "_MEASURED_S", 0.0)
    monkeypatch.setattr(topic_rates, "_REST_S", 0.01)
    outs, rates = publishers(tester, "/heavy"), TopicRates(context)
    rested: list[bool] = []

    def came_back() -> bool:
        is_known = bool(rates.look(["/heavy"]))
        rested.append(is_known and not rates.heard)
        return True in rested and bool(rates.heard)

    wait_until("it again", saying(outs, came_back))
