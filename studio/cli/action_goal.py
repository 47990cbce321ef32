"""`studio action send_goal`: send a goal, see how it goes and what becomes of it."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Any

from studio.cli.acting import acting
from studio.cli.learning import learn_type, say_foreign
from studio.cli.looking import full_name, say_other_types
from studio.cli.wire import add_wire_options
from studio.errors import UnknownTypeError
from studio.ros.graph.actions import goal_service
from studio.ros.names import full_type_name

if TYPE_CHECKING:
    import argparse

    from studio.cli.acting import Actor
    from studio.cli.verbs import Verbs
    from studio.ros.action.client_goal import ClientGoalHandle
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import ActionType

_CANCEL_S = 1.0


def add_send_goal(verbs: Verbs) -> None:
    """Add the verb."""
    send = verbs.add(
        "send_goal", _run, "send a goal and print what becomes of it", "Ctrl-C cancels the goal."
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


def _run(options: argparse.Namespace) -> int:
    from studio.ros.action.client import ActionClient
    from studio.ros.types.plain import from_yaml

    name = full_name(options.action_name)
    type_name = full_type_name(options.action_type, "action")
    with acting(options) as actor:
        kind = _type_of(actor, name, type_name)
        goal = from_yaml(kind.Goal, options.goal, now_ns=time.time_ns())
        client = ActionClient(actor.node, kind, name)
        say_other_types(name, type_name, actor.graph.actions())
        say_foreign(actor, actor.graph.servers(goal_service(name)))
        print("Waiting for an action server to become available...", flush=True)
        if not client.wait_for_server(options.timeout):
            print(f"Nobody serves {name} as {type_name}.", file=sys.stderr)
            return 1
        print(f"Sending goal:\n     {_text(goal)}", flush=True)
        sent = client.send_goal_async(goal, _say_feedback if options.feedback else None)
        actor.wait(sent)
        return _follow(actor, sent.result())


def _type_of(actor: Actor, name: str, type_name: str) -> ActionType:
    """Find the type among those that are known, else ask a node that serves it what it is."""
    try:
        return actor.types.action(type_name)
    except UnknownTypeError:
        learn_type(actor, actor.graph.servers(goal_service(name)))
        return actor.types.action(type_name)


def _follow(actor: Actor, goal: ClientGoalHandle) -> int:
    if not goal.accepted:
        print("Goal was rejected.")
        return 0
    print(f"Goal accepted with ID: {bytes(goal.goal_id.uuid).hex()}\n", flush=True)
    try:
        ended = goal.get_result_async()
        actor.wait(ended)
    except KeyboardInterrupt:
        _cancel(actor, goal)
        raise
    from studio.ros.action.states import GoalStatus

    answer = ended.result()
    print(f"Result:\n    {_text(answer.result)}")
    print(f"Goal finished with status: {GoalStatus(answer.status).name.removeprefix('STATUS_')}")
    return 0


def _cancel(actor: Actor, goal: ClientGoalHandle) -> None:
    """Ask that the goal end, as nobody waits for it any more."""
    print("Canceling goal...", flush=True)
    asked = goal.cancel_goal_async()
    if not actor.wait(asked, _CANCEL_S):
        print("The server did not answer that the goal is cancelled.", file=sys.stderr)
    elif asked.result().return_code:
        print(f"Failed to cancel the goal, code {asked.result().return_code}.", file=sys.stderr)
    else:
        print("Goal canceled.", flush=True)


def _say_feedback(message: Any) -> None:  # noqa: ANN401  # of the action's own class
    print(f"Feedback:\n    {_text(message.feedback)}", flush=True)


def _text(message: MessageValue) -> str:
    from studio.ros.types.plain import to_yaml

    return to_yaml(message)
