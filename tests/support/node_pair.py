"""Nodes in sessions of their own at one router, as if in two processes, and what carries them."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from studio.ros.node.context import Context
from studio.ros.node.executors import Executor, SingleThreadedExecutor
from studio.ros.node.node import Node
from tests.support.wire import PATIENCE_S, open_test_session, running_router

if TYPE_CHECKING:
    from collections.abc import Callable, Generator


@contextmanager
def context_at(endpoint: str, distro: str = "jazzy") -> Generator[Context]:
    """A context with a session of its own, shut down at the end of the block."""
    context = Context.over(open_test_session(endpoint, distro=distro), owns_wire=True)
    try:
        yield context
    finally:
        context.shutdown()


@contextmanager
def node_pair(distro: str = "jazzy") -> Generator[tuple[Node, Node]]:
    """A talker and a listener in two sessions at a router of their own."""
    with (
        running_router() as endpoint,
        context_at(endpoint, distro) as one,
        context_at(endpoint, distro) as other,
    ):
        yield Node("talker", context=one), Node("listener", context=other)


def spin_until(condition: Callable[[], bool], *nodes: Node, executor: Executor | None = None):
    """Carry out the work of nodes in this thread until a condition holds, or patience ends."""
    context = nodes[0].context if nodes else None
    chosen = executor or SingleThreadedExecutor(context=context)
    for node in nodes:
        chosen.add_node(node)
    try:
        for _ in range(int(PATIENCE_S / 0.02)):
            if condition():
                return
            chosen.spin_once(timeout_sec=0.02)
    finally:
        for node in nodes:
            chosen.remove_node(node)
    raise AssertionError("what was awaited did not come")
