from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from studio.ros.messages import message, service
from studio.ros.node.logger import LoggingSeverity, get_logger
from studio.ros.node.node import Node
from studio.ros.node.spinning import spinning
from tests.support.node_pair import node_pair, spin_until

if TYPE_CHECKING:
    from collections.abc import Generator

pytestmark = pytest.mark.network
Level = message("rcl_interfaces/msg/LoggerLevel")
Get = service("rcl_interfaces/srv/GetLoggerLevels")
Set = service("rcl_interfaces/srv/SetLoggerLevels")


@pytest.fixture(scope="module")
def asking() -> Generator[Node]:
    with node_pair() as (asker, other):
        server = Node("chatty", context=other.context, enable_logger_service=True)
        with spinning(server):
            yield asker


def ask(node: Node, kind: Any, name: str, **fields: Any) -> Any:  # noqa: ANN401
    client = node.create_client(kind, f"/chatty/{name}")
    assert client.wait_for_service(timeout_sec=30)
    future = client.call_async(kind.Request(**fields))
    spin_until(future.done, node)
    node.destroy_client(client)
    return future.result()


def set_level(node: Node, name: str, level: int) -> Any:  # noqa: ANN401
    levels = [Level(name=name, level=level)]
    return ask(node, Set, "set_logger_levels", levels=levels).results[0]


def test_a_level_is_set_and_told(asking: Node):
    assert set_level(asking, "chatty.part", 40).successful
    assert get_logger("chatty.part").get_effective_level() is LoggingSeverity.ERROR
    told = ask(asking, Get, "get_logger_levels", names=["chatty.part", "chatty.other"]).levels
    assert [(one.name, one.level) for one in told] == [("chatty.part", 40), ("chatty.other", 0)]


def test_what_is_no_level_is_refused(asking: Node):
    result = set_level(asking, "chatty.part", 17)
    assert not result.successful
    assert "17 is no level" in result.reason


def test_names_without_end_are_refused(asking: Node, monkeypatch: pytest.MonkeyPatch):
    assert "at most 255 characters" in set_level(asking, "n" * 256, 10).reason
    monkeypatch.setattr("studio.ros.node.logger.LEVELS_MAX", 0)
    assert "have a level of their own already" in set_level(asking, "chatty.invented", 10).reason


def test_a_node_that_was_not_asked_to_serves_no_levels(asking: Node):
    names = [name for name, _ in asking.get_service_names_and_types()]
    assert "/chatty/get_logger_levels" in names
    assert "/talker/get_logger_levels" not in names
