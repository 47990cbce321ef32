from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.ros.action import ActionServer
from studio.ros.types.library import TypeLibrary
from tests.support.command_line import studio
from tests.support.demos import node_at

if TYPE_CHECKING:
    from collections.abc import Generator

TEXTS = {
    "own_interfaces/msg/Cell": "# One of many.\nfloat32 voltage\n",
    "own_interfaces/msg/Battery": "own_interfaces/Cell[] cells\n",
    "own_interfaces/srv/Ask": "string what\n---\nbool known\n",
    "own_interfaces/action/Charge": "float32 to\n---\nbool full\n---\nfloat32 now\n",
}


@pytest.fixture(scope="module", autouse=True)
def knowing(endpoint: str) -> Generator[None]:
    """A node whose types nobody else knows; it tells what they are made of."""
    types = TypeLibrary("jazzy")
    types.add_texts(TEXTS)
    with node_at(endpoint, "knowing", types) as node:
        node.create_publisher(types.message("own_interfaces/msg/Battery"), "/battery", 10)
        node.create_service(
            types.service("own_interfaces/srv/Ask"), "/ask", lambda _, answer: answer
        )
        server = ActionServer(node, types.action("own_interfaces/action/Charge"), "/charge", print)
        yield
        server.destroy()


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("own_interfaces/msg/Battery", "own_interfaces/Cell[] cells\n\tfloat32 voltage\n"),
        ("own_interfaces/srv/Ask", TEXTS["own_interfaces/srv/Ask"]),
        ("own_interfaces/action/Charge", TEXTS["own_interfaces/action/Charge"]),
    ],
)
def test_t11_a_type_that_only_a_node_knows_is_asked_of_it(endpoint: str, name: str, said: str):
    shown = studio("interface", "show", name, "--connect", endpoint)
    assert shown.out == said, shown.err
    known = TypeLibrary("jazzy")
    known.add_texts(TEXTS)
    told = studio("interface", "hash", name, "--connect", endpoint).out
    assert told == f"{known.hash_of(name)}\n"


def test_a_type_that_nobody_uses_is_not_known(endpoint: str):
    ran = studio("interface", "proto", "own_interfaces/msg/None", "--connect", endpoint)
    assert ran.code == 2
    assert ran.err.startswith('studio: The type "own_interfaces/msg/None" cannot be used: ')
