"""A recording as a source of topics: what comes at a moment, while it plays, and after jumps."""

from __future__ import annotations

import queue
import threading
import time
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

from studio.errors import BagError, BagNotReadableError, StudioError
from studio.live.time.recording_source import FAR_NS, RecordingSource
from studio.live.topics.request import Request
from studio.ros.qos import DurabilityPolicy, QoSProfile
from tests.support.memory_recording import MemoryRecording
from tests.support.topic_worlds import BOOL, STRING, text_of, text_payload
from tests.support.transforms import S
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator, Iterable, Iterator

    from studio.bags.recording import Recorded
    from studio.live.topics.subscription import Subscription
    from studio.ros.node.samples import RawSample

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
BEGIN = 1_700_000_000 * S


def words(
    count: int = 600, every_ns: int = S // 10, made: MemoryRecording | None = None
) -> MemoryRecording:
    """Numbers ten times a second, a latched text, and a flag each second."""
    made = made or MemoryRecording()
    made.add_topic("/words", STRING, QoSProfile(depth=10))
    made.add_topic("/latched", STRING, LATCHED)
    made.add_topic("/flag", BOOL)
    made.say("/latched", BEGIN, data="once")
    for number in range(count):
        made.say("/words", BEGIN + number * every_ns, data=str(number))
        if number % 10 == 0:
            made.say("/flag", BEGIN + number * every_ns + 1, data=True)
    return made


@contextmanager
def source(recording: MemoryRecording, at_s: float = 0.0) -> Generator[RecordingSource]:
    made = RecordingSource(recording, "/bag", BEGIN + round(at_s * S))
    try:
        yield made
    finally:
        made.close()


def jump(made: RecordingSource, at_s: float, *, settled: bool = True) -> StudioError | None:
    """Jump and wait until it is done; what went wrong."""
    done, troubles = threading.Event(), list[StudioError | None]()

    def jumped(trouble: StudioError | None) -> None:
        troubles.append(trouble)
        done.set()

    made.jump(BEGIN + round(at_s * S), jumped, settled=settled)
    assert done.wait(30)
    return troubles[0]


def texts(samples: Iterable[RawSample]) -> list[str]:
    return [text_of(one.payload) for one in samples]


def receiving(one: Subscription) -> Subscription:
    wait_until("it to be received", lambda: one.state.kind == "receiving")
    return one


