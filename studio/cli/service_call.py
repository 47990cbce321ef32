"""`studio service call`: ask a service, once or again and again."""

from __future__ import annotations

import argparse
import sys
import time
from typing import TYPE_CHECKING

from studio.cli.acting import acting
from studio.cli.learning import say_aside, say_foreign
from studio.cli.looking import full_name, say_other_types
from studio.cli.wire import add_wire_options
from studio.ros.names import full_type_name

if TYPE_CHECKING:
    from studio.cli.acting import Actor
    from studio.cli.verbs import Verbs
    from studio.ros.node.service_client import Client
    from studio.ros.types.classes import MessageValue


def add_call(verbs: Verbs) -> None:
    """Add the verb."""
    call = verbs.add("call", _run, "ask a service and print its answer")
    call.add_argument("service_name", metavar="SERVICE")
    call.add_argument("service_type", metavar="TYPE")
    call.add_argument(
        "values", metavar="YAML", nargs="?", default="{}", help='the request, as "{a: 1, b: 2}"'
    )
    call.add_argument("-r", "--rate", type=float, metavar="HZ", help="ask so often in a second")
    call.add_argument(
        "--timeout", type=_seconds, metavar="SECONDS",
        help="wait no longer for the service and its answer, then end with 1",
    )  # fmt: skip
    call.set_defaults(takes_late=("values", "{}"))
    add_wire_options(call)


def _seconds(text: str) -> float:
    number = float(text)
    if not number > 0:
        raise argparse.ArgumentTypeError(f"{number} is no time to wait: give more than 0")
    return number


def _run(options: argparse.Namespace) -> int:
    from studio.ros.type_lookup import known_service
    from studio.ros.types.convert import from_yaml

    name = full_name(options.service_name)
    type_name = full_type_name(options.service_type, "srv")
    with acting(options) as actor:
        kind = known_service(actor.node, name, type_name, say_aside)
        request = from_yaml(kind.Request, options.values, now_ns=time.time_ns())
        client = actor.node.create_client(kind, name)
        say_other_types(name, type_name, actor.graph.services())
        if not wait_for_service(client, options.timeout):
            print(f"Nobody serves {name} as {type_name}.", file=sys.stderr)
            return 1
        say_foreign(actor, actor.graph.servers(name))
        while True:
            begun_s = time.monotonic()
            if not _ask(actor, client, request, options.timeout):
                return 1
            if options.rate is None or not options.rate > 0:
                return 0
            time.sleep(max(0.0, begun_s + 1 / options.rate - time.monotonic()))


def wait_for_service(client: Client, timeout_s: float | None) -> bool:
    """Wait until somebody serves, and say so when that is not at once."""
    if client.service_is_ready():
        return True
    print("waiting for service to become available...", flush=True)
    return client.wait_for_service(timeout_s)


def _ask(actor: Actor, client: Client, request: MessageValue, timeout_s: float | None) -> bool:
    print(f"requester: making request: {request!r}\n", flush=True)
    future = client.call_async(request)
    if not actor.wait(future, timeout_s):
        future.cancel()
        print(f"{client.srv_name} did not answer within {timeout_s:g} s.", file=sys.stderr)
        return False
    print(f"response:\n{future.result()!r}\n", flush=True)
    return True
