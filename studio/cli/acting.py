"""A node of the command's own, hidden as `ros2`'s are, with the graph around it."""

from __future__ import annotations

import os
import time
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from studio.cli.looking import settle
from studio.cli.wire import opened_wire

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Generator

    from studio.ros.graph.graph import Graph
    from studio.ros.node.executors import Executor
    from studio.ros.node.node import Node
    from studio.ros.node.task import Future
    from studio.ros.types.library import TypeLibrary


@dataclass(frozen=True, slots=True)
class Actor:
    """What a verb needs that takes part; the node is the executor's once there is work to do."""

    node: Node
    graph: Graph
    types: TypeLibrary
    executor: Executor

    def work_until(self, is_done: Callable[[], bool], timeout_s: float | None = None) -> bool:
        """Carry out callbacks until something holds; False when the time is over first."""
        self.executor.add_node(self.node)
        end_s = None if timeout_s is None else time.monotonic() + timeout_s
        while not is_done():
            left_s = None if end_s is None else end_s - time.monotonic()
            if left_s is not None and left_s <= 0:
                return False
            self.executor.spin_once(left_s)
        return True

    def wait(self, future: Future[Any], timeout_s: float | None = None) -> bool:
        """Carry out callbacks until a future is done; False when the time is over first."""
        self.executor.add_node(self.node)
        self.executor.spin_until_future_complete(future, timeout_s)
        return future.done()

    def report_every(self, period_s: float, report: Callable[[], None]) -> None:
        """Carry out callbacks for ever, and report in between."""
        next_s = time.monotonic() + period_s
        while True:
            self.work_until(lambda: False, max(0.0, next_s - time.monotonic()))
            report()
            next_s += period_s


@contextmanager
def acting(
    options: argparse.Namespace, name: str | None = None, *, answers: bool = False
) -> Generator[Actor]:
    """Join with a node of one's own, hidden unless it is given a name; take in what stands.

    One that `answers` has parameters and tells others what its types are made of.

    Raises:
        NoRouterError: None answers, and none may be started.
    """
    from studio.ros.node.context import Context
    from studio.ros.node.executors import SingleThreadedExecutor
    from studio.ros.node.node import Node

    with opened_wire(options) as wire:
        context = Context.over(wire)
        try:
            node = Node(
                name or f"_studio_{os.getpid()}",
                context=context,
                start_parameter_services=answers,
            )
            executor = SingleThreadedExecutor(context=context)
            settle(node.graph, options)
            yield Actor(node, node.graph, wire.types, executor)
        finally:
            context.shutdown()
