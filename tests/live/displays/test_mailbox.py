from studio.displays.display import Received
from studio.live.displays.mailbox import Mailbox


def received(number: int, at_ns: int = 0, size: int = 1) -> Received:
    return Received("std_msgs/msg/Empty", bytes([number]) * size, at_ns)


def test_where_only_the_newest_counts_the_others_are_no_loss():
    box = Mailbox(newest_only=True)
    for number in range(5):
        box.post(received(number))
    assert [one.cdr for one in list(box.take())] == [b"\x04"]
    assert list(box.take()) == []
    assert (box.heard, box.lost) == (5, 0)


def test_where_every_one_counts_they_come_in_order_and_what_falls_out_is_counted():
    box = Mailbox(newest_only=False)
    for number in range(1003):
        box.post(received(number % 256))
    assert [one.cdr[0] for one in list(box.take())] == [number % 256 for number in range(3, 1003)]
    assert box.lost == 3


def test_a_few_large_ones_are_let_go_before_they_fill_the_memory():
    box = Mailbox(newest_only=False)
    for number in range(4):
        box.post(received(number, size=30 << 20))
    assert [one.cdr[0] for one in list(box.take())] == [2, 3]
    box.post(received(9, size=100 << 20))
    assert len(list(box.take())) == 1


def test_the_rate_is_that_of_the_last_two_seconds():
    box = Mailbox(newest_only=True)
    assert (box.rate_hz(0), box.age_ns(0)) == (0.0, None)
    for number in range(21):
        box.post(received(number, number * 100_000_000))
    assert box.rate_hz(2_000_000_000) == 10.0
    assert box.age_ns(2_500_000_000) == 500_000_000
    assert box.rate_hz(9_000_000_000) == 0.0
