"""A relay is sent topics as a browser is, over a line that may be slow."""

from __future__ import annotations

import asyncio

import pytest

from studio.nodes.robot_state_publisher import LATCHED
from studio.outlet import GATE_BYTES
from studio.protocol.roles import Role, Visitor
from studio.protocol.subscriptions import NotSubscribed, Subscribe, SubscriptionView, Unsubscribe
from studio.server.backlog import KEPT_BYTES
from studio.server.relays.messages import AskTopic, TopicState, TopicTick
from studio.server.relays.origin_topics import RELAY_SUBSCRIPTIONS_MAX, allowed_topics
from tests.support.hearers import read_frame
from tests.support.memory_source import MemorySource
from tests.support.open_documents import until
from tests.support.relayed_topics import Line, line_to, texts
from tests.support.topic_worlds import STRING, text_payload

FULL = GATE_BYTES + 1


def ask(text: str) -> AskTopic:
    return AskTopic(text.encode())


def subscribe(number: int, topic: str = "/words", document: str = "") -> AskTopic:
    command = Subscribe(subscription=number, topic=topic, mode="every", document=document)
    return AskTopic(command.model_dump_json().encode())


def refused(line: Line) -> list[NotSubscribed]:
    said = [one.text for one in line.told if isinstance(one, TopicState)]
    return [NotSubscribed.model_validate_json(one) for one in said if b"not_subscribed" in one]


@pytest.mark.parametrize(
    ("pattern", "topic", "allowed"),
    [
        ("*", "/tf", True),
        ("/tf*", "/tf_static", True),
        ("/tf*", "/camera/tf", False),
        ("/camera/*", "/camera/left/image", True),
        ("/TF", "/tf", False),
    ],
)
def test_topics_are_allowed_by_patterns(pattern: str, topic: str, allowed: bool):
    assert allowed_topics([pattern])(topic) is allowed
    assert allowed_topics(["/another", pattern])(topic) is allowed
    assert allowed_topics([])(topic)


def test_what_is_not_sent_to_relays_is_refused_in_a_sentence():
    async def run() -> None:
        source = MemorySource()
        async with line_to(source, allowed_topics(["/tf*"])) as (_, line):
            hearer = line.hearer()
            for number, topic in enumerate(("/tf", "/camera")):
                asked = Subscribe(subscription=number, topic=topic, mode="newest")
                line.relayed.carry_out(hearer, asked)
            assert hearer.state(0)
            (told,) = hearer.refused
            assert told.subscription == 1
            assert told.reason.startswith("/camera is not sent to relays")

    asyncio.run(run())


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[" * 4000,
        '{"type": "ask_bulk"}',
        '{"type": "subscribe", "subscription": 2}',
        '{"type": "unsubscribe", "subscription": "' + "x" * 5000 + '"}',
    ],
)
def test_what_is_no_command_is_answered_so(text: str):
    async def run() -> None:
        async with line_to(MemorySource()) as (_, line):
            line.origin.carry_out(ask(text), None)
            (told,) = refused(line)
            assert 10 < len(told.reason) <= 300

    asyncio.run(run())


def test_a_copy_is_for_those_who_see_it():
    async def run() -> None:
        async with line_to(MemorySource()) as (_, line):
            for person in (None, Visitor(Role.GUEST)):
                line.origin.carry_out(subscribe(1, document="arm~somebody"), person)
            assert [one.reason for one in refused(line)] == ["There is no such document."] * 2
            line.origin.carry_out(subscribe(2, document="arm~somebody"), Visitor(Role.PRESENTER))
            line.origin.carry_out(subscribe(3, document="arm"), None)
            assert len(refused(line)) == 2
            assert not line.origin.sees("arm~somebody")

    asyncio.run(run())


def test_a_relay_has_a_bound_of_subscriptions_and_those_that_end_make_room():
    async def run() -> None:
        async with line_to(MemorySource()) as (_, line):
            for number in range(RELAY_SUBSCRIPTIONS_MAX + 1):
                line.origin.carry_out(subscribe(number), None)
            assert [one.subscription for one in refused(line)] == [RELAY_SUBSCRIPTIONS_MAX]
            left = Unsubscribe(subscription=0).model_dump_json().encode()
            line.origin.carry_out(AskTopic(left), None)
            line.origin.carry_out(subscribe(RELAY_SUBSCRIPTIONS_MAX), None)
            assert len(refused(line)) == 1

    asyncio.run(run())


