"""`studio action`: list actions and send them goals."""

from __future__ import annotations

import signal
import sys
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from studio.cli.graph import (
    add_graph_options,
    add_listing_options,
    full_name,
    opened_graph,
    print_listing,
    print_other_types,
    visible_names,
)
from studio.cli.own_node import own_node, print_error, warn_of_foreign_types
from studio.cli.verbs import Verbs
from studio.cli.wire import add_wire_options
from studio.ros.names import full_type_name

if TYPE_CHECKING:
    import argparse
    from collections.abc import Generator

    from studio.cli.own_node import OwnNode
    from studio.ros.action.client import ClientGoalHandle
    from studio.ros.graph.graph import Graph
    from studio.ros.node.task import Future
    from studio.ros.types.classes import MessageValue


def add(parser: argparse.ArgumentParser) -> None:
    """Add the verbs of `action` to the parser."""
    verbs = Verbs(parser)
    listing = verbs.add("list", _list, "list the actions")
    add_listing_options(listing, "actions")
    add_graph_options(listing)
    info = verbs.add("info", _info, "print the servers and clients of an action")
    info.add_argument("action_name", metavar="ACTION")
    info.add_argument("-t", "--show-types", action="store_true", help="with its type")
    info.add_argument("-c", "--count", action="store_true", help="how many there are, alone")
    add_graph_options(info)
    kind = verbs.add("type", _type, "print the type of an action")
    kind.add_argument("action_name", metavar="ACTION")
    add_graph_options(kind)
    _add_send_goal(verbs)


def _list(options: argparse.Namespace) -> None:
    with opened_graph(options) as graph:
        print_listing(visible_names(graph.actions(), options), options)


def _type(options: argparse.Namespace) -> int:
    with opened_graph(options) as graph:
        types = dict(graph.actions()).get(full_name(options.action_name), [])
        print("".join(f"{one}\n" for one in types), end="")
        return 0 if types else 1


def _info(options: argparse.Namespace) -> int:
    name = full_name(options.action_name)
    with opened_graph(options) as graph:
        print(f"Action: {name}")
        for title, paths in _ends(graph, name):
            print(f"Action {title}: {len(paths)}")
            if not options.count:
                kind = f" [{', '.join(dict(graph.actions()).get(name, []))}]"
                print("".join(f"    {path}{kind * options.show_types}\n" for path in paths), end="")
    return 0


def _ends(graph: Graph, name: str) -> list[tuple[str, list[str]]]:
    return [
        ("clients", [node.path for node in graph.action_clients(name)]),
        ("servers", [node.path for node in graph.action_servers(name)]),
    ]


_CANCEL_TIMEOUT_S = 5.0
_LOG_PATIENCE_S = 0.5
"""A server's log may arrive later than its answer."""
_WARNING = 30
_CHECK_EVERY_S = 0.1
"""Between two checks for Ctrl-C while waiting for an answer."""


def _add_send_goal(verbs: Verbs) -> None:
    """Add the verb."""
    send = verbs.add(
        "send_goal",
        _send_goal,
        "send a goal and print what becomes of it",
        "Ctrl-C cancels the goal.",
    )
    send.add_argument("action_name", metavar="ACTION")
    send.add_argument("action_type", metavar="TYPE")
    send.add_argument("goal", metavar="YAML", nargs="?", default="{}", help="the goal")
    send.add_argument("-f", "--feedback", action="store_true", help="print how it goes")
    send.add_argument(
        "--timeout", type=float, metavar="SECONDS", help="wait no longer for the server"
    )
    send.set_defaults(takes_late=("goal", "{}"))
    add_wire_options(send)


def _send_goal(options: argparse.Namespace) -> int:
    from studio.ros.action.client import ActionClient
    from studio.ros.type_lookup import known_action
    from studio.ros.types.convert import from_yaml

    name = full_name(options.action_name)
    type_name = full_type_name(options.action_type, "action")
    with own_node(options) as own:
        kind = known_action(own.node, name, type_name, print_error)
        goal = from_yaml(kind.Goal, options.goal, now_ns=time.time_ns())
        client = ActionClient(own.node, kind, name)
        print_other_types(name, type_name, own.graph.actions())
        from studio.ros.graph.graph import goal_service

        warn_of_foreign_types(own, own.graph.servers(goal_service(name)))
        print("Waiting for an action server to become available...", flush=True)
        if not client.wait_for_server(options.timeout):
            print(f"Nobody serves {name} as {type_name}.", file=sys.stderr)
            return 1
        print(f"Sending goal:\n     {_text(goal)}", flush=True)
        feedback = _Feedback()
        log = _ServerLog(own, name)
        with _noted_interrupt() as interrupt:
            sent = client.send_goal_async(goal, feedback.take if options.feedback else None)
            interrupt.wait(own, sent)
            if interrupt.came:
                _cancel_sent(own, sent)
                raise KeyboardInterrupt
            return _follow(own, sent.result(), feedback, interrupt, log)


