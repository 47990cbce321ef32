from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import UnsupportedEventTypeError
from studio.ros.attachment import Attachment
from studio.ros.cdr import codec_of
from studio.ros.messages import message
from studio.ros.node.event_handler import (
    CountInfo,
    MatchedInfo,
    PublisherEventCallbacks,
    SubscriptionEventCallbacks,
)
from studio.ros.wire.zenoh import declare_publisher
from tests.support.node_pair import node_pair, spin_until
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.node import Node

pytestmark = pytest.mark.network
String = message("std_msgs/msg/String")
Int32 = message("std_msgs/msg/Int32")


@pytest.fixture(scope="module")
def nodes() -> Generator[tuple[Node, Node]]:
    with node_pair() as pair:
        yield pair


def totals(event: Any) -> int:  # noqa: ANN401
    return event._total  # before it is told


def test_a_publisher_tells_who_comes_and_goes(nodes: tuple[Node, Node]):
    talker, listener = nodes
    told: list[MatchedInfo] = []
    publisher = talker.create_publisher(
        String, "met", 10, event_callbacks=PublisherEventCallbacks(matched=told.append)
    )
    subscription = listener.create_subscription(String, "met", print, 10)
    spin_until(lambda: bool(told), talker)
    assert told == [MatchedInfo(1, 1, 1, 1)]
    listener.destroy_subscription(subscription)
    spin_until(lambda: len(told) == 2, talker)
    assert told[1] == MatchedInfo(1, 0, 0, -1)
    talker.destroy_publisher(publisher)
    assert not any(event in talker.all_work for event in publisher.events)


def test_what_happens_between_two_callbacks_is_told_at_once(nodes: tuple[Node, Node]):
    talker, listener = nodes
    told: list[Any] = []
    subscription = listener.create_subscription(
        String,
        "met_twice",
        print,
        10,
        event_callbacks=SubscriptionEventCallbacks(
            matched=told.append, incompatible_type=told.append
        ),
    )
    matched, incompatible = subscription.events
    for kind in (String, String, Int32):
        talker.create_publisher(kind, "met_twice", 10)
    wait_until("all are seen", lambda: (totals(matched), totals(incompatible)) == (2, 1))
    spin_until(lambda: len(told) == 2, listener)
    assert sorted(told, key=len) == [CountInfo(1, 1), MatchedInfo(2, 2, 2, 2)]


def test_a_subscription_tells_of_messages_that_were_lost(nodes: tuple[Node, Node]):
    talker, listener = nodes
    told: list[CountInfo] = []
    subscription = listener.create_subscription(
        String,
        "lossy",
        lambda _: None,
        10,
        event_callbacks=SubscriptionEventCallbacks(message_lost=told.append),
    )
    bare = declare_publisher(
        talker.wire.zenoh, subscription.endpoint.key, blocking=True, reliable=True
    )
    payload = bytes(codec_of(String).encode(String(data="x")))
    sent = iter(range(1, 100_000, 4))

    def heard() -> bool:  # until the subscription is known there, samples go nowhere
        number = next(sent)
        bare.put(payload, attachment=Attachment(number, number, b"g" * 16).pack())
        return bool(told)

    spin_until(heard, listener)
    assert told[0].total_count == told[0].total_count_change
    assert told[0].total_count % 3 == 0
    bare.undeclare()


@pytest.mark.parametrize("event", ["deadline", "liveliness"])
@pytest.mark.parametrize("kind", [PublisherEventCallbacks, SubscriptionEventCallbacks])
def test_events_that_zenoh_does_not_tell_are_refused(kind: Any, event: str):  # noqa: ANN401
    with pytest.raises(UnsupportedEventTypeError, match=f"The event {event} does not exist"):
        kind(**{event: print})
    assert kind(incompatible_qos=print).use_default_callbacks
