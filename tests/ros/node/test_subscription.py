from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import DestroyedError, MessageCallbackError, MessageValueError
from studio.ros.attachment import Attachment
from studio.ros.messages import message
from studio.ros.node.spinning import spinning
from studio.ros.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_sensor_data,
)
from studio.ros.wire.zenoh import declare_publisher
from tests.support.node_pair import node_pair, spin_until
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.node import Node
    from studio.ros.node.publisher import Publisher
    from studio.ros.node.samples import MessageInfo
    from studio.ros.node.subscription import Subscription
    from studio.ros.types.classes import MessageValue

String = message("std_msgs/msg/String")
LATCHED = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
LATCHED_BEST_EFFORT = QoSProfile(
    depth=3,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
    reliability=ReliabilityPolicy.BEST_EFFORT,
)


@pytest.fixture(scope="module")
def nodes() -> Generator[tuple[Node, Node]]:
    with node_pair() as pair:
        yield pair


def meet(publisher: Publisher, subscription: Subscription, listener: Node) -> None:
    """Wait until both have found each other, and nothing of that is left on its way."""
    heard: list[str] = []

    def hear(said: MessageValue) -> None:
        heard.append(said.data)

    before, subscription.callback = subscription.callback, hear

    def is_heard() -> bool:
        publisher.publish(String(data="are you there"))
        return bool(heard)

    spin_until(is_heard, listener)
    publisher.publish(String(data="last"))
    spin_until(lambda: "last" in heard, listener)
    subscription.callback = before


@pytest.mark.parametrize(
    "qos",
    [
        QoSProfile(depth=10),
        qos_profile_sensor_data,
        QoSProfile(history=HistoryPolicy.KEEP_ALL),
        LATCHED,
    ],
    ids=["reliable", "best effort", "keep all", "transient local"],
)
def test_messages_arrive_in_their_order(nodes: tuple[Node, Node], qos: QoSProfile):
    talker, listener = nodes
    heard: list[str] = []
    publisher = talker.create_publisher(String, "ordered", qos)
    subscription = listener.create_subscription(
        String, "ordered", lambda said: heard.append(said.data), qos
    )
    meet(publisher, subscription, listener)
    heard.clear()
    for number in range(3):
        publisher.publish(String(data=str(number)))
    spin_until(lambda: len(heard) >= 3, listener)
    assert heard == ["0", "1", "2"]
    listener.destroy_subscription(subscription)
    talker.destroy_publisher(publisher)


@pytest.mark.parametrize("qos", [LATCHED, LATCHED_BEST_EFFORT], ids=["reliable", "best effort"])
def test_t4_a_late_joiner_gets_the_last_of_its_depth(nodes: tuple[Node, Node], qos: QoSProfile):
    talker, listener = nodes
    topic = f"latched_{qos.reliability.name.lower()}"
    publisher = talker.create_publisher(String, topic, qos)
    early: list[str] = []
    first = listener.create_subscription(String, topic, lambda said: early.append(said.data), qos)
    spin_until(lambda: publisher.get_subscription_count() == 1, talker)
    for number in range(5):
        publisher.publish(String(data=str(number)))
    spin_until(lambda: "4" in early, listener)  # none is on its way any more
    listener.destroy_subscription(first)
    heard: list[str] = []
    late = listener.create_subscription(String, topic, lambda said: heard.append(said.data), qos)
    spin_until(lambda: len(heard) >= 3, listener)
    publisher.publish(String(data="new"))
    spin_until(lambda: len(heard) >= 4, listener)
    assert heard == ["2", "3", "4", "new"]
    assert late.losses.lost == 0


def test_a_volatile_joiner_gets_nothing_of_before(nodes: tuple[Node, Node]):
    talker, listener = nodes
    publisher = talker.create_publisher(String, "volatile", 10)
    publisher.publish(String(data="before"))
    heard: list[str] = []
    subscription = listener.create_subscription(
        String, "volatile", lambda said: heard.append(said.data), 10
    )
    meet(publisher, subscription, listener)
    publisher.publish(String(data="after"))
    spin_until(lambda: "after" in heard, listener)
    assert "before" not in heard