def _follow(
    own: OwnNode,
    goal: ClientGoalHandle,
    feedback: _Feedback,
    interrupt: _Interrupt,
    log: _ServerLog,
) -> int:
    from studio.ros.action.protocol import GoalStatus

    if not goal.accepted:
        print("Goal was rejected.")
        log.print_reason()
        return 0
    print(f"Goal accepted with ID: {bytes(goal.goal_id.uuid).hex()}\n", flush=True)
    feedback.begin()
    ended = goal.get_result_async()
    interrupt.wait(own, ended)
    if not ended.done():
        _cancel(own, goal)
        raise KeyboardInterrupt
    answer = ended.result()
    print(f"Result:\n    {_text(answer.result)}")
    print(f"Goal finished with status: {GoalStatus(answer.status).name.removeprefix('STATUS_')}")
    if answer.status == GoalStatus.ABORTED:
        log.print_reason()
    return 0


def _cancel_sent(own: OwnNode, sent: Future[ClientGoalHandle]) -> None:
    """Cancel a goal that the server has neither accepted nor rejected yet."""
    if not own.wait(sent, _CANCEL_TIMEOUT_S):
        print("The server did not say whether it accepted the goal.", file=sys.stderr)
    elif sent.result().accepted:
        _cancel(own, sent.result())


def _cancel(own: OwnNode, goal: ClientGoalHandle) -> None:
    """Cancel a goal, as nobody waits for it any more."""
    print("Canceling goal...", flush=True)
    asked = goal.cancel_goal_async()
    if not own.wait(asked, _CANCEL_TIMEOUT_S):
        print("The server did not answer that the goal is cancelled.", file=sys.stderr)
    elif asked.result().return_code:
        print(f"Failed to cancel the goal, code {asked.result().return_code}.", file=sys.stderr)
    else:
        print("Goal canceled.", flush=True)


class _Interrupt:
    """Whether Ctrl-C was pressed.

    A KeyboardInterrupt could be raised anywhere: in a callback, or before the goal is known, where
    nothing would cancel it.
    """

    def __init__(self) -> None:
        self.came = False

    def wait(self, own: OwnNode, future: Future[Any]) -> None:
        """Carry out callbacks until a future is done or Ctrl-C is pressed."""
        while not self.came and not own.wait(future, _CHECK_EVERY_S):
            pass


@contextmanager
def _noted_interrupt() -> Generator[_Interrupt]:
    """Take note of the first Ctrl-C; the second one ends the command at once."""
    interrupt = _Interrupt()

    def note(_number: int, _frame: object) -> None:
        interrupt.came = True
        signal.signal(signal.SIGINT, signal.default_int_handler)

    before = signal.signal(signal.SIGINT, note)
    try:
        yield interrupt
    finally:
        signal.signal(signal.SIGINT, before)


class _Feedback:
    """Says feedback; what overtakes the answer that the goal is accepted waits for that."""

    def __init__(self) -> None:
        self._early: list[Any] | None = []

    def take(self, message: Any) -> None:  # noqa: ANN401  # of the action's own class
        """Print it now, or once the goal is accepted."""
        if self._early is None:
            print(f"Feedback:\n    {_text(message.feedback)}", flush=True)
        else:
            self._early.append(message)

    def begin(self) -> None:
        """Print what came too early, and from now on what comes."""
        early, self._early = self._early or [], None
        for message in early:
            self.take(message)


class _ServerLog:
    """What an action's server logs from now on: its answer has no reason."""

    def __init__(self, own: OwnNode, action: str) -> None:
        from studio.ros.names import logger_name
        from studio.ros.node.logger import ROSOUT

        self._actor, self._since_ns = own, time.time_ns()
        self._servers = [one.path for one in own.graph.action_servers(action)]
        self._loggers = tuple(f"{logger_name(path)}." for path in self._servers)
        self._warning: Any = None
        log = own.types.message("rcl_interfaces/msg/Log")
        own.node.create_subscription(log, ROSOUT, self._take, 100)

    def print_reason(self) -> None:
        """Print its last warning or error, or where to find it."""
        self._actor.work_until(lambda: self._warning is not None, _LOG_PATIENCE_S)
        server = ", ".join(self._servers)
        if self._warning is None:
            text = f"The answer holds no reason; the output of {server} may."
        else:
            text = f"The answer holds no reason; meanwhile {server} logged: {self._warning.msg}"
        print(text, file=sys.stderr)

    def _take(self, line: Any) -> None:  # noqa: ANN401  # of the message's own class
        stamp_ns = line.stamp.sec * 10**9 + line.stamp.nanosec
        is_new = line.level >= _WARNING and stamp_ns >= self._since_ns
        if is_new and f"{line.name}.".startswith(self._loggers):
            self._warning = line


def _text(message: MessageValue) -> str:
    from studio.ros.types.convert import to_yaml

    return to_yaml(message)
