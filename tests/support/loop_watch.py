"""Watches an event loop: which turns take long, where, and who keeps it waiting."""

from __future__ import annotations

import asyncio
import gc
import sys
import threading
import time
import traceback
from collections import Counter
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable, Generator
    from types import FrameType

_LOOK_EVERY_S: Final = 0.02
_FRAMES_SHOWN: Final = 14
_STACKS_KEPT: Final = 4
_TASKS: Final = Path("/proc/self/task")


@dataclass(frozen=True)
class Stall:
    """What kept the loop from its other work, and what was seen of it."""

    took_s: float
    """Of the processor: a busy machine adds nothing to it."""
    what: str
    """The callback, or the thread that held the interpreter."""
    collecting_s: float
    """Of it, the collection of garbage."""
    stacks: tuple[str, ...]
    """Where it was, seen every 20 ms at most, the first ones."""

    def __str__(self) -> str:
        collected = f", {self.collecting_s * 1000:.0f} ms of it collecting garbage"
        said = f"{self.took_s * 1000:.0f} ms: {self.what}{collected if self.collecting_s else ''}"
        return "\n".join((said, *self.stacks))


@contextmanager
def stalls(limit_s: float, notice: Callable[[Stall], None]) -> Generator[None]:
    """Notice, on the loop's own thread, each callback that takes longer than that of it.

    Another thread that keeps the interpreter to itself for so long is noticed too, on the watching
    thread: one call into C that does not let go is enough.
    """
    watch = _Watch(limit_s, notice)
    run = asyncio.Handle._run  # pyright: ignore[reportUnknownMemberType, reportUnknownVariableType, reportAttributeAccessIssue]

    def measured(handle: asyncio.Handle) -> None:
        if threading.get_ident() != watch.loop_thread:
            run(handle)
            return
        watch.begin()
        run(handle)
        watch.end(handle)

    thread = threading.Thread(target=watch.look, name="loop watch", daemon=True)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(asyncio.Handle, "_run", measured)
        gc.callbacks.append(watch.collect)
        thread.start()
        try:
            yield
        finally:
            watch.stopped.set()
            thread.join()
            gc.callbacks.remove(watch.collect)


@contextmanager
def calls_here() -> Generator[Counter[str]]:
    """Count, by qualified name, the functions in Python that this thread calls."""
    calls = Counter[str]()

    def seen(frame: FrameType, event: str, arg: Any) -> None:  # noqa: ANN401 - as Python calls it
        del arg
        if event == "call":
            calls[frame.f_code.co_qualname] += 1

    sys.setprofile(seen)
    try:
        yield calls
    finally:
        sys.setprofile(None)


class _Watch:
    """What one callback after the other takes; all but `look` is called on the loop's thread."""

    def __init__(self, limit_s: float, notice: Callable[[Stall], None]) -> None:
        self._limit_s, self._notice = limit_s, notice
        self.loop_thread, self.stopped = threading.get_ident(), threading.Event()
        self._began_s: float | None = None
        """By the thread's clock."""
        self._began_at: float | None = None
        """By the wall's, for the watching thread."""
        self._collecting_s = self._collection_began_s = 0.0
        self._stacks: list[str] = []

    def begin(self) -> None:
        self._collecting_s, self._stacks = 0.0, []
        self._began_at, self._began_s = time.monotonic(), time.thread_time()

    def end(self, handle: asyncio.Handle) -> None:
        if self._began_s is None:
            return
        took_s, self._began_s, self._began_at = time.thread_time() - self._began_s, None, None
        if took_s > self._limit_s:
            stacks = tuple(dict.fromkeys(self._stacks))[:_STACKS_KEPT]
            self._notice(Stall(took_s, repr(handle), self._collecting_s, stacks))

    def collect(self, phase: str, info: dict[str, Any]) -> None:
        """The collector of garbage begins or ends."""
        del info
        if threading.get_ident() != self.loop_thread:
            return
        if phase == "start":
            self._collection_began_s = time.thread_time()
        else:
            self._collecting_s += time.thread_time() - self._collection_began_s

    def look(self) -> None:
        """Look at what takes long until it is stopped."""
        own = str(threading.get_native_id())
        before, looked_at = _used_s(), time.monotonic()
        while not self.stopped.wait(_LOOK_EVERY_S):
            began_at, now = self._began_at, time.monotonic()
            if began_at is not None and now - began_at > self._limit_s / 2:
                frame = _frames().get(self.loop_thread)
                stack = traceback.extract_stack(frame)[-_FRAMES_SHOWN:]
                self._stacks.append("".join(traceback.format_list(stack)))
            used = _used_s()
            if now - looked_at > self._limit_s:
                self._find_holder(used, before, own)
            before, looked_at = used, time.monotonic()

    def _find_holder(self, used: dict[str, float], before: dict[str, float], own: str) -> None:
        """This thread was not let in: name another that worked all the while."""
        frames = _frames()
        for thread in threading.enumerate():
            name = str(thread.native_id)
            took_s = used.get(name, 0.0) - before.get(name, 0.0)
            if thread.ident in {self.loop_thread, None} or name == own or took_s < self._limit_s:
                continue
            stack = traceback.extract_stack(frames.get(thread.ident or 0))[-_FRAMES_SHOWN:]
            seen = "".join(traceback.format_list(stack))
            self._notice(Stall(took_s, f"held by the thread {thread.name}", 0.0, (seen,)))


def _frames() -> dict[int, FrameType]:
    """Where each thread is, by its identity."""
    return sys._current_frames()  # pyright: ignore[reportPrivateUsage] - there is no other way


def _used_s() -> dict[str, float]:
    """Seconds of the processor that each thread of this process took so far, by its number.

    Nothing where the system does not tell.
    """
    used: dict[str, float] = {}
    for task in _TASKS.iterdir() if _TASKS.is_dir() else ():
        try:
            used[task.name] = int((task / "schedstat").read_text().split()[0]) / 1e9
        except (OSError, ValueError, IndexError):  # it has ended
            continue
    return used
