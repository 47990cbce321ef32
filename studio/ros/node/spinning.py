"""The functions of rclpy: init, shutdown, spin, and waiting for the answer of a service."""

from __future__ import annotations

import atexit
import os
import sys
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Self

from studio.errors import ExternalShutdownException, NoAnswerError, NotServedError, RclError
from studio.ros import strictness
from studio.ros.node.arguments import parse_arguments
from studio.ros.node.context import Context, default_context
from studio.ros.node.executors import Executor, SingleThreadedExecutor
from studio.ros.node.logger import get_logger
from studio.ros.node.node import Node
from studio.ros.node.signals import SignalHandlerOptions, handlers
from studio.ros.wire.settings import wire_settings

if TYPE_CHECKING:
    from collections.abc import Generator, Sequence

    from studio.ros.node.service_client import Client
    from studio.ros.node.task import Future
    from studio.ros.types.classes import MessageValue
    from studio.ros.wire.settings import WireSettings

_lock = threading.Lock()
_executors: dict[Context, Executor] = {}
ANSWER_TIMEOUT_S = 5.0
ROUTER_VARIABLE = "STUDIO_ROUTER"
"""Whether to start a router, for programs that say nothing of it: `auto`, `off`, an endpoint."""


class InitContextManager:
    """Returned by `init`: `with init():` shuts down at its end."""

    def __init__(self, context: Context) -> None:
        self.context = context

    def __enter__(self) -> Self:
        strictness.would_fail(
            "with rclpy.init() needs an rclpy that is newer than Jazzy's",
            "call rclpy.init() before and rclpy.shutdown() after",
        )
        return self

    def __exit__(self, *_: object) -> None:
        self.context.shutdown()


def init(
    args: Sequence[str] | None = None,
    *,
    context: Context | None = None,
    domain_id: int | None = None,
    signal_handler_options: SignalHandlerOptions | None = None,
    settings: WireSettings | None = None,
    router: str = "auto",
) -> InitContextManager:
    """Open the default context; nodes are made after.

    Args:
        args: Arguments of the command line, by default those of the process; names, remappings and
            parameters after `--ros-args` are read.
        context: The context to open; by default the default context.
        domain_id: The domain; by default that of the environment.
        signal_handler_options: Which signals end the context; by default all end the default
            context, and none ends another.
        settings: Which router and domain; by default those of the environment.
        router: `auto` does as STUDIO_ROUTER says, and without it starts a router where none
            answers; `off` starts none.

    Raises:
        AlreadyJoinedError: It is open.
        RosArgumentError: One after `--ros-args` is no argument of ROS.
        WireError: The router cannot be reached.
    """
    joined = context or default_context()
    options = signal_handler_options
    if options is None:
        options = SignalHandlerOptions.ALL if context is None else SignalHandlerOptions.NO
    given = settings or wire_settings(domain=domain_id)
    joined.arguments = parse_arguments(sys.argv[1:] if args is None else args)
    for name, level in joined.arguments.levels:
        get_logger(name).set_level(level)
    handlers.install(joined, options)
    atexit.register(joined.shutdown)
    joined.init(given, os.environ.get(ROUTER_VARIABLE, router) if router == "auto" else router)
    return InitContextManager(joined)


def ok(*, context: Context | None = None) -> bool:
    """Whether the wire is joined and the process was not asked to end."""
    return (context or default_context()).ok()


def shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """Destroy all nodes and leave the wire; again is harmless.

    Raises:
        RclError: In a user's program, where a signal ended the context before: as rclpy does.
        RuntimeError: In a user's program, where it is not joined: as rclpy does.
    """
    ended = context or default_context()
    del uninstall_handlers
    is_told = strictness.is_begun()
    if is_told and not ended.is_joined:
        raise RuntimeError("Context must be initialized before it can be shutdown")
    was_ended = not ended.ok()
    try_shutdown(context=ended)
    if is_told and was_ended:
        raise RclError(
            "failed to shutdown: rcl_shutdown already called on the given context: Ctrl-C or "
            "SIGTERM did it, so call rclpy.try_shutdown() here"
        )


