"""Bytes of a topic over the wire: as they come, deeper without a loss, or only the newest."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import RosNameError, UnknownTypeError
from studio.ros.attachment import Attachment
from studio.ros.cdr import codec_of
from studio.ros.messages import message
from studio.ros.node.raw_subscription import RawSubscription
from studio.ros.qos import DurabilityPolicy, QoSProfile
from studio.ros.wire.zenoh import declare_publisher, declare_subscription
from tests.support.node_pair import node_pair
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from studio.ros.node.node import Node
    from studio.ros.node.publisher import Publisher
    from studio.ros.node.samples import RawSample

pytestmark = pytest.mark.network
STRING = "std_msgs/msg/String"


class Stopped(threading.Event):
    """A source that holds the drain up until it is set."""

    def __init__(self) -> None:
        super().__init__()
        self.is_reached = threading.Event()

    def drain(self) -> int:
        self.is_reached.set()
        self.wait()
        return 0


class Kept:
    """Keeps what it takes."""

    def __init__(self) -> None:
        self.samples: list[RawSample] = []
        self.count = self.size = 0

    def __call__(self, samples: list[RawSample], count: int, size: int) -> None:
        self.samples += samples
        self.count += count
        self.size += size

    @property
    def texts(self) -> list[str]:
        codec = codec_of(message(STRING))
        return [codec.decode(one.payload).data for one in self.samples]


def received(node: Node, topic: str, qos: QoSProfile) -> tuple[RawSubscription, Kept]:
    kept = Kept()
    return RawSubscription(node, topic, STRING, None, qos, kept), kept


def say(out: Publisher, *texts: str) -> None:
    for text in texts:
        out.publish(message(STRING)(data=text))


def test_samples_come_as_bytes_with_their_count_and_size_until_it_is_closed():
    with node_pair() as (talker, listener):
        out = talker.create_publisher(message(STRING), "/bytes", 10)
        subscription, kept = received(listener, "/bytes", QoSProfile(depth=10))
        wait_until("the token", lambda: out.get_subscription_count() == 1)
        say(out, "a", "b")
        wait_until("both", lambda: kept.count == 2)
        assert kept.texts == ["a", "b"]
        assert kept.size == sum(len(one.payload) for one in kept.samples)
        assert [one.attachment.sequence for one in kept.samples] == [1, 2]
        subscription.close()
        subscription.close()
        wait_until("its end", lambda: out.get_subscription_count() == 0)


def test_it_gets_deeper_while_messages_come_and_none_is_lost():
    with node_pair() as (talker, listener):
        out = talker.create_publisher(message(STRING), "/deeper", 10)
        subscription, kept = received(listener, "/deeper", QoSProfile(depth=2))
        wait_until("the token", lambda: out.get_subscription_count() == 1)
        swaps: list[int] = []
        for depth in (10, 100, 1_000):
            say(out, *(f"{depth} {number}" for number in range(200)))
            subscription.deepen(depth, lambda depth=depth: swaps.append(depth))
        say(out, "last")
        wait_until("the last", lambda: "last" in kept.texts)
        said = [f"{depth} {number}" for depth in (10, 100, 1_000) for number in range(200)]
        assert list(dict.fromkeys(kept.texts)) == [*said, "last"]
        assert (swaps, subscription.lost) == ([10, 100, 1_000], 0)
        wait_until(
            "one token",
            lambda: [one.qos.depth for one in talker.graph.subscriptions("/deeper")] == [1_000],
        )


def test_a_latched_topic_is_told_anew_when_it_gets_deeper():
    with node_pair() as (talker, listener):
        qos = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        out = talker.create_publisher(message(STRING), "/told", qos)
        say(out, "a", "b", "c")
        shallow = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        subscription, kept = received(listener, "/told", shallow)
        wait_until("the newest", lambda: kept.texts == ["c"])
        subscription.deepen(5, kept.samples.clear)
        wait_until("all", lambda: kept.texts == ["a", "b", "c"])
        assert subscription.lost == 0


def test_where_only_the_newest_is_read_all_are_counted():
    with node_pair() as (talker, listener):
        out = talker.create_publisher(message(STRING), "/newest", 10)
        subscription, kept = received(listener, "/newest", QoSProfile(depth=1_000))
        subscription.read(newest_only=True)
        wait_until("the token", lambda: out.get_subscription_count() == 1)
        witness = declare_subscription(listener.wire.zenoh, "0/newest/*/*", 1_000, reliable=False)
        held, came = Stopped(), list[object]()
        listener.context.drain.add(held)
        wait_until("a pause of the drain", held.is_reached.is_set)
        say(out, *map(str, range(500)))
        wait_until("all", lambda: (came.extend(witness.take(1_000)), len(came) == 500)[1])
        held.set()
        wait_until("all to be counted", lambda: kept.count == 500)
        assert kept.texts[-1] == "499"
        assert len(kept.samples) < 20
        assert kept.size == sum(len(codec_of(message(STRING)).encode(text)) for text in _said(500))
        subscription.read(newest_only=False)
        witness.undeclare()
        say(out, "more")
        wait_until("one more", lambda: kept.texts[-1] == "more")
        assert subscription.lost == 0, "what was passed over is no loss"


def _said(count: int) -> list[Any]:
    return [message(STRING)(data=str(number)) for number in range(count)]


def test_what_is_missing_between_numbers_is_lost_and_what_has_none_is_dropped():
    with node_pair() as (talker, listener):
        subscription, kept = received(listener, "/gaps", QoSProfile(depth=10))
        key = f"0/gaps/std_msgs::msg::dds_::String_/{listener.wire.types.hash_of(STRING)}"
        out = declare_publisher(talker.context.wire.zenoh, key, blocking=True, reliable=True)

        def put(number: int) -> None:
            out.put(b"\x00\x01\x00\x00", attachment=Attachment(number, number, b"s" * 16).pack())

        def first_came() -> bool:
            put(1)
            return bool(kept.samples)

        wait_until("the first", first_came)
        out.put(b"without an attachment")
        put(5)
        wait_until("the fifth", lambda: kept.samples[-1].attachment.sequence == 5)
        assert subscription.lost == 3
        assert all(len(one.payload) == 4 for one in kept.samples)


def test_what_cannot_be_subscribed_is_refused():
    with node_pair() as (_, listener):
        with pytest.raises(RosNameError):
            received(listener, "/a b", QoSProfile(depth=1))
        with pytest.raises(UnknownTypeError):
            RawSubscription(listener, "/a", "no_msgs/msg/Such", None, QoSProfile(depth=1), Kept())