def test_every_subscription_is_answered_by_its_state_and_what_is_kept_for_it():
    async def run() -> None:
        source = MemorySource()
        source.offer("/kept", STRING, LATCHED).say(text_payload("kept"))
        async with line_to(source) as (_, line):
            line.origin.carry_out(subscribe(7), None)
            line.origin.carry_out(subscribe(8, "/kept"), None)
            line.origin.carry_out(subscribe(9, "/kept"), None)
            found = [one for one in line.told if isinstance(one, TopicTick) and one.kept_for >= 0]
            assert [one.kept_for for one in found] == [7, 8, 9]
            assert not read_frame(found[0].frame)[1]
            assert read_frame(found[2].frame)[1]
            at = line.told.index(found[2])
            state = line.told[at - 1]
            assert isinstance(state, TopicState)
            assert SubscriptionView.model_validate_json(state.text).subscription == 9

    asyncio.run(run())


def test_a_full_line_sends_the_newest_later_and_of_every_message_what_fits_and_says_what_it_lost():
    async def run() -> None:
        source = MemorySource()
        publisher = source.offer("/words", STRING)
        large = "x" * (KEPT_BYTES // 8)
        async with line_to(source) as (topics, line):
            every, newest, near = line.hearer(), line.hearer(), line.hearer(topics)
            asked = Subscribe(subscription=1, topic="/words", mode="every")
            for of, hearer in ((line.relayed, every), (topics, near)):
                of.carry_out(hearer, asked)
            line.relayed.carry_out(newest, asked.model_copy(update={"mode": "newest"}))
            publisher.say(text_payload("first"))
            await until(lambda: texts(every) == texts(newest) == texts(near) == ["first"])
            line.pending = FULL
            for number in range(20):
                publisher.say(text_payload(f"{number} {large}"))
                await until(lambda number=number: len(near.came) == number + 2)
            assert len(every.came) == 1
            line.confirm()
            lost = 21 - len(every.came)
            assert lost > 0
            assert texts(every)[-1] == texts(newest)[-1] == texts(near)[-1]
            assert {one.lost for one in every.came[1:]} == {lost}
            assert {one.lost for one in near.came + newest.came} == {0}
            publisher.say(text_payload("last"))
            await until(lambda: texts(every)[-1] == texts(newest)[-1] == "last")
            assert (every.came[-1].lost, newest.came[-1].lost) == (lost, 0)

    asyncio.run(run())


def test_what_is_latched_waits_for_a_full_line_and_comes_after_what_was_there_before():
    async def run() -> None:
        source = MemorySource()
        publisher = source.offer("/map", STRING, LATCHED)
        async with line_to(source) as (topics, line):
            first, near = line.hearer(), line.hearer(topics)
            asked = Subscribe(subscription=1, topic="/map", mode="newest")
            line.relayed.carry_out(first, asked)
            topics.carry_out(near, asked)
            publisher.say(text_payload("old"))
            await until(lambda: texts(first) == texts(near) == ["old"])
            line.pending = FULL
            publisher.say(text_payload("new"))
            await until(lambda: texts(near) == ["old", "new"])
            later = line.hearer()
            line.relayed.carry_out(later, asked)
            assert later.state(1) == "receiving"
            publisher.say(text_payload("newest"))
            await until(lambda: texts(near)[-1] == "newest")
            assert (texts(first), texts(later)) == (["old"], [])
            line.confirm()
            assert (texts(first), texts(later)) == (["old", "newest"], ["newest"])

    asyncio.run(run())


def test_a_line_that_ends_subscribes_nothing_any_more():
    async def run() -> None:
        source = MemorySource()
        async with line_to(source) as (_, line):
            line.origin.carry_out(subscribe(1), None)
            source.offer("/words", STRING)
            await until(lambda: len(source.opened) == 1)
            line.origin.close()
            await until(lambda: not source.opened)

    asyncio.run(run())