def test_a_callback_with_two_arguments_is_told_what_came_with_it(nodes: tuple[Node, Node]):
    talker, listener = nodes
    told: list[MessageInfo] = []

    def callback(_said: MessageValue, info: MessageInfo) -> None:
        told.append(info)

    publisher = talker.create_publisher(String, "told", LATCHED)
    publisher.publish(String())
    listener.create_subscription(String, "told", callback, LATCHED)
    spin_until(lambda: bool(told), listener)
    assert told[0]["publication_sequence_number"] == 1
    assert told[0]["publisher_gid"] == publisher.endpoint.gid
    assert told[0]["source_timestamp"] <= told[0]["received_timestamp"]


def test_a_raw_subscription_is_given_the_bytes(nodes: tuple[Node, Node]):
    talker, listener = nodes
    heard: list[bytes] = []
    publisher = talker.create_publisher(String, "raw", LATCHED)
    publisher.publish(b"\x00\x01\x00\x00\x02\x00\x00\x00a\x00")
    listener.create_subscription(String, "raw", heard.append, LATCHED, raw=True)
    spin_until(lambda: bool(heard), listener)
    assert heard == [b"\x00\x01\x00\x00\x02\x00\x00\x00a\x00"]


def test_a_sample_without_an_attachment_is_dropped_and_said_once(
    nodes: tuple[Node, Node], capsys: pytest.CaptureFixture[str]
):
    talker, listener = nodes
    heard: list[str] = []
    subscription = listener.create_subscription(
        String, "bare", lambda said: heard.append(said.data), 10
    )
    bare = declare_publisher(
        talker.wire.zenoh, subscription.endpoint.key, blocking=False, reliable=True
    )

    def is_refused() -> bool:
        bare.put(b"\x00\x01\x00\x00\x02\x00\x00\x00a\x00")
        return subscription.losses.refused >= 3

    wait_until("samples are refused", is_refused)
    bare.undeclare()
    assert heard == []
    assert subscription.losses.reason is not None
    assert capsys.readouterr().err.count("/bare was dropped") == 1


@pytest.mark.parametrize(
    "payload", [b"", b"junk", b"\x00\x01\x00\x00\xff\xff\xff\x7f", b"\x00" * 64]
)
def test_bytes_that_are_no_message_are_counted_and_others_still_arrive(
    nodes: tuple[Node, Node], payload: bytes
):
    talker, listener = nodes
    heard: list[str] = []
    topic = f"malformed_{len(payload)}"
    qos = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = talker.create_publisher(String, topic, qos)
    publisher.publish(payload)
    publisher.publish(String(data="good"))
    subscription = listener.create_subscription(
        String, topic, lambda said: heard.append(said.data), qos
    )
    spin_until(lambda: "good" in heard, listener)
    malformed = subscription.losses.malformed
    assert (heard, malformed) in ((["good"], 1), (["", "good"], 0))


def test_what_is_missing_between_numbers_is_counted_as_lost(nodes: tuple[Node, Node]):
    talker, listener = nodes
    subscription = listener.create_subscription(String, "gaps", lambda _: None, 10)
    sender = declare_publisher(
        talker.wire.zenoh, subscription.endpoint.key, blocking=False, reliable=True
    )
    numbers = iter(range(1, 1_000_000, 5))

    def is_lost() -> bool:
        attachment = Attachment(next(numbers), 1, b"g" * 16)
        sender.put(b"\x00\x01\x00\x00\x01\x00\x00\x00\x00", attachment=attachment.pack())
        return subscription.losses.lost >= 8

    wait_until("gaps are counted", is_lost)
    sender.undeclare()
    assert subscription.losses.lost % 4 == 0


def test_messages_are_taken_by_async_for(nodes: tuple[Node, Node]):
    talker, listener = nodes
    publisher = talker.create_publisher(String, "awaited", LATCHED)
    for number in range(3):
        publisher.publish(String(data=str(number)))
    subscription = listener.create_subscription(String, "awaited", None, LATCHED)

    async def take() -> list[str]:
        heard: list[str] = []
        async for said in subscription:
            heard.append(said.data)
            if len(heard) == 3:
                publisher.publish(String(data="more"))
            if said.data == "more":
                listener.destroy_subscription(subscription)
        return heard

    assert asyncio.run(take()) == ["0", "1", "2", "more"]


