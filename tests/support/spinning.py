"""Nodes that are carried out beside a test, in a thread of their own."""

from __future__ import annotations

import contextlib
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING

from studio.errors import ExternalShutdownException
from studio.ros.node.context import Context
from studio.ros.node.executor import SingleThreadedExecutor
from studio.ros.node.node import Node
from tests.support.wire import open_test_session

if TYPE_CHECKING:
    from collections.abc import Generator


@contextmanager
def spinning(endpoint: str, *names: str, domain: int = 0) -> Generator[list[Node]]:
    """Nodes in one session at a router, spun until the end of the block."""
    with open_test_session(endpoint, domain) as wire:
        context = Context.over(wire)
        executor = SingleThreadedExecutor(context=context)
        nodes = [Node(name, context=context) for name in names]
        for node in nodes:
            executor.add_node(node)
        thread = threading.Thread(target=_spin, args=(executor,), daemon=True)
        thread.start()
        try:
            yield nodes
        finally:
            context.shutdown()
            thread.join()


def _spin(executor: SingleThreadedExecutor) -> None:
    with contextlib.suppress(ExternalShutdownException):
        executor.spin()
