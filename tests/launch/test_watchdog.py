from __future__ import annotations

import os
import subprocess

from studio.launch.watchdog import Limits, Watchdog, group_memory_bytes
from tests.support.patience import ended_within
from tests.support.wire import PATIENCE_S, wait_until

_PLENTY = Limits(memory_bytes=1 << 40, processes=1_000, files=100_000)


def test_processes_memory_and_files_of_a_whole_tree_are_counted_and_killed():
    process = subprocess.Popen(["sh", "-c", "sleep 100 & sleep 100 & wait"], start_new_session=True)
    few = Watchdog(process.pid, Limits(1 << 40, 2, 100_000))
    wait_until("three processes", lambda: "more than 2 processes" in few.exceeded())
    small = Watchdog(process.pid, Limits(1, 1_000, 100_000))
    assert "of memory" in small.exceeded()
    closed = Watchdog(process.pid, Limits(1 << 40, 1_000, 1))
    assert any("files open" in closed.exceeded() for _ in range(5))
    enough = Watchdog(process.pid, _PLENTY)
    assert all(not enough.exceeded() for _ in range(5))
    enough.kill()
    assert ended_within(process, PATIENCE_S) == -9


def test_a_group_may_have_three_quarters_of_the_machines_memory_at_most():
    machine_bytes = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    assert group_memory_bytes(1 << 60) == machine_bytes * 3 // 4
    assert group_memory_bytes(1 << 20) == 1 << 20