def try_shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """Destroy all nodes and leave the wire; again is harmless."""
    del uninstall_handlers
    ended = context or default_context()
    with _lock:
        executor = _executors.pop(ended, None)
    if executor is not None:
        executor.shutdown()
    ended.shutdown()


def get_global_executor(context: Context | None = None) -> Executor:
    """Return the executor of spin functions that are given none."""
    wanted = context or default_context()
    with _lock:
        found = _executors.get(wanted)
        if found is None or found.is_shut_down:
            found = _executors[wanted] = SingleThreadedExecutor(context=wanted)
        return found


def create_node(node_name: str, **options: Any) -> Node:  # noqa: ANN401
    """Make a node; the options are those of `Node`."""
    return Node(node_name, **options)


def spin(node: Node, executor: Executor | None = None) -> None:
    """Carry out a node's work until the process is asked to end.

    Raises:
        ExternalShutdownException: The process was asked to end.
    """
    with _spun_by(node, executor) as chosen:
        chosen.spin()


def spin_once(
    node: Node, *, executor: Executor | None = None, timeout_sec: float | None = None
) -> None:
    """Carry out one piece of a node's work, or none when none is ready in time.

    Raises:
        ExternalShutdownException: The process was asked to end.
    """
    with _spun_by(node, executor) as chosen:
        chosen.spin_once(timeout_sec)


def spin_until_future_complete(
    node: Node,
    future: Future[Any],
    executor: Executor | None = None,
    timeout_sec: float | None = None,
) -> None:
    """Carry out a node's work until a future is done, or that long.

    Raises:
        ExternalShutdownException: The process was asked to end.
    """
    with _spun_by(node, executor) as chosen:
        chosen.spin_until_future_complete(future, timeout_sec)


@contextmanager
def spinning(*nodes: Node, executor: Executor | None = None) -> Generator[Executor]:
    """Carry out the work of nodes in a thread, while the block waits, or asyncio does.

    What a callback raises is raised at the end of the block.
    """
    chosen = executor or SingleThreadedExecutor(context=nodes[0].context)
    for node in nodes:
        chosen.add_node(node)
    failures: list[BaseException] = []

    def run() -> None:
        try:
            chosen.spin()
        except ExternalShutdownException:
            pass
        except BaseException as error:  # noqa: BLE001  # raised again below
            failures.append(error)

    thread = threading.Thread(target=run, name="ros spinning", daemon=True)
    thread.start()
    try:
        yield chosen
    finally:
        chosen.shutdown()
        thread.join()
    if failures:
        raise failures[0]


@contextmanager
def _spun_by(node: Node, executor: Executor | None) -> Generator[Executor]:
    """Add a node to an executor; at the end, the one that it had before gets it back."""
    before = node.executor
    # A user's program takes the global one, as rclpy does: that of the node may be spinning.
    own = None if strictness.is_begun() else before
    chosen = executor or own or get_global_executor(node.context)
    lent = chosen.add_node(node)
    try:
        yield chosen
    finally:
        if lent:
            chosen.remove_node(node)
            if before is not None and before is not chosen:
                before.add_node(node)


def call_service(
    node: Node, client: Client, request: MessageValue, timeout_s: float = ANSWER_TIMEOUT_S
) -> Any:  # noqa: ANN401  # a response of the service
    """Wait until a service is there, call it and return its answer.

    Raises:
        NotServedError: No node serves it in time, or that node ended.
        NoAnswerError: The answer does not come in time.
    """
    if not client.wait_for_service(timeout_sec=timeout_s):
        raise NotServedError("service", client.srv_name)
    return wait_for_answer(node, client.call_async(request), client.srv_name, timeout_s)


def wait_for_answer(
    node: Node, future: Future[Any], name: str, timeout_s: float = ANSWER_TIMEOUT_S
) -> Any:  # noqa: ANN401  # what the future becomes
    """Wait for a future: a node that nobody spins is spun meanwhile.

    Raises:
        NoAnswerError: It is not done in time, and was cancelled.
    """
    if node.executor is None:
        spin_until_future_complete(node, future, timeout_sec=timeout_s)
    else:
        future.wait(timeout_s)
    if not future.done():
        future.cancel()
        raise NoAnswerError("service", name, timeout_s)
    return future.result()
