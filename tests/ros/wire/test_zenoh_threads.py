"""Zenoh's threads are counted in a process of its own: they are started once and stay."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.wire import running_router

pytestmark = [
    pytest.mark.network,
    pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="threads are read from /proc"),
]

_OPEN_AND_COUNT = """
import pathlib, sys
from studio.ros.profiles import profile_named
from studio.ros.wire.zenoh import live_tokens
from studio.ros.wire.session import open_wire
from studio.ros.wire.settings import WireSettings
with open_wire(WireSettings((sys.argv[1],), profile=profile_named("jazzy")), "off") as wire:
    list(live_tokens(wire.zenoh, "@ros2_lv/**", 60.0))  # a thread that received has its name
    names = [one.read_text() for one in pathlib.Path("/proc/self/task").glob("*/comm")]
print(sum(name.startswith("rx-") for name in names))
"""

_END_WHILE_CLOSING = """
import sys
from studio.ros.wire import zenoh
from studio.ros.wire.session import open_session
from studio.ros.wire.settings import WireSettings
zenoh._CLOSE_TIMEOUT_S = zenoh._END_TIMEOUT_S = 0.0
wire = open_session(WireSettings((sys.argv[1],)))
zenoh.ReadingThread("reader", zenoh.watch_tokens(wire.zenoh, "**"), print).close()
wire.close()
"""


def receiving_threads(chosen: str | None) -> int:
    """How many threads of its own Zenoh has for what comes in, with this choice of a user's."""
    environment = {name: one for name, one in os.environ.items() if name != "ZENOH_RUNTIME"}
    if chosen is not None:
        environment["ZENOH_RUNTIME"] = chosen
    with running_router() as endpoint:
        words = [sys.executable, "-c", _OPEN_AND_COUNT, endpoint]
        done = subprocess.run(words, env=environment, capture_output=True, text=True, check=True)
    return int(done.stdout)


def test_zenoh_has_no_threads_of_its_own_for_what_comes_in():
    assert receiving_threads(None) == 0


def test_who_chose_threads_of_zenoh_is_not_overruled():
    assert receiving_threads("(rx: (worker_threads: 3))") > 0


def test_a_process_that_ends_while_a_session_closes_is_not_aborted():
    with running_router() as endpoint:
        words = [sys.executable, "-c", _END_WHILE_CLOSING, endpoint]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
