"""Work, which an executor carries out piece by piece, and the callback groups that part it."""

from __future__ import annotations

import threading
from collections import deque
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable

_AGAIN_S = 0.01


class CallbackGroup:
    """Decides which pieces of work may run beside each other.

    A user's own group overrides `can_execute`, `beginning_execution` and `ending_execution`, as
    with rclpy: what may not run yet is asked for again a moment later. Those below know when.
    """

    def __init__(self) -> None:
        self._begun: deque[Work] = deque()

    def can_execute(self, entity: Work) -> bool:
        """Whether a piece of work may run now."""
        del entity
        return True

    def beginning_execution(self, entity: Work) -> bool:
        """Note that a piece of work is about to run; whether it may."""
        del entity
        return True

    def ending_execution(self, entity: Work) -> None:
        """Note that a piece of work has run."""

    def begin(self, work: Work) -> bool:
        """Whether a piece of work may run now; if so, `end` follows, else it waits here."""
        if self.can_execute(work) and self.beginning_execution(work):
            self._begun.append(work)
            return True
        again = threading.Timer(_AGAIN_S, work.announce)
        again.daemon = True
        again.start()
        return False

    def end(self) -> Work | None:
        """Note that a piece has run, and return the work that may be tried next."""
        if self._begun:
            self.ending_execution(self._begun.popleft())
        return None

    def forget(self, work: Work) -> None:
        """Remove waiting work."""


class ReentrantCallbackGroup(CallbackGroup):
    """Lets all work run concurrently."""

    def begin(self, work: Work) -> bool:
        """Let it run."""
        del work
        return True


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """Lets one run at a time."""

    def __init__(self) -> None:
        super().__init__()
        self._lock = threading.Lock()
        self._running = threading.Lock()
        self._waiting: deque[Work] = deque()

    def begin(self, work: Work) -> bool:
        """Let it run when no other does."""
        return self._running.acquire(blocking=False) or self._begin_or_wait(work)

    def end(self) -> Work | None:
        """Let the next one run."""
        self._running.release()
        if not self._waiting:
            return None
        with self._lock:
            return self._waiting.popleft() if self._waiting else None

    def forget(self, work: Work) -> None:
        """Remove waiting work."""
        with self._lock:
            if work in self._waiting:
                self._waiting.remove(work)

    def _begin_or_wait(self, work: Work) -> bool:
        with self._lock:
            # It waits before it tries again: work that ends meanwhile finds it, or leaves it room.
            if work not in self._waiting:
                self._waiting.append(work)
            if not self._running.acquire(blocking=False):
                return False
            self._waiting.remove(work)
            return True


class Home(Protocol):
    """What work reports to: a node, or an executor."""

    def announce(self, work: Work) -> None:
        """Note that a piece of work is ready; thread-safe."""
        ...


class Work:
    """Something that is ready now and then, and is carried out in pieces.

    A kind of its own (such as an action's server) calls `announce()` when it is ready, and
    returns its pieces from `take`. `Node.add_work` makes it part of a node.

    Attributes:
        group: Which pieces may run beside its own.
        home: The node that it is part of.
    """

    def __init__(self, group: CallbackGroup) -> None:
        self.group = group
        self.home: Home | None = None

    @property
    def is_ready(self) -> bool:
        """Whether a piece waits."""
        raise NotImplementedError

    def take(self) -> Callable[[], object] | None:
        """Take the next piece, None when there is none; what it returns may be a coroutine."""
        raise NotImplementedError

    @property
    def is_timed(self) -> bool:
        """Whether it becomes ready by itself, as timers do."""
        return False

    @property
    def due_s(self) -> float | None:
        """When it will be ready by itself, on the monotonic clock; None for announced work."""
        return None

    def announce(self) -> None:
        """Announce that it is ready."""
        home = self.home
        if home is not None:
            home.announce(self)

    def destroy(self) -> None:
        """Take back what was declared; again is harmless."""


class GuardCondition(Work):
    """Calls back once after it was triggered, however often that was."""

    def __init__(self, callback: Callable[[], object], group: CallbackGroup) -> None:
        super().__init__(group)
        self.callback = callback
        self._triggered = False

    @property
    def is_ready(self) -> bool:
        """Whether it was triggered."""
        return self._triggered

    def trigger(self) -> None:
        """Trigger it; thread-safe."""
        self._triggered = True
        self.announce()

    def take(self) -> Callable[[], object] | None:
        """Return the callback, once for all triggers."""
        triggered, self._triggered = self._triggered, False
        return self.callback if triggered else None
