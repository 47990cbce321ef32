"""Watchdog: counts memory, processes and open files of a process and all that it started.

The system's own limits do not do: that of processes counts those of a user, and none for root.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Final

_PROC: Final = Path("/proc")
_PAGE_BYTES: Final = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096
MARK: Final = "STUDIO_LAUNCH_MARK"
_KILL_ROUNDS: Final = 200
_FILES_EVERY: Final = 5
"""Open files are counted once in so many looks: it takes long."""


def group_memory_bytes(most_bytes: int) -> int:
    """Return so much memory, or three quarters of this machine's where that is less."""
    try:
        machine_bytes = os.sysconf("SC_PHYS_PAGES") * _PAGE_BYTES
    except (ValueError, OSError, AttributeError):
        return most_bytes
    return min(most_bytes, machine_bytes * 3 // 4) if machine_bytes > 0 else most_bytes


@dataclass(frozen=True, slots=True)
class Limits:
    """What a group may have."""

    memory_bytes: int
    processes: int
    files: int


GROUP_LIMITS: Final = Limits(group_memory_bytes(12 << 30), processes=500, files=20_000)
"""What all that a launch starts may have together, and a node that the page starts."""
WATCH_EVERY_S: Final = 0.5


@dataclass(frozen=True, slots=True)
class _Row:
    pid: int
    parent: int
    session: int
    resident_bytes: int
    is_alive: bool
    """Not so while it ends: it may have children yet."""


class Watchdog:
    """Watches what descends from a process, or belongs to its session.

    Args:
        leader: The process; it should lead a session of its own, and take up orphans
            (`take_up_orphans`), so that nothing leaves its tree.
        limits: What the group may have.
        with_leader: Whether the leader is killed with the others; it counts in any case.
        mark: `NAME=value` of the environment that all of the group have, by which `kill` finds
            those whose leader has gone.
    """

    def __init__(
        self, leader: int, limits: Limits, *, with_leader: bool = True, mark: str = ""
    ) -> None:
        self._mark = mark.encode()
        self._leader, self._limits, self._with_leader = leader, limits, with_leader
        self._looks = 0

    def exceeded(self) -> str:
        """Return what is over its limit, as half a sentence; empty: nothing is."""
        rows = self._members(counts_leader=True)
        self._looks += 1
        if len(rows) > self._limits.processes:
            return f"it has more than {self._limits.processes} processes"
        if sum(one.resident_bytes for one in rows) > self._limits.memory_bytes:
            return f"it takes more than {self._limits.memory_bytes >> 20} MB of memory"
        if self._looks % _FILES_EVERY == 0 and self._files(rows) > self._limits.files:
            return f"it has more than {self._limits.files} files open"
        return ""

    def kill(self) -> None:
        """Kill all of the group, also what it starts meanwhile."""
        for _ in range(_KILL_ROUNDS):
            rows = self._members() or self._marked()
            if not rows:
                return
            for number in (signal.SIGSTOP, signal.SIGKILL):
                for one in rows:
                    with contextlib.suppress(ProcessLookupError, PermissionError):
                        os.kill(one.pid, number)
            time.sleep(0.01)

    def _members(self, *, counts_leader: bool = False) -> list[_Row]:
        rows = _all_rows()
        inside = {self._leader}
        grown = True
        while grown:
            before = len(inside)
            inside |= {one.pid for one in rows if one.parent in inside}
            grown = len(inside) > before
        found = [
            one
            for one in rows
            if one.is_alive
            and (one.pid in inside or (self._with_leader and one.session == self._leader))
        ]
        leads = self._with_leader or counts_leader
        return [one for one in found if leads or one.pid != self._leader]

    def _marked(self) -> list[_Row]:
        return _marked_rows(self._mark) if self._mark else []

    @staticmethod
    def _files(rows: list[_Row]) -> int:
        count = 0
        for one in rows:
            with contextlib.suppress(OSError):
                count += len(os.listdir(_PROC / str(one.pid) / "fd"))  # noqa: PTH208
        return count


def _all_rows() -> list[_Row]:
    """Return all processes; none where the system does not tell."""
    if sys.platform != "linux":
        return []
    rows: list[_Row] = []
    for name in os.listdir(_PROC):  # noqa: PTH208 - names alone
        if not name.isdigit():
            continue
        with contextlib.suppress(OSError, ValueError, IndexError):
            text = (_PROC / name / "stat").read_text(errors="replace")
            fields = text[text.rindex(")") + 2 :].split()
            parent, session, pages = int(fields[1]), int(fields[3]), int(fields[21])
            is_alive = fields[0] not in "ZX"
            rows.append(_Row(int(name), parent, session, pages * _PAGE_BYTES, is_alive))
    return rows


def _marked_rows(mark: bytes) -> list[_Row]:
    found: list[_Row] = []
    for one in _all_rows():
        with contextlib.suppress(OSError):
            if one.is_alive and mark in (_PROC / str(one.pid) / "environ").read_bytes():
                found.append(one)
    return found


def marked_processes(mark: str) -> list[int]:
    """Return who began with `NAME=value` in its environment, this process left out."""
    return [one.pid for one in _marked_rows(mark.encode()) if one.pid != os.getpid()]


def take_up_orphans(*, does: bool = True) -> bool:
    """Have what this process's children leave behind become its own children, or no more (Linux).

    Returns:
        Whether it is so.
    """
    if sys.platform != "linux":
        return False
    import ctypes  # noqa: PLC0415 - only here

    try:
        return ctypes.CDLL(None).prctl(36, int(does), 0, 0, 0) == 0  # PR_SET_CHILD_SUBREAPER
    except (OSError, AttributeError):
        return False
