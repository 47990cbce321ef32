"""A command on a leash ends with whoever holds it."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from studio.live.programs import leash
from studio.system import is_running
from tests.support.wire import wait_until

_STUBBORN = """import os, signal, sys, time
signal.signal(signal.SIGINT, signal.SIG_IGN)
signal.signal(signal.SIGTERM, signal.SIG_IGN)
print(os.getpid(), flush=True)
time.sleep(1000)
"""
_WITH_CHILD = """import subprocess, sys, time
child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(1000)"])
print(child.pid, flush=True)
time.sleep(1000)
"""
_INTERRUPTED = """import time
try:
    print(1, flush=True)
    time.sleep(1000)
except KeyboardInterrupt:
    raise SystemExit(7)
"""


def leashed(*command: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-I", "-S", str(Path(leash.__file__)), *command],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )


def let_go(held: subprocess.Popen[str]) -> int:
    assert held.stdin is not None
    held.stdin.close()
    code = held.wait(60)
    assert held.stdout is not None
    held.stdout.close()
    return code


def first_line(held: subprocess.Popen[str]) -> int:
    assert held.stdout is not None
    return int(held.stdout.readline())


@pytest.mark.parametrize("code", [0, 3])
def test_it_ends_as_its_command_does(code: int):
    held = leashed(sys.executable, "-c", f"raise SystemExit({code})")
    assert held.wait(60) == code
    assert let_go(held) == code


def test_a_command_that_a_signal_ended_ends_it_by_the_same():
    held = leashed(sys.executable, "-c", "import os; os.kill(os.getpid(), 9)")
    assert held.wait(60) == -signal.SIGKILL
    let_go(held)


def test_what_does_not_listen_is_killed_once_it_is_let_go():
    held = leashed(sys.executable, "-c", _STUBBORN)
    child = first_line(held)
    began_s = time.monotonic()
    assert let_go(held) == -signal.SIGKILL
    assert not is_running(child)
    assert time.monotonic() - began_s < 30


def test_what_the_command_started_ends_with_it():
    held = leashed(sys.executable, "-c", _WITH_CHILD)
    child = first_line(held)
    let_go(held)
    wait_until("the child to end", lambda: not is_running(child))


def test_a_byte_is_ctrl_c():
    held = leashed(sys.executable, "-c", _INTERRUPTED)
    first_line(held)
    assert held.stdin is not None
    held.stdin.write("c")
    held.stdin.flush()
    assert held.wait(60) == 7
    let_go(held)


def test_a_command_that_is_not_there_is_said():
    held = leashed("/no/such/command")
    assert held.wait(60) == 127
    let_go(held)
