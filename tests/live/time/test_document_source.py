"""A document's topics: the live ones until a recording is put in their place, and back."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from studio.live.time.document_source import DocumentSource
from studio.live.time.recording_source import RecordingSource
from studio.live.topics.request import Request
from tests.live.time.test_recording_source import BEGIN, receiving, texts, words
from tests.support.memory_source import MemorySource
from tests.support.topic_worlds import STRING, text_payload

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.samples import RawSample


@contextmanager
def both() -> Generator[tuple[MemorySource, DocumentSource, RecordingSource]]:
    live = MemorySource()
    made = DocumentSource(live)
    recording = RecordingSource(words(), "/bag", BEGIN, made.settling)
    try:
        yield live, made, recording
    finally:
        recording.close()


def test_subscriptions_go_to_the_recording_and_back_and_keep_nothing_of_before():
    with both() as (live, made, recording):
        publisher = live.offer("/words", STRING)
        one = made.subscribe(Request("/words", newest_only=True))
        publisher.say(text_payload("now"))
        epochs, is_live = [made.epoch], [made.is_live]
        made.show(recording)
        assert texts(receiving(one).take()) == ["0"]
        publisher.say(text_payload("unheard"))
        assert one.take() == []
        assert live.opened == []
        epochs.append(made.epoch)
        is_live.append(made.is_live)
        made.show(None)
        publisher.say(text_payload("again"))
        assert texts(one.take()) == ["again"]
        epochs.append(made.epoch)
        assert len(set(epochs)) == 3
        assert is_live == [True, False]
        assert one.beginnings == 2


def test_a_live_subscription_is_the_live_sources_own():
    with both() as (live, made, _):
        publisher = live.offer("/words", STRING)
        came: list[RawSample] = []
        one = made.subscribe(Request("/words"), take=came.append)
        publisher.say(text_payload("a"))
        assert texts(came) == ["a"]
        one.close()
        assert live.opened == []


def test_who_subscribes_while_a_recording_is_shown_hears_what_runs_once_that_is_shown():
    with both() as (live, made, recording):
        made.show(recording)
        one = receiving(made.subscribe(Request("/words", newest_only=True)))
        closed = receiving(made.subscribe(Request("/words", newest_only=True)))
        closed.close()
        publisher = live.offer("/words", STRING)
        made.show(None)
        publisher.say(text_payload("now"))
        assert texts(one.take()) == ["now"]
        assert closed.take() == []
