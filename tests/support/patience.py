"""Time limits of which a busy machine takes nothing: what it kept processes waiting is left out.

A limit is strict where the machine is at rest. Where others have its processors, no process can
keep it, whatever it does; Linux counts for how long each thread was ready to run and did not.
"""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Iterator

KEPT_WAITING_MOST_S = 20.0
"""So much more a test waits at most, for the sum over all threads may grow without end."""
_POLL_S = 0.01


class Stopwatch:
    """The seconds since it was made that this process and all that it started had to themselves."""

    def __init__(self) -> None:
        self._began_s = time.monotonic()
        self._before = self._newest = _waits_ns()

    @property
    def s(self) -> float:
        """Seconds; of a process that has ended, the waiting counts as it was read last."""
        self._newest = self._newest | _waits_ns()
        grown = (now - self._before.get(task, 0) for task, now in self._newest.items())
        kept_s = min(sum(grown) / 1e9, KEPT_WAITING_MOST_S)
        return max(0.0, time.monotonic() - self._began_s - kept_s)


class Process(Protocol):
    """What this needs of a Popen."""

    def poll(self) -> int | None: ...


def ended_within(process: Process, within_s: float, watch: Stopwatch | None = None) -> int:
    """Wait for the end of a process, which has so long by a stopwatch; its code."""
    chosen = watch or Stopwatch()
    while (code := process.poll()) is None:
        taken_s = chosen.s
        assert taken_s < within_s, f"it still runs after {taken_s:.1f} s"
        time.sleep(_POLL_S)
    return code


def _waits_ns() -> dict[str, int]:
    """How long each thread of this process and of its descendants was kept waiting (Linux)."""
    return {
        str(task): counted
        for pid in (os.getpid(), *_descendants(os.getpid()))
        for task in _listed(Path(f"/proc/{pid}/task"))
        if (counted := _waited_ns(task)) is not None
    }


def _descendants(pid: int) -> Iterator[int]:
    for task in _listed(Path(f"/proc/{pid}/task")):
        try:
            children = (task / "children").read_text().split()
        except OSError:
            continue
        for child in children:
            yield int(child)
            yield from _descendants(int(child))


def _listed(folder: Path) -> list[Path]:
    try:
        return list(folder.iterdir())
    except OSError:  # it has ended, or this is no Linux
        return []


def _waited_ns(task: Path) -> int | None:
    try:
        return int((task / "schedstat").read_text().split()[1])
    except (OSError, ValueError, IndexError):
        return None
