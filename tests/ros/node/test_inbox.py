from __future__ import annotations

from studio.ros.attachment import Attachment
from studio.ros.node.inbox import Inbox, RawSample


def samples(*numbers: int) -> list[RawSample]:
    return [RawSample(b"", Attachment(number, 0, b"g" * 16), 0) for number in numbers]


def numbers_in(inbox: Inbox) -> list[int]:
    found: list[int] = []
    while (sample := inbox.take()) is not None:
        found.append(sample.attachment.sequence)
    return found


def test_samples_come_out_in_the_order_in_which_they_came():
    inbox = Inbox(10)
    inbox.post(samples(1, 2))
    inbox.post(samples(3))
    assert numbers_in(inbox) == [1, 2, 3]


def test_a_slow_reader_gets_the_newest_of_its_depth():
    inbox = Inbox(2)
    for number in range(1, 6):
        inbox.post(samples(number))
    assert inbox.overwritten == 3
    assert numbers_in(inbox) == [4, 5]


def test_what_came_between_two_looks_is_no_backlog():
    inbox = Inbox(2)
    inbox.post(samples(1, 2, 3, 4, 5))
    assert inbox.overwritten == 0
    assert len(inbox) == 5


def test_what_waited_falls_out_for_a_burst():
    inbox = Inbox(2)
    inbox.post(samples(1, 2))
    inbox.post(samples(3, 4, 5))
    assert inbox.overwritten == 2
    assert numbers_in(inbox) == [3, 4, 5]
