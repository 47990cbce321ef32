"""Demo nodes in processes of their own, and a node of the test that speaks with them."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

from studio.course.demos import find_demo
from studio.errors import DestroyedError
from studio.ros.client import Context, ExternalShutdownException, Node, SingleThreadedExecutor
from studio.ros.messages import message, service, shared_types
from studio.ros.wire.settings import WireSettings, environment_for
from tests.support.patience import ended_within
from tests.support.warm_python import NODE, start_python
from tests.support.wire import PATIENCE_S, open_test_session, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.client import QoSProfile
    from studio.ros.types.library import TypeLibrary

ENDS_WITHIN_S = 2.0


class RunningDemo:
    """A process, and what it has printed so far; its log is on stderr, both are read as one."""

    def __init__(
        self,
        words: list[str],
        environment: dict[str, str],
        keyboard: int = subprocess.DEVNULL,
        *,
        warm: bool = True,
        imported: tuple[str, ...] = NODE,
    ) -> None:
        self.process = start_python(
            words, environment, stdin=keyboard, imported=imported if warm else ()
        )
        self.lines: list[str] = []
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    @property
    def printed(self) -> str:
        return "".join(self.lines)

    def wait_for(self, text: str) -> None:
        """Wait until it has printed a text; its end is no reason to wait longer."""
        wait_until(f"{text!r} printed", lambda: text in self.printed or not self._reader.is_alive())
        assert text in self.printed, self.printed

    def wait_for_more(self, text: str, count: int) -> None:
        """Wait until it has printed a text once more than so many times."""
        wait_until(f"{text!r} again", lambda: self.printed.count(text) > count)

    def wait(self, within_s: float = PATIENCE_S) -> int:
        """Wait for its end; what a busy machine keeps it waiting is not counted."""
        code = ended_within(self.process, within_s)
        self._reader.join()
        return code

    def stop(self, number: int = signal.SIGINT) -> int:
        """Send a signal to its whole group, as a terminal does; it has two seconds to end."""
        self._signal(number)
        return self.wait(ENDS_WITHIN_S)

    def close(self) -> None:
        self._signal(signal.SIGKILL)
        self.wait()

    def _signal(self, number: int) -> None:
        if self.process.poll() is None:
            with suppress(ProcessLookupError):  # it has ended since
                os.killpg(self.process.pid, number)

    def _read(self) -> None:
        assert self.process.stdout is not None
        with self.process.stdout as printed:
            self.lines.extend(iter(printed.readline, ""))


@contextmanager
def running_demo(
    endpoint: str, name: str, *arguments: str, warm: bool = True
) -> Generator[RunningDemo]:
    """A demo by its name, or by that of an executable, at a router."""
    demo = find_demo(name)
    assert demo is not None
    words = [sys.executable, "-m", demo.module, *arguments]
    with running(words, endpoint, warm=warm) as started:
        yield started


@contextmanager
def running(
    words: list[str],
    endpoint: str,
    keyboard: int = subprocess.DEVNULL,
    *,
    warm: bool = True,
) -> Generator[RunningDemo]:
    """Any process that finds the router by its environment; not warm, it imports all it needs."""
    environment = environment_for(WireSettings(connect=(endpoint,)))
    started = RunningDemo(words, environment, keyboard, warm=warm)
    try:
        yield started
    finally:
        started.close()


@contextmanager
def node_at(
    endpoint: str, name: str = "tester", types: TypeLibrary | None = None
) -> Generator[Node]:
    """A node in this process, spun by a thread of its own; its types are those that all share."""
    with open_test_session(endpoint, types=types or shared_types()) as wire:
        context = Context.over(wire)
        node = Node(name, context=context)
        with spun(context, node):
            yield node


@contextmanager
def spun(context: Context, node: Node) -> Generator[None]:
    """Carry out a node's work in a thread of its own; at the end its context is shut down."""
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    spinning = threading.Thread(target=_spin, args=(executor,))
    spinning.start()
    try:
        yield
    finally:
        context.shutdown()
        spinning.join()


def heard(node: Node, type_name: str, topic: str, qos: QoSProfile | int = 100) -> list[Any]:
    """What comes on a topic, for as long as the node lives."""
    messages: list[Any] = []
    node.create_subscription(message(type_name), topic, messages.append, qos)
    return messages


def call(node: Node, type_name: str, called: str, /, **fields: Any) -> Any:  # noqa: ANN401
    """Ask a service once it is there; gives its answer."""
    kind = service(type_name)
    client = node.create_client(kind, called)
    assert client.wait_for_service(PATIENCE_S), f"nobody serves {called}"
    try:
        return client.call(kind.Request(**fields), timeout_sec=PATIENCE_S)
    finally:
        node.destroy_client(client)


def _spin(executor: SingleThreadedExecutor) -> None:
    # A timer may be about to publish at the moment in which its node ends.
    with suppress(ExternalShutdownException, DestroyedError):
        executor.spin()
