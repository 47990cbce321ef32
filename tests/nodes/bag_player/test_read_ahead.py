from __future__ import annotations

import threading
from typing import TYPE_CHECKING

import pytest

from studio.bags.recording import Recorded
from studio.errors import RecordingError
from studio.nodes.bag_player import read_ahead
from studio.nodes.bag_player.read_ahead import ReadAhead
from studio.ros.attachment import Attachment
from studio.ros.condition import Condition
from studio.ros.node.samples import RawSample
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator


def numbered(count: int, size: int = 1, read: list[int] | None = None) -> Iterator[Recorded]:
    for at in range(count):
        if read is not None:
            read.append(at)
        yield Recorded("/t", RawSample(b"x" * size, Attachment(at, 0, b""), at))


class Reader:
    """Reads ahead as a player does."""

    def __init__(self, messages: Iterator[Recorded], most: int) -> None:
        self.lock = threading.Lock()
        self.arrived = Condition(self.lock)
        self.ahead = ReadAhead(self.lock, self.arrived, messages, most)

    def take(self) -> int | None:
        """The number of the next message; None at the end."""
        with self.lock:
            while (head := self.ahead.head()) is None and not self.ahead.is_over:
                self.arrived.wait()
            if head is not None:
                self.ahead.pop()
            return None if head is None else head.sample.received_ns

    def close(self) -> None:
        with self.lock:
            self.ahead.close()
        self.ahead.join()


def test_all_come_in_their_order_and_then_the_end():
    reader = Reader(numbered(1_000), 7)
    assert [reader.take() for _ in range(1_001)] == [*range(1_000), None]


def test_no_more_are_read_than_may_wait():
    read: list[int] = []
    reader = Reader(numbered(1_000, read=read), 10)
    wait_until("it is full", lambda: reader.ahead.is_filled)
    wait_until("one more is at hand", lambda: len(read) == 11)
    reader.take()
    wait_until("it reads again", lambda: len(read) == 12)
    reader.close()
    assert len(read) == 12
    assert not reader.ahead.is_alive


def test_large_messages_wait_in_fewer_numbers(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(read_ahead, "BYTES_MAX", 100)
    read: list[int] = []
    reader = Reader(numbered(50, size=30, read=read), 1_000)
    wait_until("it is full", lambda: reader.ahead.is_filled)
    wait_until("one more is at hand", lambda: len(read) == 5)
    assert [reader.take() for _ in range(51)] == [*range(50), None]


def test_a_message_that_is_larger_than_all_that_may_wait_comes_too(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.setattr(read_ahead, "BYTES_MAX", 100)
    reader = Reader(numbered(3, size=1_000), 10)
    assert [reader.take() for _ in range(4)] == [0, 1, 2, None]


def test_what_was_read_before_a_fault_comes_and_then_the_fault():
    def torn() -> Iterator[Recorded]:
        yield from numbered(3)
        raise RecordingError("It is torn.")

    reader = Reader(torn(), 10)
    assert [reader.take() for _ in range(3)] == [0, 1, 2]
    with pytest.raises(RecordingError):
        reader.take()
