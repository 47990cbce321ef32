"""What comes in is read in order, by one thread, until its source is taken back."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

import pytest

from studio.ros.wire.zenoh import BATCH_MAX, ReadingThread, declare_publisher, declare_subscription
from tests.support.wire import session_pair, wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

    import zenoh

    from studio.ros.wire.zenoh import Incoming, Outgoing

MANY = 2 * BATCH_MAX + 1


@pytest.fixture
def ends() -> Iterator[tuple[Outgoing, Incoming[zenoh.Sample]]]:
    with session_pair() as (one, other):
        samples = declare_subscription(other.zenoh, "0/a", MANY, reliable=True)
        publisher = declare_publisher(one.zenoh, "0/a", blocking=True, reliable=True)

        def arrives() -> bool:
            publisher.put(b"first")
            return samples.try_recv() is not None

        wait_until("the first sample", arrives)
        while samples.try_recv() is not None:
            pass
        yield publisher, samples


def test_all_is_read_in_order_and_in_batches_that_end(
    ends: tuple[Outgoing, Incoming[zenoh.Sample]],
):
    publisher, samples = ends
    for number in range(MANY):
        publisher.put(str(number).encode())
    batches: list[list[str]] = []

    def take(batch: list[zenoh.Sample]) -> None:
        batches.append([sample.payload.to_string() for sample in batch])

    reading = ReadingThread("test-reading", samples, take)
    wait_until("all of them", lambda: sum(map(len, batches)) >= MANY)
    reading.close()
    read = [number for batch in batches for number in batch if number != "first"]
    assert read == [str(number) for number in range(MANY)]
    assert max(map(len, batches)) <= BATCH_MAX


def test_a_batch_that_cannot_be_taken_is_logged_and_the_next_is_read(
    ends: tuple[Outgoing, Incoming[zenoh.Sample]], caplog: pytest.LogCaptureFixture
):
    publisher, samples = ends
    taken: list[str] = []

    def take(batch: list[zenoh.Sample]) -> None:
        for sample in batch:
            taken.append(sample.payload.to_string())
            if taken[-1] == "bad":
                raise ValueError(taken[-1])

    reading = ReadingThread("test-reading", samples, take)
    for text in ("bad", "good"):
        publisher.put(text.encode())
        wait_until(f"the {text} one", lambda wanted=text: wanted in taken)
    reading.close()
    assert "could not take" in caplog.text


def test_its_thread_ends_when_it_is_closed_and_when_its_session_is():
    def names() -> set[str]:
        return {thread.name for thread in threading.enumerate()}

    with session_pair() as (one, _):
        for name in ("closed", "abandoned"):
            samples = declare_subscription(one.zenoh, f"0/{name}", 1, reliable=True)
            taken: list[zenoh.Sample] = []
            reading = ReadingThread(name, samples, taken.extend)
            assert name in names()
            if name == "closed":
                reading.close()
                reading.close()
                assert name not in names()
    wait_until("the thread to end with its session", lambda: "abandoned" not in names())
