from __future__ import annotations

import logging
import threading
from typing import TYPE_CHECKING

import pytest

from studio.ros.node.drain import Drain
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator


class CountingSource:
    """Gives what was put in, and counts how often it was looked into."""

    def __init__(self) -> None:
        self.looks = 0
        self.waiting = 0
        self.fails = False

    def drain(self) -> int:
        self.looks += 1
        if self.fails:
            raise KeyError("x")
        came, self.waiting = self.waiting, 0
        return came


@pytest.fixture
def drain() -> Generator[Drain]:
    made = Drain()
    yield made
    made.stop()


def test_every_source_is_emptied_again_and_again(drain: Drain):
    sources = [CountingSource() for _ in range(3)]
    for source in sources:
        drain.add(source)
    for _ in range(3):
        for source in sources:
            source.waiting = 5
        wait_until("they are empty", lambda: not any(source.waiting for source in sources))


def test_a_source_that_was_removed_is_left_alone(drain: Drain):
    removed, kept = CountingSource(), CountingSource()
    drain.add(removed)
    drain.add(kept)
    drain.remove(removed)
    drain.remove(removed)
    looks = removed.looks
    wait_until("the other was looked into", lambda: kept.looks > 20)
    assert removed.looks <= looks + 1


def test_a_source_that_fails_silences_no_other(drain: Drain, caplog: pytest.LogCaptureFixture):
    failing, good = CountingSource(), CountingSource()
    failing.fails = True
    with caplog.at_level(logging.ERROR):
        drain.add(failing)
        drain.add(good)
        wait_until("the other was looked into", lambda: good.looks > 5)
    drain.remove(failing)
    assert failing.looks > 1
    assert caplog.text.count("could not be taken") == 1


def test_where_data_flows_it_looks_more_often(drain: Drain):
    idle, busy = CountingSource(), CountingSource()
    drain.add(idle)
    wait_until("it is idle", lambda: not drain.is_flowing)
    drain.add(busy)
    idle_before, busy_before = idle.looks, busy.looks
    while busy.looks < busy_before + 100:
        busy.waiting = 1
        threading.Event().wait(0.0005)
    idle_after = idle.looks  # first: whoever is kept from looking at it sees it grow meanwhile
    assert idle_after - idle_before < busy.looks - busy_before


def test_what_is_waited_for_is_looked_into_more_often_until_it_is_removed(drain: Drain):
    idle, awaited = CountingSource(), CountingSource()
    for source in (idle, awaited):
        drain.add(source)
    drain.wait_for(awaited)
    wait_until("nothing is expected any more", lambda: not drain.is_flowing)
    idle_before, awaited_before = idle.looks, awaited.looks

    def more_often() -> bool:
        nonlocal idle_before, awaited_before
        awaited_now, idle_now = awaited.looks, idle.looks
        if awaited_now - awaited_before > 2 * (idle_now - idle_before) + 10:
            return True
        if idle_now - idle_before > 50:  # a busy machine woke it late: another stretch
            idle_before, awaited_before = idle_now, awaited_now
        return False

    wait_until("it was looked into more often", more_often)
    drain.remove(awaited)
    looks, idle_before = awaited.looks, idle.looks
    wait_until("the other is looked into", lambda: idle.looks > idle_before + 10)
    assert awaited.looks <= looks + 1


def test_one_that_was_stopped_looks_no_more():
    drain, source = Drain(), CountingSource()
    drain.add(source)
    drain.stop()
    drain.stop()
    looks = source.looks
    drain.hurry(source)
    assert source.looks == looks
