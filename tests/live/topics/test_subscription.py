"""Queues of subscribers, and when samples came."""

from __future__ import annotations

from studio.live.topics.request import Request
from studio.live.topics.subscription import Arrivals
from tests.support.memory_source import MemorySource

STRING = "std_msgs/msg/String"


def test_where_only_the_newest_counts_the_others_are_no_loss():
    source = MemorySource()
    said = source.offer("/said", STRING)
    newest = source.subscribe(Request("/said", newest_only=True))
    for number in range(5):
        said.say(bytes([number]))
    assert [one.payload for one in newest.take_each()] == [b"\x04"]
    assert list(newest.take_each()) == []
    assert (newest.received, newest.lost, newest.dropped) == (5, 0, 0)


def test_where_every_one_counts_they_come_in_order_and_what_falls_out_is_counted():
    source = MemorySource()
    said = source.offer("/said", STRING)
    every = source.subscribe(Request("/said", waiting_max=1_000))
    for number in range(1003):
        said.say(bytes([number % 256]))
    assert [one.payload[0] for one in every.take_each()] == [n % 256 for n in range(3, 1003)]
    assert every.dropped == 3


def test_a_few_large_ones_are_let_go_before_they_fill_the_memory():
    source = MemorySource()
    said = source.offer("/said", STRING)
    every = source.subscribe(Request("/said"))
    for number in range(4):
        said.say(bytes([number]) * (30 << 20))
    assert [one.payload[0] for one in every.take_each()] == [2, 3]
    said.say(b"\x09" * (100 << 20))
    assert len(list(every.take_each())) == 1


def test_the_rate_is_that_of_the_last_two_seconds():
    arrivals = Arrivals()
    assert (arrivals.rate_hz(0), arrivals.last_ns) == (0.0, None)
    for number in range(21):
        arrivals.add(number * 100_000_000, 1)
    assert arrivals.rate_hz(2_000_000_000) == 10.0
    assert arrivals.last_ns == 2_000_000_000
    assert arrivals.rate_hz(9_000_000_000) == 0.0


def test_the_rate_counts_what_came_together_and_what_was_passed_over():
    arrivals = Arrivals()
    arrivals.add(0, 1)
    arrivals.add(1_000_000_000, 20)
    assert arrivals.rate_hz(1_000_000_000) == 20.0


def test_the_age_is_that_of_what_came_for_the_subscriber():
    source = MemorySource()
    said = source.offer("/said", STRING)
    early = source.subscribe(Request("/said"))
    said.say(b"", 1_000)
    assert early.age_ns(1_500) == 500
    late = source.subscribe(Request("/said"))
    assert late.age_ns(1_500) is None


def test_what_waits_is_forgotten_when_the_topic_is_published_as_another_type():
    source = MemorySource()
    source.offer("/said", STRING).say(b"not yet heard")
    texts = source.speakers("/said")[0]
    either = source.subscribe(Request("/said", (STRING, "std_msgs/msg/Bool")))
    texts.say(b"text")
    texts.leave()
    source.offer("/said", "std_msgs/msg/Bool").say(b"bool")
    assert [one.payload for one in either.take_each()] == [b"bool"]
    assert either.fit is not None
    assert either.fit.type_name == "std_msgs/msg/Bool"
