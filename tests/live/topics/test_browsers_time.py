"""Data lanes of documents that show another time than now."""

from __future__ import annotations

import asyncio

from studio.live.time.recording_source import RecordingSource
from studio.live.topics.browsers import BrowserTopics
from studio.nodes.robot_state_publisher import LATCHED
from studio.protocol.subscriptions import Subscribe
from tests.live.time.test_recording_source import BEGIN, words
from tests.support.hearers import KeepingHearer
from tests.support.memory_source import MemorySource
from tests.support.open_documents import until
from tests.support.topic_worlds import STRING, text_of, text_payload
from tests.support.transforms import S


def heard(hearer: KeepingHearer) -> list[str]:
    return [text_of(one.payload) for one in hearer.came]


def test_a_page_hears_the_time_of_the_document_that_it_names_and_shares_what_runs_now():
    async def run() -> None:
        live, recording = MemorySource(), RecordingSource(words(), "/bag", BEGIN + 30 * S)
        publisher, shown = live.offer("/words", STRING), dict[str, RecordingSource]()
        topics = BrowserTopics(live)
        topics.source_of = shown.get
        one, other = KeepingHearer(), KeepingHearer()
        for hearer, document in ((one, "rover"), (other, "arm")):
            topics.attach(hearer)
            asked = Subscribe(subscription=1, document=document, topic="/words", mode="newest")
            topics.carry_out(hearer, asked)
        assert len(live.opened) == 1
        publisher.say(text_payload("now"))
        await until(lambda: heard(one) == heard(other) == ["now"])
        assert one.told[-1].channel == other.told[-1].channel
        shown["rover"] = recording
        topics.switch("rover")
        await until(lambda: heard(one)[-1] == "300")
        publisher.say(text_payload("later"))
        await until(lambda: heard(other)[-1] == "later")
        assert heard(one)[-1] == "300"
        recording.jump(BEGIN + 10 * S)
        await until(lambda: heard(one)[-1] == "100")
        del shown["rover"]
        topics.switch("rover")
        publisher.say(text_payload("back"))
        await until(lambda: heard(one)[-1] == heard(other)[-1] == "back")
        await topics.close()
        await asyncio.to_thread(recording.close)

    asyncio.run(run())


def test_who_may_not_see_a_document_hears_nothing_of_its_time():
    async def run() -> None:
        live = MemorySource()
        topics, hearer = BrowserTopics(live), KeepingHearer()
        topics.attach(hearer)
        asked = Subscribe(subscription=1, document="hidden", topic="/words", mode="newest")
        topics.carry_out(hearer, asked)
        assert [one.reason for one in hearer.refused] == ["There is no such document."]
        assert live.opened == []
        await topics.close()

    asyncio.run(run())


def test_who_subscribes_a_topic_once_more_misses_nothing_and_has_what_is_latched_again():
    async def run() -> None:
        live = MemorySource()
        plain = live.offer("/words", STRING)
        topics, hearer = BrowserTopics(live), KeepingHearer()
        topics.attach(hearer)
        asked = Subscribe(subscription=1, topic="/words", mode="every")
        topics.carry_out(hearer, asked)
        plain.say(text_payload("first"))
        await until(lambda: heard(hearer) == ["first"])
        plain.say(text_payload("on its way"))
        topics.carry_out(hearer, asked)
        assert heard(hearer) == ["first", "on its way"]
        live.offer("/words", STRING, LATCHED).say(text_payload("kept"))
        await until(lambda: heard(hearer)[-1] == "kept")
        topics.carry_out(hearer, asked)
        assert hearer.ticks[-1].kept_for == 1
        assert {one.kept_for for one in hearer.ticks[:-1]} == {-1}
        await topics.close()

    asyncio.run(run())
