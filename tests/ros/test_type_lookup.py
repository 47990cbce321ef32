from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.errors import UnknownTypeError
from studio.ros.type_lookup import known_action, known_message, known_service
from studio.ros.types.library import TypeLibrary
from tests.support.demos import node_at
from tests.support.wire import running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.node import Node

pytestmark = pytest.mark.network
TEXTS = {
    "robot_pkg/msg/Mood": "string word\n",
    "robot_pkg/srv/Greet": "Mood mood\n---\nbool good\n",
}


@pytest.fixture
def node() -> Generator[Node]:
    """A node that knows the distribution's types, beside one with types of its own."""
    own, usual = TypeLibrary("jazzy"), TypeLibrary("jazzy")
    own.add_texts(TEXTS)
    with (
        running_router() as router,
        node_at(router, "robot", own) as robot,
        node_at(router, "asker", usual) as asker,
    ):
        robot.create_service(own.service("robot_pkg/srv/Greet"), "/greet", lambda _, reply: reply)
        robot.create_subscription(own.message("robot_pkg/msg/Mood"), "/mood", None, 10)
        graph = asker.graph
        wait_until("both", lambda: bool(graph.servers("/greet") and graph.subscriptions("/mood")))
        describing = "/robot/get_type_description"
        wait_until("it describes", lambda: graph.has_server(describing))
        yield asker


def test_what_only_others_know_is_learned_of_who_serves_or_listens(node: Node):
    said: list[str] = []
    kind = known_service(node, "/greet", "robot_pkg/srv/Greet", said.append)
    assert kind.Request().mood.word == ""
    mood = known_message(node, "/mood", "robot_pkg/msg/Mood", said.append)
    assert mood(word="glad").word == "glad"
    assert said == []


def test_what_is_known_is_asked_of_nobody(node: Node):
    fibonacci = known_action(node, "/nowhere", "example_interfaces/action/Fibonacci", pytest.fail)
    assert fibonacci.name.endswith("Fibonacci")


@pytest.mark.parametrize("name", ["/greet", "/nowhere"])
def test_what_nobody_tells_stays_unknown(node: Node, name: str):
    with pytest.raises(UnknownTypeError, match="robot_pkg/srv/Other"):
        known_service(node, name, "robot_pkg/srv/Other", str)
