"""Signals: Ctrl-C and SIGTERM end what spins, and the process within two seconds."""

from __future__ import annotations

import os
import signal
import socket
import threading
import weakref
from enum import IntFlag
from typing import TYPE_CHECKING, Any, Final

from studio.errors import ExternalShutdownException

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FrameType

    from studio.ros.node.context import Context

GRACE_S = 1.0
"""So long a process may take to end by itself."""
CLOSING_S = 0.2
"""So long sessions may take to close if it did not."""
_NUDGE_AFTER_S = 0.1
_NUDGE: Final = getattr(signal, "SIGURG", None)
"""Ends a wait of the main thread and does nothing else; ignored by default, so hardly used."""


class SignalHandlerOptions(IntFlag):
    """Signals that end the contexts of a process."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = SIGINT | SIGTERM


_NUMBERS = {
    SignalHandlerOptions.SIGINT: signal.SIGINT,
    SignalHandlerOptions.SIGTERM: signal.SIGTERM,
}


class SignalHandlers:
    """The handlers of this process; contexts that were joined with signals are ended by them.

    Ctrl-C raises KeyboardInterrupt in the main thread as well. A process that is asked to end by
    SIGTERM and does not, or that is stuck in code that lets no handler run, is ended after a
    grace, its sessions closed: such as one that waits for a router, or sleeps.

    A signal that comes in the instant before the main thread begins to wait does not end the wait,
    and its handler is not run: the main thread is nudged a moment later.
    """

    def __init__(self) -> None:
        self._before: dict[int, Any] = {}
        self._contexts: weakref.WeakSet[Context] = weakref.WeakSet()
        self._watch: _Watch | None = None
        self._interrupted = threading.Semaphore(0)

    def install(self, context: Context, options: SignalHandlerOptions) -> None:
        """End a context by signals; nothing in threads beside the main one, as Python wants it."""
        if not options or threading.current_thread() is not threading.main_thread():
            return
        self._contexts.add(context)
        context.on_close(lambda: self.release(context))
        for option, number in _NUMBERS.items():
            if option & options and number not in self._before:
                self._before[number] = signal.signal(number, self._handle)
        if _NUDGE is not None and signal.getsignal(_NUDGE) is signal.SIG_DFL:
            self._before[_NUDGE] = signal.signal(_NUDGE, _do_nothing)
        self._watch = self._watch or _Watch.begin(self._on_signal)

    @property
    def options(self) -> SignalHandlerOptions:
        """The signals that end contexts now."""
        found = SignalHandlerOptions.NO
        for option, number in _NUMBERS.items():
            if number in self._before:
                found |= option
        return found

    def uninstall(self) -> None:
        """Put back what was before; nothing in threads beside the main one."""
        if threading.current_thread() is not threading.main_thread():
            return
        for number, before in self._before.items():
            signal.signal(number, signal.SIG_DFL if before is None else before)
        self._before.clear()
        watch, self._watch = self._watch, None
        if watch is not None:
            watch.end()

    def release(self, context: Context) -> None:
        """Leave a context that ends alone; without any left, what was before comes back."""
        self._contexts.discard(context)
        if not self._contexts:
            self.uninstall()

    def _handle(self, number: int, frame: FrameType | None) -> None:
        for context in tuple(self._contexts):
            context.end()
        if number == signal.SIGINT:
            self._interrupted.release()
            before = self._before.get(number)
            if callable(before):
                before(number, frame)
        elif not any(context.is_joined for context in self._contexts):
            raise ExternalShutdownException  # out of waiting for a router

    def _on_signal(self, number: int) -> None:
        """Wait for the process to end, and end it if it goes on; runs in the watching thread."""
        contexts = tuple(self._contexts)
        if number not in self._before or number == _NUDGE or not contexts:
            return
        if not self._ends(number, contexts, _NUDGE_AFTER_S):
            self._nudge()
            if not self._ends(number, contexts, GRACE_S - _NUDGE_AFTER_S):
                _end_process(contexts, number)

    def _ends(self, number: int, contexts: tuple[Context, ...], timeout_s: float) -> bool:
        """Wait until the process is about to end; whether it is."""
        if number == signal.SIGINT:
            # KeyboardInterrupt is being handled: what catches it may take its time.
            return self._interrupted.acquire(timeout=timeout_s)
        return contexts[0].wait_closed(timeout_s)

    def _nudge(self) -> None:
        """Let the main thread run its handlers, if it waits."""
        main = threading.main_thread().ident
        if _NUDGE in self._before and main is not None:
            signal.pthread_kill(main, _NUDGE)


def _do_nothing(_number: int, _frame: FrameType | None) -> None:
    """Be a handler: without one, the signal would end no wait."""


class _Watch:
    """Learns of signals over a pair of sockets, also while the main thread runs no handler."""

    def __init__(self, on_signal: Callable[[int], None]) -> None:
        self._on_signal = on_signal
        self._reader, self._writer = socket.socketpair()
        self._writer.setblocking(False)  # noqa: FBT003

    @classmethod
    def begin(cls, on_signal: Callable[[int], None]) -> _Watch | None:
        """Begin, unless something else (such as asyncio) handles signals by this means."""
        watch = cls(on_signal)
        before = signal.set_wakeup_fd(watch._writer.fileno(), warn_on_full_buffer=False)
        if before != -1:
            signal.set_wakeup_fd(before)
            watch._writer.close()
            watch._reader.close()
            return None
        threading.Thread(target=watch._run, name="ros signals", daemon=True).start()
        return watch

    def end(self) -> None:
        """Listen no more, and leave alone what another has put in place since."""
        before = signal.set_wakeup_fd(-1)
        if before not in {-1, self._writer.fileno()}:
            signal.set_wakeup_fd(before)
        self._writer.close()

    def _run(self) -> None:
        while numbers := self._reader.recv(64):
            for number in numbers:
                self._on_signal(number)
        self._reader.close()


def _end_process(contexts: tuple[Context, ...], number: int) -> None:
    """Close the sessions, and end without asking the main thread: it does not answer."""
    for context in contexts:
        closing = threading.Thread(target=context.shutdown, daemon=True)
        closing.start()
        closing.join(CLOSING_S)
    os._exit(128 + number)


handlers = SignalHandlers()
