"""Topics are heard once for all browsers, and handed on as the bytes that came."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any, Literal

import pytest

from studio.live.connection.ros_connection import RosConnection
from studio.live.topics.browsers import SUBSCRIPTIONS_MAX, BrowserTopics
from studio.nodes.robot_state_publisher import LATCHED
from studio.protocol.subscriptions import Subscribe, Unsubscribe
from studio.ros.cdr import codec_of
from studio.ros.messages import message, shared_types
from studio.settings import WireChoice
from tests.support.demos import node_at
from tests.support.hearers import KeepingHearer
from tests.support.open_documents import until

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator

    from studio.ros.client import Node
    from tests.support.hearers import Came

pytestmark = pytest.mark.network

STRING, STRANGE = "std_msgs/msg/String", "strange_msgs/msg/Thing"


def text_of(came: Came) -> str:
    return codec_of(message(STRING)).decode(came.payload).data


def texts(hearer: KeepingHearer, channel: int | None = None) -> list[str]:
    return [text_of(one) for one in hearer.came if channel in {None, one.channel}]


def said(text: str) -> Any:  # noqa: ANN401
    return message(STRING)(data=text)


@asynccontextmanager
async def browser_topics(endpoint: str) -> AsyncGenerator[BrowserTopics]:
    """The topics of a studio that is connected."""
    wire = RosConnection(WireChoice("off", (endpoint,)))
    topics = BrowserTopics(wire.topics)
    try:
        await wire.link()
        yield topics
    finally:
        await topics.close()
        await wire.close()


def browser(topics: BrowserTopics) -> KeepingHearer:
    hearer = KeepingHearer()
    topics.attach(hearer)
    return hearer


async def subscribed(*hearers: KeepingHearer, subscription: int = 1) -> None:
    await until(lambda: all(one.state(subscription) == "receiving" for one in hearers))


def test_every_message_comes_to_all_who_wish_it_in_frames_that_are_written_once(
    endpoint: str, tester: Node
):
    out = tester.create_publisher(message(STRING), "/every", 10)

    async def run() -> None:
        async with browser_topics(endpoint) as topics:
            one, other = browser(topics), browser(topics)
            for hearer in (one, other):
                topics.carry_out(hearer, Subscribe(subscription=1, topic="/every", mode="every"))
            await subscribed(one, other)
            await until(lambda: out.get_subscription_count() == 1)
            for number in range(300):
                out.publish(said(str(number)))
            await until(lambda: len(one.came) == len(other.came) == 300)
            assert texts(one) == texts(other) == [str(number) for number in range(300)]
            assert [tick.frame() for tick in one.ticks] == [tick.frame() for tick in other.ticks]
            assert all(a is b for a, b in zip(one.ticks, other.ticks, strict=True))
            told = one.told[-1]
            assert (told.type_name, told.publishers, told.reliable) == (STRING, 1, True)
            assert {came.lost for came in one.came} == {0}

    asyncio.run(run())


def test_who_waits_for_a_type_hears_the_first_that_tells_it_without_listening_anew(
    endpoint: str, tester: Node
):
    def ears() -> list[Any]:
        return tester.get_subscriptions_info_by_topic("/first")

    async def run() -> None:
        async with browser_topics(endpoint) as topics:
            hearer = browser(topics)
            topics.carry_out(
                hearer, Subscribe(subscription=1, topic="/first", mode="every", type_name=STRING)
            )
            await until(lambda: len(ears()) == 1)
            before = ears()
            out = tester.create_publisher(message(STRING), "/first", 10)
            await until(lambda: out.get_subscription_count() == 1)
            out.publish(said("once"))
            await subscribed(hearer)
            await until(lambda: texts(hearer) == ["once"])
            assert [one.endpoint_gid for one in ears()] == [one.endpoint_gid for one in before]

    asyncio.run(run())


def test_the_newest_comes_as_often_as_was_wished_and_what_is_left_ends(endpoint: str, tester: Node):
    out = tester.create_publisher(message(STRING), "/newest", 10)

    async def run() -> None:
        async with browser_topics(endpoint) as topics:
            hearer = browser(topics)
            topics.carry_out(
                hearer, Subscribe(subscription=1, topic="/newest", mode="newest", most_hz=1)
            )
            await subscribed(hearer)
            await until(lambda: out.get_subscription_count() == 1)
            for number in range(200):
                out.publish(said(str(number)))
            await until(lambda: "199" in texts(hearer))
            assert len(hearer.came) <= 3
            topics.carry_out(hearer, Unsubscribe(subscription=1))
            await until(lambda: out.get_subscription_count() == 0)

    asyncio.run(run())


@pytest.mark.parametrize("mode", ["every", "newest"])
def test_what_is_waited_for_comes_between_two_ticks(
    endpoint: str, tester: Node, monkeypatch: pytest.MonkeyPatch, mode: Literal["every", "newest"]
):
    monkeypatch.setattr("studio.live.topics.browsers._TICK_S", 3_600)
    out = tester.create_publisher(message(STRING), "/prompt", 10)

    async def run() -> None:
        async with browser_topics(endpoint) as topics:
            waiting, patient = browser(topics), browser(topics)
            topics.carry_out(
                waiting, Subscribe(subscription=1, topic="/prompt", mode=mode, pace="at_once")
            )
            topics.carry_out(patient, Subscribe(subscription=1, topic="/prompt", mode=mode))
            await subscribed(waiting, patient)
            await until(lambda: out.get_subscription_count() == 1)
            out.publish(said("now"))
            await until(lambda: texts(waiting) == ["now"])
            assert not patient.came

    asyncio.run(run())


def test_whoever_comes_later_is_told_what_is_latched(endpoint: str, tester: Node):
    tester.create_publisher(message(STRING), "/latched", LATCHED).publish(said("told before"))

    async def run() -> None:
        async with browser_topics(endpoint) as topics:
            first, later = browser(topics), browser(topics)
            command = Subscribe(subscription=1, topic="/latched", mode="newest")
            topics.carry_out(first, command)
            await until(lambda: texts(first) == ["told before"])
            topics.carry_out(later, command)
            assert texts(later) == ["told before"]
            assert first.told[-1].latched

    asyncio.run(run())


def test_a_type_that_is_not_known_here_is_heard_as_bytes(endpoint: str):
    types = shared_types().copy()
    types.add_texts({STRANGE: "string data"})

    async def run() -> None:
        async with browser_topics(endpoint) as topics:
            hearer = browser(topics)
            topics.carry_out(hearer, Subscribe(subscription=1, topic="/strange", mode="every"))
            with node_at(endpoint, "stranger", types) as stranger:
                out = stranger.create_publisher(types.message(STRANGE), "/strange", 10)
                await subscribed(hearer)
                await until(lambda: out.get_subscription_count() == 1)
                out.publish(types.message(STRANGE)(data="odd"))
                await until(lambda: bool(hearer.came))
            assert hearer.told[-1].type_name == STRANGE
            assert b"odd" in hearer.came[0].payload

    asyncio.run(run())


def test_what_is_in_the_way_is_told_and_heals(endpoint: str):
    async def run() -> None:
        wire = RosConnection(WireChoice("off", (endpoint,)))
        topics = BrowserTopics(wire.topics)
        hearer = browser(topics)
        try:
            topics.carry_out(hearer, Subscribe(subscription=1, topic="/later", mode="every"))
            await until(lambda: hearer.state(1) == "not_connected")
            await wire.link()
            await until(lambda: hearer.state(1) == "no_publisher")
            with node_at(endpoint, "late") as late:
                out = late.create_publisher(message(STRING), "/later", 10)
                await subscribed(hearer)
                await until(lambda: out.get_subscription_count() == 1)
                out.publish(said("here"))
                await until(lambda: texts(hearer) == ["here"])
            await until(lambda: hearer.state(1) == "no_publisher")
            await wire.disconnect()
            await until(lambda: hearer.state(1) == "not_connected")
        finally:
            await topics.close()
            await wire.close()

    asyncio.run(run())


def test_a_browser_has_a_bound_of_wishes_and_what_is_no_topic_is_refused(endpoint: str):
    async def run() -> None:
        async with browser_topics(endpoint) as topics:
            hearer = browser(topics)
            topics.carry_out(
                hearer, Subscribe(subscription=0, topic="no topic", type_name=STRING, mode="every")
            )
            await until(lambda: hearer.state(0) == "refused")
            assert hearer.told[-1].reason
            for number in range(1, SUBSCRIPTIONS_MAX + 1):
                topics.carry_out(
                    hearer, Subscribe(subscription=number, topic="/many", mode="every")
                )
            assert [one.subscription for one in hearer.refused] == [SUBSCRIPTIONS_MAX]

    asyncio.run(run())


def test_another_connection_is_heard_where_the_one_before_was(endpoint: str, tester: Node):
    out = tester.create_publisher(message(STRING), "/again", 10)

    async def run() -> None:
        wire = RosConnection(WireChoice("off", (endpoint,)))
        topics = BrowserTopics(wire.topics)
        hearer = browser(topics)

        async def hears(text: str) -> None:
            await wire.link()
            await subscribed(hearer)
            await until(lambda: out.get_subscription_count() == 1)
            out.publish(said(text))
            await until(lambda: text in texts(hearer))
            await wire.disconnect()
            await until(lambda: hearer.state(1) == "not_connected")

        try:
            topics.carry_out(hearer, Subscribe(subscription=1, topic="/again", mode="every"))
            await hears("before")
            await hears("after")
        finally:
            await topics.close()
            await wire.close()

    asyncio.run(run())


def test_a_topic_is_subscribed_once_and_not_at_every_look(endpoint: str, tester: Node):
    out = tester.create_publisher(message(STRING), "/steady", 10)

    async def run() -> None:
        async with browser_topics(endpoint) as topics:
            hearer = browser(topics)
            topics.carry_out(hearer, Subscribe(subscription=1, topic="/steady", mode="every"))
            await subscribed(hearer)
            await until(lambda: out.get_subscription_count() == 1)
            (first,) = tester.graph.subscriptions("/steady")
            other = tester.create_publisher(message(STRING), "/steady", 10)
            await until(lambda: hearer.told[-1].publishers == 2)
            assert [one.token for one in tester.graph.subscriptions("/steady")] == [first.token]
            tester.destroy_publisher(other)

    asyncio.run(run())