def test_a_subscription_has_what_there_was_at_the_moment():
    with source(words(), at_s=30.0) as made:
        newest = receiving(made.subscribe(Request("/words", newest_only=True)))
        latched = receiving(made.subscribe(Request("/latched")))
        assert texts(newest.take()) == ["300"]
        assert texts(latched.take()) == ["once"]
        assert made.now_ns == BEGIN + 30 * S
        assert texts(made.latest(["/words"], BEGIN + S).values()) == ["10"]
        assert texts(made.window("/words", BEGIN, BEGIN + S // 4)) == ["0", "1", "2"]


def test_who_comes_later_has_the_same_though_time_stands_still():
    with source(words(), at_s=30.0) as made:
        request = Request("/words", newest_only=True)
        assert texts(receiving(made.subscribe(request)).take()) == ["300"]
        later = receiving(made.subscribe(request))
        assert texts(later.take()) == ["300"]
        assert texts(later.kept()) == ["300"]
        deeper = receiving(made.subscribe(Request("/words", depth=3)))
        assert texts(deeper.take()) == ["298", "299", "300"]


def test_a_jump_back_gives_the_state_of_then_in_another_epoch():
    with source(words(), at_s=30.0) as made:
        one = receiving(made.subscribe(Request("/words", depth=2)))
        latched = receiving(made.subscribe(Request("/latched")))
        before, begun = made.epoch, (one.beginnings, latched.beginnings)
        assert jump(made, 10.0) is None
        assert texts(one.take())[-2:] == ["99", "100"]
        assert made.epoch != before
        assert one.beginnings == begun[0] + 1
        assert latched.beginnings == begun[1]  # what it has is what it would be given again
        assert made.playhead.at_ns == BEGIN + 10 * S


def test_a_short_jump_ahead_goes_on_and_a_long_one_begins_anew():
    with source(words(), at_s=10.0) as made:
        one = receiving(made.subscribe(Request("/words", depth=50)))
        one.take()
        before = made.epoch
        jump(made, 11.0)
        assert texts(one.take()) == [str(number) for number in range(101, 111)]
        assert made.epoch == before
        jump(made, 11.1 + FAR_NS / S)
        assert made.epoch != before


def test_after_a_drag_what_was_left_out_comes():
    with source(words(), at_s=0.0) as made:
        one = receiving(made.subscribe(Request("/words", depth=80)))
        jump(made, 40.0, settled=False)
        assert len(one.take()) < 80
        before = made.epoch
        jump(made, 40.0)
        assert len(one.take()) == 80
        assert made.epoch != before


def test_of_jumps_that_wait_the_last_is_made_and_all_are_told():
    recording = words()
    with source(recording, at_s=0.0) as made:
        receiving(made.subscribe(Request("/words", newest_only=True)))
        asked, told, all_told = 50, list[StudioError | None](), threading.Event()

        def jumped(trouble: StudioError | None) -> None:
            told.append(trouble)
            if len(told) == asked:
                all_told.set()

        made.change(lambda head: head)
        for number in range(asked):
            made.jump(BEGIN + number * S, jumped, settled=False)
        assert all_told.wait(30)
        assert made.playhead.at_ns == BEGIN + (asked - 1) * S
        assert told == [None] * asked


def test_while_it_plays_all_comes_in_the_order_of_its_times_and_it_ends():
    came: list[tuple[int, str]] = []
    with source(words(200, S // 100)) as made:
        ended = threading.Event()
        made.on_stop = lambda _: ended.set()
        for topic in ("/words", "/flag"):

            def take(sample: RawSample, topic: str = topic) -> None:
                came.append((sample.received_ns, topic))

            receiving(made.subscribe(Request(topic, depth=1), take=take))
        came.clear()
        made.change(lambda head: replace(head.started(BEGIN, BEGIN + 2 * S), rate=4.0))
        assert ended.wait(30)
        assert not made.playhead.playing
        assert len(came) == 199 + 20
        assert came == sorted(came)
        assert made.playhead.at_ns == made.recording.end_ns


class SlowRecording(MemoryRecording):
    """Reads one message after the other slowly, ten in a second."""

    def messages(self, topics: Iterable[str], begin_ns: int, end_ns: int) -> Iterator[Recorded]:
        for one in super().messages(topics, begin_ns, end_ns):
            time.sleep(0.1)
            yield one


def test_what_is_read_too_slowly_is_left_out_but_for_the_newest_and_time_goes_on():
    flags: list[int] = []
    with source(words(300, made=SlowRecording())) as made:
        ended = threading.Event()
        made.on_stop = lambda _: ended.set()
        newest = receiving(made.subscribe(Request("/words", newest_only=True)))
        deep = Request("/flag", depth=100, waiting_max=100)
        receiving(made.subscribe(deep, take=lambda one: flags.append(one.received_ns)))
        flags.clear()
        epoch, before = made.epoch, newest.received
        made.change(lambda head: replace(head, playing=True, rate=10.0))
        wait_until("it is said", lambda: made.is_skipping)
        assert ended.wait(30)
        assert not made.is_skipping
        assert 5 < newest.received - before < 200  # of 300 in three seconds
        assert texts(newest.take()) == ["299"]
        assert flags == [BEGIN + number * S + 1 for number in range(30)]
        assert made.epoch == epoch


class GoneRecording(MemoryRecording):
    """A file that cannot be read from its second second on."""

    def messages(self, topics: Iterable[str], begin_ns: int, end_ns: int) -> Iterator[Recorded]:
        for one in super().messages(topics, begin_ns, end_ns):
            if one.sample.received_ns > BEGIN + S:
                raise BagError("The disk is gone.")
            yield one


def test_who_plays_on_where_a_file_fails_is_told_again():
    with source(words(made=GoneRecording()), at_s=0.9) as made:
        stops: queue.SimpleQueue[str] = queue.SimpleQueue()
        made.on_stop = stops.put
        receiving(made.subscribe(Request("/words", newest_only=True)))
        for _ in range(2):
            made.change(lambda head: replace(head, playing=True))
            assert stops.get(timeout=30) == "The disk is gone."


def test_a_loop_is_a_jump_back_each_time():
    with source(words(200, S // 100)) as made:
        one = receiving(made.subscribe(Request("/words", depth=1)))
        before = made.epoch
        loop = BEGIN, BEGIN + S // 5
        made.change(lambda head: replace(head, playing=True, rate=2.0, loop=loop))
        wait_until("it to begin again", lambda: made.epoch > before + 2)
        made.change(lambda head: replace(head, playing=False))
        assert all(one.received_ns <= loop[1] + S // 10 for one in one.take())


def test_a_topic_that_cannot_be_read_says_why_and_one_of_another_form_is_not_decoded():
    recording = words()
    recording.add_topic("/locked", STRING, trouble="It is encoded as protobuf.")
    recording.add_topic("/old", STRING, type_hash="RIHS01_" + "1" * 64)
    recording.say("/old", BEGIN, data="x")
    with source(recording, at_s=1.0) as made:
        locked = made.subscribe(Request("/locked"))
        wait_until("it to be refused", lambda: locked.state.kind == "refused")
        assert locked.state.reason == "It is encoded as protobuf."
        old = made.subscribe(Request("/old", (STRING,), as_known_here=True))
        wait_until("its form to be seen", lambda: old.state.kind == "other_form")
        assert "was recorded with a std_msgs/msg/String of another form" in old.state.sentence
        assert old.take() == []
        gone = made.subscribe(Request("/gone"))
        wait_until("it to be missed", lambda: gone.state.kind == "no_publisher")
        assert gone.state.sentence == "/gone is not in the recording."
        raw = receiving(made.subscribe(Request("/old")))
        assert texts(raw.take()) == ["x"]


def test_what_it_says_of_topics_is_what_was_recorded():
    with source(words(), at_s=30.0) as made:
        names = [one.name for one in made.catalogue()]
        assert names == ["/flag", "/latched", "/words"]
        [publisher] = made.publishers("/latched")
        assert (publisher.node, publisher.qos) == ("/bag", LATCHED)
        assert made.publishers("/none") == ()
        flows = made.flows(["/words", "/latched", "/none"])
        assert flows.keys() == {"/words", "/latched"}
        assert 9 <= flows["/words"].rate_hz <= 11
        assert flows["/latched"].age_s == 30.0


def test_a_file_that_cannot_be_read_any_more_is_told_and_costs_nobody_what_they_had():
    recording = words()
    with source(recording, at_s=10.0) as made:
        one = receiving(made.subscribe(Request("/words", newest_only=True)))
        last = recording.last

        def broken(*_: object) -> list[RawSample]:
            raise BagNotReadableError("run.mcap", "the disk fails")

        recording.last = broken  # type: ignore[method-assign]
        trouble = jump(made, 20.0)
        assert isinstance(trouble, BagNotReadableError)
        assert made.playhead.at_ns == BEGIN + 10 * S
        assert texts(one.take()) == ["100"]
        recording.last = last  # type: ignore[method-assign]
        assert jump(made, 20.0) is None
        assert texts(one.take()) == ["200"]


def test_where_time_stands_still_the_transforms_that_come_next_are_there_to_be_looked_up():
    recording = words(10)
    recording.add_topic("/tf", "tf2_msgs/msg/TFMessage")
    for number in range(10):
        recording.add("/tf", BEGIN + number * S // 10, text_payload(str(number)))
    with source(recording, at_s=0.25) as made:
        receiving(made.subscribe(Request("/tf")))
        jump(made, 0.35)
        assert texts(made.later_tf) == ["4", "5", "6"]
        made.change(lambda head: replace(head, playing=True, rate=0.1))
        assert made.later_tf == ()
        made.change(lambda head: replace(head, playing=False))
        wait_until("what comes next to be read", lambda: bool(made.later_tf))