def test_messages_are_taken_by_async_for_in_a_callback(nodes: tuple[Node, Node]):
    talker, listener = nodes
    publisher = talker.create_publisher(String, "awaited_within", LATCHED)
    subscription = listener.create_subscription(String, "awaited_within", None, LATCHED)

    async def take() -> str:
        async for said in subscription:
            return said.data
        return "ended"

    with spinning(listener) as executor:
        task = executor.create_task(take())
        publisher.publish(String(data="within"))
        assert task.wait(30)
    assert task.result() == "within"


def test_a_message_of_another_type_is_not_published(nodes: tuple[Node, Node]):
    talker, _ = nodes
    publisher = talker.create_publisher(String, "typed", 10)
    with pytest.raises(MessageValueError, match="std_msgs/msg/Bool"):
        publisher.publish(message("std_msgs/msg/Bool")())
    with pytest.raises(MessageValueError, match="not str"):
        publisher.publish("text")  # pyright: ignore[reportArgumentType]


def test_a_destroyed_publisher_sends_no_more(nodes: tuple[Node, Node]):
    talker, _ = nodes
    publisher = talker.create_publisher(String, "gone", 10)
    assert talker.destroy_publisher(publisher)
    assert not talker.destroy_publisher(publisher)
    with pytest.raises(DestroyedError, match="/gone"):
        publisher.publish(String())


def test_publishers_and_subscriptions_count_each_other(nodes: tuple[Node, Node]):
    talker, listener = nodes
    publisher = talker.create_publisher(String, "counted", 10)
    subscription = listener.create_subscription(String, "counted", lambda _: None, 10)
    wait_until("counted", lambda: publisher.get_subscription_count() == 1)
    wait_until("counted", lambda: subscription.get_publisher_count() == 1)
    listener.destroy_subscription(subscription)
    wait_until("gone", lambda: publisher.get_subscription_count() == 0)


def test_subscriptions_come_and_go_while_data_flows(
    nodes: tuple[Node, Node], caplog: pytest.LogCaptureFixture
):
    talker, listener = nodes
    publisher = talker.create_publisher(String, "busy", 10)
    for _ in range(50):
        subscription = listener.create_subscription(String, "busy", lambda _: None, 10)
        for _ in range(20):
            publisher.publish(String(data="x"))
        listener.destroy_subscription(subscription)
    assert caplog.text == ""


def test_humble_has_no_hash_in_its_keys():
    with node_pair("humble") as (talker, listener):
        heard: list[str] = []
        publisher = talker.create_publisher(String, "old", LATCHED)
        publisher.publish(String(data="humble"))
        listener.create_subscription(String, "old", lambda said: heard.append(said.data), LATCHED)
        spin_until(lambda: heard == ["humble"], listener)
        assert publisher.endpoint.key.endswith("/TypeHashNotSupported")


def test_messages_are_taken_one_by_one_without_a_callback(nodes: tuple[Node, Node]):
    talker, listener = nodes
    publisher = talker.create_publisher(String, "taken", LATCHED)
    publisher.publish(String(data="one"))
    publisher.publish(String(data="two"))
    subscription = listener.create_subscription(String, "taken", None, LATCHED)
    taken: list[str] = []

    def take() -> bool:
        message = subscription.take_message()
        if message is not None:
            taken.append(message.data)
        return len(taken) == 2

    wait_until("both messages to be taken", take)
    assert taken == ["one", "two"]
    assert subscription.take_message() is None


def takes_nothing(): ...


def takes_three(a: int, b: int, c: int): ...


@pytest.mark.parametrize(
    ("callback", "said"),
    [
        (3, "and 3 does not: give the function itself, self.callback and not self.callback()."),
        (takes_nothing, r"and takes_nothing\(\) does not: write def callback\(self, msg\)."),
        (takes_three, r"and takes_three\(a, b, c\) does not"),
    ],
)
def test_a_callback_that_takes_no_message_is_refused_at_once(
    nodes: tuple[Node, Node], callback: object, said: str
):
    given: Any = callback
    with pytest.raises(MessageCallbackError, match=f"The callback for /refused must .*{said}"):
        nodes[0].create_subscription(String, "refused", given, 10)
