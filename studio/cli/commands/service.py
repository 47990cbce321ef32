"""`studio service`: list services and call them."""

from __future__ import annotations

import argparse
import sys
import time
from typing import TYPE_CHECKING

from studio.cli.graph import (
    add_graph_options,
    add_listing_options,
    add_type_and_find,
    full_name,
    opened_graph,
    print_listing,
    print_other_types,
    print_unknown,
    visible_names,
)
from studio.cli.own_node import own_node, print_error, warn_of_foreign_types
from studio.cli.verbs import Verbs
from studio.cli.wire import add_wire_options
from studio.ros.names import full_type_name

if TYPE_CHECKING:
    from studio.cli.own_node import OwnNode
    from studio.ros.node.service_client import Client
    from studio.ros.types.classes import MessageValue


def add(parser: argparse.ArgumentParser) -> None:
    """Add the verbs of `service` to the parser."""
    verbs = Verbs(parser)
    listing = verbs.add("list", _list, "list the services")
    add_listing_options(listing, "services")
    add_graph_options(listing)
    info = verbs.add("info", _info, "print the type of a service and how many serve and call it")
    info.add_argument("service_name", metavar="SERVICE")
    add_graph_options(info)
    add_type_and_find(verbs, "service", "srv", lambda graph: graph.services())
    _add_call(verbs)


def _list(options: argparse.Namespace) -> None:
    with opened_graph(options) as graph:
        print_listing(visible_names(graph.services(), options), options)


def _info(options: argparse.Namespace) -> int:
    name = full_name(options.service_name)
    with opened_graph(options) as graph:
        servers, clients = graph.servers(name), graph.clients(name)
        if not servers and not clients:
            return print_unknown("service", options.service_name)
        types = sorted({end.type_name for end in (*servers, *clients)})
        print(f"Type: {types[0] if len(types) == 1 else types}")
        print(f"Clients count: {len(clients)}")
        print(f"Services count: {len(servers)}")
    return 0


def _add_call(verbs: Verbs) -> None:
    """Add the verb."""
    call = verbs.add("call", _call, "ask a service and print its answer")
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


def _call(options: argparse.Namespace) -> int:
    from studio.ros.type_lookup import known_service
    from studio.ros.types.convert import from_yaml

    name = full_name(options.service_name)
    type_name = full_type_name(options.service_type, "srv")
    with own_node(options) as own:
        kind = known_service(own.node, name, type_name, print_error)
        request = from_yaml(kind.Request, options.values, now_ns=time.time_ns())
        client = own.node.create_client(kind, name)
        print_other_types(name, type_name, own.graph.services())
        if not _wait_for_service(client, options.timeout):
            print(f"Nobody serves {name} as {type_name}.", file=sys.stderr)
            return 1
        warn_of_foreign_types(own, own.graph.servers(name))
        while True:
            begun_s = time.monotonic()
            if not _ask(own, client, request, options.timeout):
                return 1
            if options.rate is None or not options.rate > 0:
                return 0
            time.sleep(max(0.0, begun_s + 1 / options.rate - time.monotonic()))


def _wait_for_service(client: Client, timeout_s: float | None) -> bool:
    """Wait until there is a server, with a message if it takes time."""
    if client.service_is_ready():
        return True
    print("waiting for service to become available...", flush=True)
    return client.wait_for_service(timeout_s)


def _ask(own: OwnNode, client: Client, request: MessageValue, timeout_s: float | None) -> bool:
    print(f"requester: making request: {request!r}\n", flush=True)
    future = client.call_async(request)
    if not own.wait(future, timeout_s):
        future.cancel()
        print(f"{client.srv_name} did not answer within {timeout_s:g} s.", file=sys.stderr)
        return False
    print(f"response:\n{future.result()!r}\n", flush=True)
    return True
