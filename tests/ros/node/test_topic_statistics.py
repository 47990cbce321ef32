"""Counting over the wire, without a type, a token or a copy."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING

import pytest

from studio.errors import RosNameError
from studio.ros.attachment import Attachment
from studio.ros.node.topic_statistics import RING, TopicStatistics
from studio.ros.wire.zenoh import declare_publisher, declare_subscription
from tests.support.node_pair import context_at, node_pair
from tests.support.wire import running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.node.context import Context

pytestmark = pytest.mark.network
KEPT_S = 60.0


class Stopped(threading.Event):
    """A source that holds the drain up until it is set."""

    def __init__(self) -> None:
        super().__init__()
        self.is_reached = threading.Event()

    def drain(self) -> int:
        self.is_reached.set()
        self.wait()
        return 0


def talk(context: Context, topic: str) -> Callable[[int], None]:
    """Publishes bytes of a type that nobody knows, numbered as rmw_zenoh does."""
    key = f"0{topic}/nobody::msg::dds_::Knows_/RIHS01_00"
    out = declare_publisher(context.wire.zenoh, key, blocking=True, reliable=True)
    numbers = iter(range(1, 1_000_000))

    def say(payload_bytes: int) -> None:
        attachment = Attachment(next(numbers), 1, b"0123456789abcdef").pack()
        out.put(bytes(payload_bytes), attachment=attachment)

    return say


def test_a_topic_of_an_unknown_type_is_counted_and_nobody_sees_who_counts():
    with node_pair() as (talker, listener):
        say = talk(talker.context, "/strange")
        tally = TopicStatistics(listener.context, "/strange", KEPT_S)

        def has_a_rate() -> bool:
            say(1_000)
            return tally.flow().rate_hz > 0

        wait_until("a rate", has_a_rate)
        flow = tally.flow()
        assert flow.bytes_per_s == pytest.approx(1_000 * flow.rate_hz)
        assert flow.age_s is not None
        assert talker.context.graph.subscriptions("/strange") == []
        tally.close()


def test_what_falls_out_of_the_ring_while_nobody_looks_is_counted_by_its_numbers():
    with running_router() as endpoint, context_at(endpoint) as one, context_at(endpoint) as other:
        say, held = talk(one, "/many"), Stopped()
        tally, began_s = TopicStatistics(other, "/many", KEPT_S), time.monotonic()

        def has_a_rate() -> bool:
            say(10)
            return tally.flow().rate_hz > 0

        wait_until("a rate", has_a_rate)
        witness = declare_subscription(other.wire.zenoh, "0/many/*/*", 30 * RING, reliable=False)
        other.drain.add(held)
        wait_until("a pause of the drain", held.is_reached.is_set)
        for _ in range(20 * RING):
            say(10)
        heard: list[object] = []
        wait_until(
            "all", lambda: (heard.extend(witness.take(30 * RING)), len(heard) >= 20 * RING)[1]
        )

        held.set()

        def as_many() -> bool:
            flow = tally.flow()
            if flow.is_silent:
                say(10)  # this thread had to wait for its turn
            until_s = time.monotonic() - (flow.age_s or 0.0)
            return flow.rate_hz * (until_s - began_s) > 10 * RING

        wait_until("as many", as_many)
        witness.undeclare()


def test_it_ends_by_itself_when_nobody_asks_any_more():
    with running_router() as endpoint, context_at(endpoint) as context:
        tally = TopicStatistics(context, "/lonely", kept_s=0.0)

        wait_until("its end", lambda: not tally.is_open)
        tally.close()


def test_it_ends_though_messages_go_on_coming():
    with running_router() as endpoint, context_at(endpoint) as one, context_at(endpoint) as other:
        say, tally = talk(one, "/busy"), TopicStatistics(other, "/busy", kept_s=0.05)

        wait_until("its end", lambda: (say(10), not tally.is_open)[1])


@pytest.mark.parametrize("name", ["relative", "/**", "/a/*", "/a//b", "/a$*", ""])
def test_what_is_no_name_of_a_topic_is_refused(name: str):
    with (
        running_router() as endpoint,
        context_at(endpoint) as context,
        pytest.raises(RosNameError),
    ):
        TopicStatistics(context, name, KEPT_S)
