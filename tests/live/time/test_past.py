"""The last minutes in memory: what a list of all messages would say, within a bound."""

from __future__ import annotations

import itertools
import tracemalloc
from typing import TYPE_CHECKING

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from studio.live.time.past import Inbox, LivePast
from studio.live.topics.request import Fit
from studio.ros.attachment import Attachment
from studio.ros.messages import shared_types
from studio.ros.node.samples import RawSample
from studio.ros.qos import DurabilityPolicy, QoSProfile

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    import pytest

MEGABYTE = 1 << 20
SECOND = 1_000_000_000
BEGIN = 1_700_000_000 * SECOND
_TYPE = "std_msgs/msg/String"


def fit(type_name: str = _TYPE, *, latched: bool = False) -> Fit:
    return Fit(type_name, "RIHS01_1", True, latched, 10)


def a_past(size_max: int = 64 * MEGABYTE) -> LivePast:
    past = LivePast(size_max, shared_types)
    past.keep(keeping=True)
    return past


def opened(past: LivePast, topic: str, *, latched: bool = False, type_name: str = _TYPE) -> Inbox:
    return past.begin(topic, fit(type_name, latched=latched), tuple)


def sample(
    at_ns: int, payload: bytes = b"", *, number: int = 1, sender: bytes = b"a" * 16
) -> RawSample:
    return RawSample(payload, Attachment(number, at_ns, sender), at_ns)


def payloads(samples: Iterable[RawSample]) -> list[bytes]:
    return [one.payload for one in samples]


def stream(count: int, every_ns: int, size: int) -> list[RawSample]:
    """Messages from `BEGIN` on, each with its number at its beginning."""
    return [
        sample(BEGIN + at * every_ns, at.to_bytes(8, "big") + bytes(size - 8), number=at + 1)
        for at in range(count)
    ]


# Beside a list

TOPICS = ("/a", "/b", "/c")
_batches = st.lists(
    st.tuples(st.sampled_from(TOPICS), st.lists(st.integers(0, 3 * SECOND), max_size=5)),
    max_size=30,
)
_times = st.integers(-SECOND, 200 * SECOND)


def filled(batches: Sequence[tuple[str, list[int]]]) -> tuple[LivePast, list[tuple[str, int]]]:
    """A past and the topic and time of each of its messages; payloads are their numbers."""
    past, said = a_past(), list[tuple[str, int]]()
    inboxes = {topic: opened(past, topic) for topic in TOPICS}
    now_ns = BEGIN
    for topic, steps in batches:
        came: list[RawSample] = []
        for step in steps:
            now_ns += step
            came.append(sample(now_ns, b"%d" % len(said)))
            said.append((topic, now_ns))
        if came:
            inboxes[topic].put(came)
    return past, said


