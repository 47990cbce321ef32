"""The course's rows on who is there: N1 and N2, nodes in processes of their own."""

from __future__ import annotations

import signal
from typing import TYPE_CHECKING

import pytest

from studio.ros.graph.graph import Graph
from studio.ros.node.context import Context
from studio.ros.node.node import Node
from tests.support.demos import running_demo
from tests.support.patience import Stopwatch
from tests.support.wire import PATIENCE_S, open_test_session

if TYPE_CHECKING:
    from collections.abc import Generator

pytestmark = pytest.mark.network


@pytest.fixture
def graph(endpoint: str) -> Generator[Graph]:
    with open_test_session(endpoint) as wire, Graph(wire) as made:
        made.settle()
        yield made


def test_n1_a_node_appears_within_a_second(endpoint: str, graph: Graph):
    with open_test_session(endpoint) as wire:
        context = Context.over(wire)
        watch = Stopwatch()
        Node("newcomer", namespace="/class", context=context)
        assert graph.wait_for(lambda: graph.node("/class/newcomer") is not None, PATIENCE_S)
        assert watch.s < 1.0
        context.shutdown()


def test_n1_a_node_whose_process_is_killed_vanishes(endpoint: str, graph: Graph):
    with running_demo(endpoint, "talker") as talker:
        talker.wait_for("Publishing")
        assert graph.wait_for(lambda: bool(graph.publishers("/chatter")), PATIENCE_S)
        talker.stop(signal.SIGKILL)
        assert graph.wait_for(lambda: not graph.publishers("/chatter"), PATIENCE_S)
        assert graph.wait_for(lambda: graph.node("/topic_helloworld_pub") is None, PATIENCE_S)
