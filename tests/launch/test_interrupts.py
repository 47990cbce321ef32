from __future__ import annotations

import os
import signal
import threading
from typing import TYPE_CHECKING

from studio.launch.interrupts import Interrupts, ending_signals
from tests.support.wire import wait_until

if TYPE_CHECKING:
    import pytest


def test_a_signal_is_heard_on_a_thread_and_raises_nothing(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("studio.launch.interrupts._HELD_AGAIN_S", 0.05)
    heard: list[int] = []
    given_up = threading.Event()
    interrupts = Interrupts(heard.append, given_up.set)
    try:
        interrupts.begin()
        os.kill(os.getpid(), signal.SIGTERM)
        wait_until("the signal heard", lambda: heard == [signal.SIGTERM])
        wait_until("given up, for nobody took it", given_up.is_set)
        interrupts.taken()
    finally:
        interrupts.close()
    assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL


def test_a_signal_that_is_ignored_as_nohup_has_it_stays_so():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        assert signal.SIGHUP not in ending_signals()
    finally:
        signal.signal(signal.SIGHUP, before)
    assert signal.SIGINT in ending_signals()