@given(_batches, _times, _times, st.integers(0, 6), st.integers(1, 7))
def test_it_answers_as_a_list_of_all_messages_does(
    batches: list[tuple[str, list[int]]], first: int, second: int, most: int, bins: int
):
    past, said = filled(batches)
    begin_ns, end_ns = BEGIN + min(first, second), BEGIN + max(first, second)
    of = {
        topic: [(at, n) for n, (name, at) in enumerate(said) if name == topic] for topic in TOPICS
    }
    assert past.begin_ns == (said[0][1] if said else 0)
    assert past.end_ns == (said[-1][1] if said else 0)
    for topic, all_of in of.items():
        until = [(at, b"%d" % n) for at, n in all_of if at <= end_ns]
        inside = [one for one in until if one[0] >= begin_ns]
        found = past.last(topic, end_ns, most, begin_ns)
        assert [(one.received_ns, one.payload) for one in found] == (inside[-most:] if most else [])
        newest = past.latest([topic], end_ns)
        assert payloads(newest.values()) == [one[1] for one in until[-1:]]
        after = [at for at, _ in all_of if at > begin_ns]
        before = [at for at, _ in all_of if at < begin_ns]
        assert past.next_ns(topic, begin_ns) == min(after, default=None)
        assert past.previous_ns(topic, begin_ns) == max(before, default=None)
        expected = np.zeros(bins, dtype=np.int64)
        for at, _ in all_of:
            if begin_ns <= at < end_ns:
                expected[(at - begin_ns) * bins // (end_ns - begin_ns)] += 1
        assert past.counts(topic, begin_ns, end_ns, bins).tolist() == expected.tolist()
    found = list(past.messages(("/a", "/c", "/a", "/none"), begin_ns, end_ns))
    wanted = [(name, at) for name, at in said if name in {"/a", "/c"} and begin_ns <= at < end_ns]
    assert sorted((one.topic, one.sample.received_ns) for one in found) == sorted(wanted)
    times = [one.sample.received_ns for one in found]
    assert times == sorted(times)


@given(st.lists(st.integers(-2 * SECOND, 2 * SECOND), min_size=1, max_size=30))
def test_times_never_go_back_though_the_clock_may(steps: list[int]):
    past = a_past()
    inbox = opened(past, "/a")
    times = list(itertools.accumulate(steps, initial=BEGIN))
    for at, number in zip(times, itertools.count(1), strict=False):
        inbox.put([sample(at, number=number)])
    found = [one.received_ns for one in past.last("/a", max(times), 100)]
    assert found == list(itertools.accumulate(times, max))


# Within a bound


def test_a_flood_of_small_messages_stays_within_the_bound_as_measured():
    past = a_past(2 * MEGABYTE)
    inbox = opened(past, "/small")
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    for second in range(40):
        begin_ns = BEGIN + second * SECOND
        inbox.put([sample(begin_ns + at * SECOND // 1_000, bytes(40)) for at in range(1_000)])
        past.collect()
        assert past.size <= 2 * MEGABYTE
    taken = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    assert past.end_ns - past.begin_ns > SECOND
    assert taken < 2 * MEGABYTE
    assert taken > past.size / 3, "what is counted has little to do with what is taken"


def test_nothing_is_kept_of_a_flood_beyond_the_count(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("studio.live.time.past.COUNT_MAX", 10_000)
    past = a_past(1 << 40)
    inbox = opened(past, "/empty")
    for block in range(12):
        begin_ns = BEGIN + block * SECOND
        inbox.put([sample(begin_ns + at, b"") for at in range(1_000)])
        past.collect()
        assert past.topics[0].count <= 10_000
    assert past.topics[0].count > 5_000


def test_the_oldest_goes_first_whatever_its_topic():
    past = a_past(2 * MEGABYTE)
    early, late = opened(past, "/early"), opened(past, "/late")
    early.put([sample(BEGIN + at * SECOND, bytes(1_000)) for at in range(100)])
    past.collect()
    for at in range(100, 800):
        late.put([sample(BEGIN + at * SECOND, bytes(5_000))])
        past.collect()
    assert past.size <= 2 * MEGABYTE
    assert past.last("/early", BEGIN + 800 * SECOND, 1) == []
    assert past.last("/late", BEGIN + 800 * SECOND, 1)[0].received_ns == BEGIN + 799 * SECOND


def test_a_large_topic_is_thinned_so_that_the_others_reach_as_far_back_and_says_so():
    past = a_past(16 * MEGABYTE)
    images, joints = opened(past, "/camera"), opened(past, "/joints")
    for at in range(30 * 30):  # 30 Hz of 300 kB for 30 s are 270 MB
        now_ns = BEGIN + at * 33_000_000
        images.put([sample(now_ns, bytes(300_000), number=at + 1)])
        joints.put([sample(now_ns, bytes(100), number=at + 1)])
        past.collect()
        assert past.size <= 16 * MEGABYTE
    end_ns = past.end_ns
    assert len(past.last("/joints", end_ns, 10_000)) == 900
    kept = [one.received_ns for one in past.last("/camera", end_ns, 10_000)]
    assert kept[0] - BEGIN < 6 * SECOND
    gaps = np.diff(kept)
    assert gaps[-8:].max() < 34_000_000, "the newest are to be whole"
    assert gaps.max() < 3 * SECOND, "something is to be seen of each while"
    camera, of_joints = past.topics
    assert "one message in up to" in camera.note
    assert of_joints.note == ""


def test_thinning_and_letting_go_leave_the_newest_latched_message_of_each_publisher():
    past = a_past(4 * MEGABYTE)
    latched, images = opened(past, "/map", latched=True), opened(past, "/camera")
    senders = [b"%016d" % one for one in range(5)]
    for number, sender in enumerate(senders * 3, 1):
        latched.put([sample(BEGIN + number, b"%d" % number, number=number, sender=sender)])
    for at in range(3_600):  # an hour later
        images.put([sample(BEGIN + at * SECOND, bytes(100_000), number=at + 1)])
        past.collect()
    assert past.begin_ns > BEGIN + 3_000 * SECOND
    found = past.last("/map", past.end_ns, 100)
    assert payloads(found) == [b"11", b"12", b"13", b"14", b"15"]
    assert payloads(past.latest(["/map"], past.end_ns).values()) == [b"15"]


def test_thinning_a_large_latched_topic_keeps_its_newest():
    past = a_past(4 * MEGABYTE)
    clouds = opened(past, "/cloud", latched=True)
    rare = b"r" * 16
    clouds.put([sample(BEGIN, b"rare", number=1, sender=rare)])
    for at, one in enumerate(stream(400, 50_000_000, 100_000)[1:]):
        clouds.put([one])
        past.collect()
        newest = past.last("/cloud", one.received_ns, 1)[0]
        assert newest.payload == one.payload
        assert payloads(past.last("/cloud", BEGIN, 1)) == [b"rare"], at
    assert past.topics[0].note


def test_what_is_read_stays_although_it_is_let_go_meanwhile():
    past = a_past(2 * MEGABYTE)
    inbox = opened(past, "/a")
    inbox.put(stream(100, SECOND, 1_000))
    reading = past.messages(["/a"], 0, past.end_ns + 1)
    first = next(reading)
    inbox.put([sample(BEGIN + (1_000 + at) * SECOND, bytes(10_000)) for at in range(400)])
    past.collect()
    assert past.begin_ns > BEGIN + 1_000 * SECOND
    assert [first.sample.payload, *(one.sample.payload for one in reading)] == payloads(
        stream(100, SECOND, 1_000)
    )


# What comes twice


def test_a_message_that_comes_to_two_subscriptions_is_kept_once():
    past = a_past()
    first, second = opened(past, "/a"), opened(past, "/a", latched=True)
    for one in stream(20, SECOND, 10):
        first.put([one])
        second.put([one._replace(received_ns=one.received_ns + 5)])
        past.collect()
    assert payloads(past.last("/a", past.end_ns, 100)) == payloads(stream(20, SECOND, 10))


def test_latched_messages_that_come_again_to_a_later_subscription_are_kept_once():
    past = a_past()
    said = stream(3, SECOND, 10)
    first = opened(past, "/a", latched=True)
    first.put(said)
    first.close()
    later = opened(past, "/a", latched=True)
    later.put([one._replace(received_ns=BEGIN + 100 * SECOND) for one in said])
    later.put([sample(BEGIN + 101 * SECOND, b"new", number=4)])
    assert payloads(past.last("/a", past.end_ns, 100)) == [*payloads(said), b"new"]


# When it begins and ends


def test_nothing_is_kept_before_it_keeps_and_all_is_forgotten_when_it_does_no_more():
    past = LivePast(MEGABYTE, shared_types)
    inbox = opened(past, "/a")
    inbox.put(stream(3, SECOND, 10))
    assert past.topics == []
    past.keep(keeping=True)
    inbox.put(stream(5, SECOND, 10)[3:])
    assert past.topics[0].count == 2
    epoch = past.epoch
    past.keep(keeping=False)
    inbox.put(stream(3, SECOND, 10))
    assert (past.topics, past.size, past.begin_ns, past.end_ns) == ([], 0, 0, 0)
    assert past.epoch != epoch


def test_what_was_latched_before_it_began_is_there_from_the_beginning():
    past = LivePast(MEGABYTE, shared_types)
    said = stream(2, SECOND, 10)
    inbox = past.begin("/map", fit(latched=True), lambda: said)
    past.keep(keeping=True)
    other = opened(past, "/a")
    other.put([sample(BEGIN + 3_600 * SECOND, b"now")])
    inbox.put([said[-1]])  # once more
    assert payloads(past.last("/map", past.end_ns, 10)) == payloads(said)
    assert past.begin_ns == BEGIN + 3_600 * SECOND


def test_a_topic_of_another_type_begins_anew_once_the_first_is_not_received_any_more():
    past = a_past()
    first = opened(past, "/a")
    first.put(stream(3, SECOND, 10))
    other = opened(past, "/a", type_name="std_msgs/msg/Bool")
    other.put([sample(BEGIN + 10 * SECOND, b"bool")])
    assert [one.type_name for one in past.topics] == [_TYPE]
    assert "comes as" in past.troubles[0]
    first.close()
    other.put([sample(BEGIN + 11 * SECOND, b"bool")])
    assert [(one.type_name, one.count) for one in past.topics] == [("std_msgs/msg/Bool", 1)]


def test_a_topic_says_what_its_publishers_offer_and_still_does_when_they_are_gone():
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    offered = {"/map": [latched, latched]}
    past = LivePast(MEGABYTE, shared_types, lambda topic: offered.get(topic, []))
    past.keep(keeping=True)
    inbox = opened(past, "/map", latched=True)
    inbox.put([sample(BEGIN, b"map")])
    offered.clear()
    past.note_publishers()
    (topic,) = past.topics
    assert topic.qos == (latched,)
    assert topic.is_latched
    assert topic.type_hash == "RIHS01_1"


def test_a_message_is_counted_in_its_part_however_long_the_range_is():
    past = a_past()
    inbox = opened(past, "/a")
    at_ns = 1_800_000_000_000_000_000
    inbox.put([sample(at_ns)])
    begin_ns = at_ns - 10**16
    counts = past.counts("/a", begin_ns, at_ns + 1, 4_000)
    assert (counts.sum(), counts[-1]) == (1, 1)
    topic = past.topic("/a")
    assert topic is not None
    assert topic.count == 1
    assert past.topic("/b") is None
