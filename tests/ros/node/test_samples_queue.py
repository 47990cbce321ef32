from __future__ import annotations

from studio.ros.attachment import Attachment
from studio.ros.node.samples import BLINK_NS, SAMPLES_MAX, RawSample, SampleQueue


def samples(*numbers: int, at_ns: int = 0) -> list[RawSample]:
    return [RawSample(b"", Attachment(number, 0, b"g" * 16), at_ns) for number in numbers]


def numbers_in(inbox: SampleQueue) -> list[int]:
    found: list[int] = []
    while (sample := inbox.take()) is not None:
        found.append(sample.attachment.sequence)
    return found


def test_samples_come_out_in_the_order_in_which_they_came():
    inbox = SampleQueue(10)
    inbox.post(samples(1, 2))
    inbox.post(samples(3))
    assert numbers_in(inbox) == [1, 2, 3]


def test_a_slow_reader_gets_the_newest_of_its_depth():
    inbox = SampleQueue(2)
    for number in range(1, 6):
        inbox.post(samples(number, at_ns=number * BLINK_NS))
    assert inbox.overwritten == 3
    assert numbers_in(inbox) == [4, 5]


def test_what_came_within_a_blink_is_no_backlog():
    inbox = SampleQueue(2)
    inbox.post(samples(1, 2, 3, at_ns=1))
    inbox.post(samples(4, 5, at_ns=BLINK_NS))
    assert inbox.overwritten == 0
    assert len(inbox) == 5


def test_a_depth_of_one_is_the_newest_and_nothing_else():
    inbox = SampleQueue(1)
    inbox.post(samples(1, 2, at_ns=5))
    inbox.post(samples(3, at_ns=5))
    assert numbers_in(inbox) == [3]


def test_a_flood_within_a_blink_is_bounded():
    inbox = SampleQueue(2)
    inbox.post(samples(*range(2 * SAMPLES_MAX), at_ns=1))
    assert (len(inbox), inbox.overwritten) == (SAMPLES_MAX, SAMPLES_MAX)


def test_a_depth_that_is_larger_is_kept():
    inbox = SampleQueue(2 * SAMPLES_MAX)
    inbox.post(samples(*range(2 * SAMPLES_MAX), at_ns=1))
    assert inbox.overwritten == 0


def test_a_clock_that_is_set_back_makes_no_backlog_without_bounds():
    inbox = SampleQueue(2)
    for number in range(2 * SAMPLES_MAX):
        inbox.post(samples(number, at_ns=-number * BLINK_NS))
    assert len(inbox) == SAMPLES_MAX
