"""A node of the command's own, hidden as `ros2`'s are, and what it asks of other nodes."""

from __future__ import annotations

import os
import sys
import time
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from studio.cli.graph import full_name, settle
from studio.cli.wire import opened_wire
from studio.ros.names import is_hidden

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Generator, Iterable, Sequence

    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.graph.graph import Graph
    from studio.ros.node.executors import Executor
    from studio.ros.node.node import Node
    from studio.ros.node.task import Future
    from studio.ros.types.library import TypeLibrary

LOG_LEVELS: Final = ("debug", "info", "warn", "error", "fatal")
"""What `--log-level` takes; see `set_log_level`."""


@dataclass(frozen=True, slots=True)
class OwnNode:
    """A node for a verb that takes part; the executor spins it once there is work to do."""

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
def own_node(
    options: argparse.Namespace,
    name: str | None = None,
    *,
    answers: bool = False,
    arguments: Sequence[str] = (),
) -> Generator[OwnNode]:
    """Join with a node of one's own, hidden unless it is given a name; wait for the graph.

    One that `answers` serves its parameters and describes its types to others. ROS arguments are
    those that follow `--ros-args`.

    Raises:
        NoRouterError: None answers, and none may be started.
        RosArgumentError: An argument is none of ROS.
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
                cli_args=("--ros-args", *arguments) if arguments else None,
                start_parameter_services=answers,
            )
            executor = SingleThreadedExecutor(context=context)
            settle(node.graph, options)
            yield OwnNode(node, node.graph, wire.types, executor)
        finally:
            context.shutdown()


def set_log_level(own: OwnNode, options: argparse.Namespace) -> None:
    """Let the node say what `--log-level` wants."""
    from studio.ros.node.logger import LoggingSeverity

    own.node.get_logger().set_level(LoggingSeverity[options.log_level.upper()])


def learn_type(own: OwnNode, endpoints: Iterable[GraphEndpoint]) -> None:
    """Ask the nodes of endpoints in turn until one describes its type.

    Failures are printed on stderr; the caller checks whether the type is known then.
    """
    from studio.ros.type_lookup import learn_from_any

    learn_from_any(own.node, endpoints, print_error)


def print_error(sentence: str) -> None:
    """Print a sentence on stderr."""
    print(sentence, file=sys.stderr)


def warn_of_foreign_types(own: OwnNode, endpoints: Sequence[GraphEndpoint]) -> None:
    """Warn on stderr that others have another form of a type, so that nothing of theirs arrives."""
    from studio.ros.graph.diagnosis import DistroHashes, foreign_hashes, why_not_received

    wire = own.node.wire
    for found in foreign_hashes(endpoints, wire.profile, DistroHashes(wire.types)):
        print(f"WARNING: {why_not_received(found, wire.profile)}", file=sys.stderr)


_LATE_S = 0.5
_ASKED = ("rcl_interfaces/srv/", "lifecycle_msgs/srv/")
"""Types of the services that are asked here."""


def named_node(own: OwnNode, options: argparse.Namespace) -> str | None:
    """Return the full name of the node; None, after a message on stderr, if it is not there."""
    path = full_name(options.node_name)
    # On a busy machine its token may come late, and the user named this node.
    own.graph.wait_for(lambda: own.graph.node(path) is not None, _LATE_S)
    node = own.graph.node(path)
    if node is None:
        print("Node not found", file=sys.stderr)
        return None
    ends = own.graph.endpoints_of(node)
    warn_of_foreign_types(own, [end for end in ends if end.type_name.startswith(_ASKED)])
    return path


def nodes_serving(own: OwnNode, service: str, type_name: str, *, hidden: bool) -> list[str]:
    """Name the nodes that serve `<node>/service` of a type, in order."""
    found = [
        name
        for name, types in own.graph.services()
        if name.endswith(f"/{service}") and type_name in types
        if hidden or not is_hidden(name)
    ]
    warn_of_foreign_types(own, [server for name in found for server in own.graph.servers(name)])
    return [name.removesuffix(f"/{service}") for name in found]
