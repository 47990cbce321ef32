from __future__ import annotations

from studio.live.topics.frames import Chunk, chunk_of
from studio.server.backlog import KEPT_BYTES, NEWEST_BYTES, Backlog
from tests.live.topics.test_frames import samples
from tests.support.hearers import read_frame


def chunk(channel: int, *payloads: bytes, keeps_all: bool) -> Chunk:
    return chunk_of(channel, samples(list(payloads)), 0, keeps_all=keeps_all)


def payloads(frame: bytes) -> list[bytes]:
    return [one.payload for one in read_frame(frame)[1]]


def test_of_a_channel_where_the_newest_counts_only_that_is_kept():
    backlog = Backlog()
    for text in (b"old", b"newer", b"newest"):
        backlog.add([chunk(1, text, keeps_all=False), chunk(2, text, keeps_all=True)])
    assert sorted(payloads(backlog.frame())) == [b"newer", b"newest", b"newest", b"old"]
    assert not backlog
    assert backlog.dropped == 0


def test_what_a_browser_owes_is_bounded_and_what_is_given_up_is_counted():
    backlog = Backlog()
    big = bytes(KEPT_BYTES // 4)
    for _ in range(10):
        backlog.add([chunk(1, big, b"x", keeps_all=True)])
    dropped, came = read_frame(backlog.frame())
    assert dropped == backlog.dropped == 20 - len(came) == 14
    assert read_frame(backlog.frame()) == (14, [])


def test_the_newest_of_many_large_channels_are_bounded_together():
    backlog = Backlog()
    big = bytes(NEWEST_BYTES // 4)
    for channel in (1, 2, 3, 4, 5, 2):
        backlog.add([chunk(channel, big, keeps_all=False)])
    assert [one.channel for one in backlog.take_all()] == [4, 5, 2]
    backlog.add([chunk(1, bytes(2 * NEWEST_BYTES), keeps_all=False)])
    assert backlog
    assert backlog.dropped == 0


def test_what_is_taken_one_by_one_comes_from_either_kind_in_turn_the_oldest_first():
    backlog = Backlog()
    for channel in (1, 2, 3, 4, 5):
        backlog.add([chunk(channel, b"x", keeps_all=channel < 4)])
    assert [backlog.pop().channel for _ in range(5)] == [4, 1, 5, 2, 3]
    assert not backlog
    backlog.add([chunk(1, bytes(KEPT_BYTES - 100), keeps_all=True)])
    backlog.add([chunk(1, b"x", keeps_all=True)])
    assert backlog.dropped == 0, "what was taken out is owed no more"


def test_what_waits_of_one_channel_can_be_taken_before_the_others():
    backlog = Backlog()
    for text in (b"a", b"b"):
        backlog.add([chunk(1, text, keeps_all=True), chunk(2, text, keeps_all=False)])
        backlog.add([chunk(3, text, keeps_all=True)])
    assert [one.channel for one in backlog.take_of(1)] == [1, 1]
    assert [one.channel for one in backlog.take_of(2)] == [2]
    assert not backlog.take_of(1)
    assert payloads(backlog.frame()) == [b"a", b"b"]


def test_what_is_given_up_is_told_with_its_channel():
    given_up: list[int] = []
    backlog = Backlog(lambda one: given_up.append(one.channel))
    for channel in (1, 2, 3):
        backlog.add([chunk(channel, bytes(KEPT_BYTES // 2), keeps_all=True)])
    assert given_up == [1, 2]
