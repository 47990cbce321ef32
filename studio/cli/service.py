"""`studio service`: which services there are, who serves them, and to call one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.cli.looking import (
    add_hidden_option,
    add_listing_options,
    add_looking_options,
    full_name,
    looking,
    print_listing,
    print_names_of_type,
    print_types_of,
    say_unknown,
    shown,
)
from studio.cli.service_call import add_call
from studio.cli.verbs import Verbs
from studio.ros.names import full_type_name

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Give the parser the verbs of `service`."""
    verbs = Verbs(parser)
    listing = verbs.add("list", _list, "name the services that somebody serves")
    add_listing_options(listing, "services")
    add_looking_options(listing)
    info = verbs.add("info", _info, "say the type of a service and how many serve and call it")
    info.add_argument("service_name", metavar="SERVICE")
    add_looking_options(info)
    kind = verbs.add("type", _type, "print the type of a service")
    kind.add_argument("service_name", metavar="SERVICE")
    add_looking_options(kind)
    find = verbs.add("find", _find, "name the services of a type")
    find.add_argument("type", metavar="TYPE")
    find.add_argument("-c", "--count-services", dest="count", action="store_true")
    add_hidden_option(find, "services")
    add_looking_options(find)
    add_call(verbs)


def _list(options: argparse.Namespace) -> None:
    with looking(options) as graph:
        print_listing(shown(graph.services(), options), options)


def _type(options: argparse.Namespace) -> int:
    with looking(options) as graph:
        return print_types_of(graph.services(), full_name(options.service_name))


def _find(options: argparse.Namespace) -> None:
    wanted = full_type_name(options.type, "srv")
    with looking(options) as graph:
        print_names_of_type(shown(graph.services(), options), wanted, options)


def _info(options: argparse.Namespace) -> int:
    name = full_name(options.service_name)
    with looking(options) as graph:
        servers, clients = graph.servers(name), graph.clients(name)
        if not servers and not clients:
            return say_unknown("service", options.service_name)
        types = sorted({end.type_name for end in (*servers, *clients)})
        print(f"Type: {types[0] if len(types) == 1 else types}")
        print(f"Clients count: {len(clients)}")
        print(f"Services count: {len(servers)}")
    return 0
