from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.ros.node.context import Context
from studio.ros.node.node import Node
from studio.ros.parameters.parameter import Parameter
from studio.ros.qos import DurabilityPolicy, QoSProfile
from studio.ros.types.library import TypeLibrary
from tests.support.command_line import started, studio
from tests.support.wire import open_test_session

if TYPE_CHECKING:
    from collections.abc import Generator

ODD = "own_interfaces/msg/Odd"
MUTE = Parameter("start_type_description_service", value=False)


@pytest.fixture(scope="module", autouse=True)
def odd_talker(endpoint: str) -> Generator[None]:
    """Somebody whose type nobody else knows, and who does not describe it."""
    types = TypeLibrary("jazzy")
    types.add_texts({ODD: "uint8[4] data\n"})
    kept = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    with open_test_session(endpoint, types=types) as wire:
        context = Context.over(wire)
        node = Node("odd_talker", context=context, parameter_overrides=[MUTE])
        kind = types.message(ODD)
        publisher = node.create_publisher(kind, "/odd", kept)
        for number in range(3):
            publisher.publish(kind(data=[number, 1, 2, 255]))
        yield
        context.shutdown()


def test_an_unknown_type_is_shown_as_such_with_the_reason(endpoint: str):
    ran = studio("topic", "echo", "/odd", "--once", "--connect", endpoint)
    assert ran.code == 2
    assert ran.err.splitlines()[-1] == (
        f'studio: The type "{ODD}" cannot be used: no known package defines it: open its package, '
        "give --interfaces, or see its bytes with --raw."
    )
    info = studio("topic", "info", "-v", "/odd", "--connect", endpoint).out
    assert f"Type: {ODD}\n" in info
    assert "Topic type hash: RIHS01_" in info


def test_the_bytes_of_an_unknown_type_are_shown(endpoint: str):
    ran = studio("topic", "echo", "/odd", "--once", "--raw", "--connect", endpoint)
    assert ran.code == 0
    assert ran.out == "b'\\x00\\x01\\x00\\x00\\x00\\x01\\x02\\xff'\n---\n"
    assert "Its bytes come as they are." in ran.err


def test_the_bytes_of_an_unknown_type_are_counted(endpoint: str):
    with started(endpoint, "topic", "bw", "/odd", "--connect", endpoint) as bw:
        bw.wait_for("from 3 messages\n\tMessage size mean: 8 B min: 8 B max: 8 B")
