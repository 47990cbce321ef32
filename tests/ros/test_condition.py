"""A wait that Ctrl-C interrupts at any moment leaves the lock as its `with` expects it."""

from __future__ import annotations

import signal
import threading

import pytest

from studio.ros.condition import Condition


def is_free(condition: Condition) -> bool:
    """Whether another thread can have the lock."""
    had: list[bool] = []
    other = threading.Thread(target=lambda: had.append(condition.acquire(blocking=False)))
    other.start()
    other.join()
    return had == [True]


@pytest.mark.parametrize("moment", ["_release_save", "_acquire_restore"])
def test_an_interruption_behind_the_lock_s_back_is_what_is_raised(
    monkeypatch: pytest.MonkeyPatch, moment: str
):
    condition = Condition()
    give_back = getattr(condition, "_release_save")  # noqa: B009 - Python's own, behind its back

    def interrupted(*_: object) -> None:
        if moment == "_release_save":
            give_back()
        raise KeyboardInterrupt

    monkeypatch.setattr(condition, moment, interrupted)
    with pytest.raises(KeyboardInterrupt), condition:
        condition.wait(0.001)
    assert is_free(condition)


def test_real_signals_interrupt_real_waits():
    def interrupt(_number: int, _frame: object) -> None:
        raise KeyboardInterrupt

    # Taken and left by itself, as executors do it: a condition's own `with` is Python code, too.
    lock = threading.RLock()
    condition = Condition(lock)
    before = signal.signal(signal.SIGALRM, interrupt)
    interrupted = 0
    try:
        for number in range(2_000):
            try:
                signal.setitimer(signal.ITIMER_REAL, 2e-6 * (1 + number % 40))
                with lock:
                    condition.wait(0.001)
            except KeyboardInterrupt:
                interrupted += 1
            finally:
                signal.setitimer(signal.ITIMER_REAL, 0)
    finally:
        signal.signal(signal.SIGALRM, before)
    assert interrupted
    assert is_free(condition)
