"""Leash: runs a command in a group of its own for as long as its input stays open.

Run by its path and with nothing of the studio imported, so that it takes a hundredth of a second.
Each byte that comes is Ctrl-C for the whole group; the end of the input ends the group in any
case. It ends as the command did, by the same code or signal.
"""

from __future__ import annotations

import contextlib
import os
import select
import signal
import sys
import time

_AFTER_SIGINT_S = 2.0
_AFTER_SIGTERM_S = 1.0
_INPUT = 0


def main(command: list[str]) -> None:
    """Run it; does not return."""
    waking, wakes = os.pipe()
    os.set_blocking(wakes, False)
    signal.set_wakeup_fd(wakes)
    # What ends it is the end of its input, or of the command.
    for one in (signal.SIGCHLD, signal.SIGINT, signal.SIGTERM):
        signal.signal(one, _wake)
    child = os.fork()
    if child == 0:
        _become(command)
    with contextlib.suppress(OSError):
        os.setpgid(child, child)
    _hold(child, waking)


def _wake(_number: int, _frame: object) -> None:
    """Let a byte be written to the pipe that is waited for."""


def _become(command: list[str]) -> None:
    """Be the command, in a group of its own."""
    os.setpgid(0, 0)
    for one in (signal.SIGINT, signal.SIGTERM, signal.SIGCHLD):
        signal.signal(one, signal.SIG_DFL)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, _INPUT)
    try:
        os.execvp(command[0], command)
    except OSError as error:
        os.write(2, f"{command[0]} cannot be run: {error.strerror}\n".encode())
        os._exit(127)


def _hold(child: int, waking: int) -> None:
    """Pass Ctrl-C on and wait for the end of the child or of the input."""
    signals = [signal.SIGINT, signal.SIGTERM, signal.SIGKILL]
    patience_s = [_AFTER_SIGINT_S, _AFTER_SIGTERM_S, _AFTER_SIGTERM_S]
    watched = [_INPUT, waking]
    next_at_s: float | None = None
    while True:
        left_s = None if next_at_s is None else max(0.0, next_at_s - time.monotonic())
        ready, _, _ = select.select(watched, [], [], left_s)
        if waking in ready:
            os.read(waking, 64)
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            _leave(child, status)
        if _INPUT in ready and os.read(_INPUT, 64):
            _signal(child, signal.SIGINT)
        elif _INPUT in ready:
            watched.remove(_INPUT)
            next_at_s = 0.0
        if next_at_s is not None and time.monotonic() >= next_at_s and signals:
            _signal(child, signals.pop(0))
            next_at_s = time.monotonic() + patience_s.pop(0)


def _leave(child: int, status: int) -> None:
    """End the rest of the group, and end as the command did."""
    _signal(child, signal.SIGKILL)
    if os.WIFEXITED(status):
        os._exit(os.WEXITSTATUS(status))
    with_signal = os.WTERMSIG(status)
    if with_signal != signal.SIGKILL:
        signal.signal(with_signal, signal.SIG_DFL)
    os.kill(os.getpid(), with_signal)
    os._exit(128 + with_signal)


def _signal(group: int, number: int) -> None:
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(group, number)


if __name__ == "__main__":
    main(sys.argv[1:])
