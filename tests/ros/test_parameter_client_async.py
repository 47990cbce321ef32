from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import ParameterFileError
from studio.ros.parameter_client import AsyncParameterClient
from studio.ros.parameters.parameter import Parameter
from tests.support.demos import node_at
from tests.support.goals import finished
from tests.support.wire import PATIENCE_S, running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from studio.ros.node.node import Node

pytestmark = pytest.mark.network


@pytest.fixture
def pair() -> Generator[tuple[Node, AsyncParameterClient]]:
    with (
        running_router() as endpoint,
        node_at(endpoint, "robot") as robot,
        node_at(endpoint, "asking") as asking,
    ):
        robot.declare_parameter("speed", 1.0)
        robot.declare_parameter("any")
        client = AsyncParameterClient(asking, "robot")
        assert client.wait_for_services(PATIENCE_S)
        yield robot, client


def test_answers_come_as_futures_and_to_callbacks(pair: tuple[Node, AsyncParameterClient]):
    client, called = pair[1], list[Any]()
    names = finished(client.list_parameters(callback=called.append)).result.names
    assert {"speed", "any"} < set(names)
    wait_until("called back", lambda: len(called) == 1)
    assert finished(client.get_parameters(["speed"])).values[0].double_value == 1.0
    assert list(finished(client.get_parameter_types(["speed"])).types) == [3]
    assert finished(client.describe_parameters(["speed"])).descriptors[0].name == "speed"


def test_parameters_are_set_and_deleted(pair: tuple[Node, AsyncParameterClient]):
    robot, client = pair
    wanted = [Parameter("speed", value=2.0), Parameter("any", value="x").to_parameter_msg()]
    assert all(one.successful for one in finished(client.set_parameters(wanted)).results)
    assert robot.get_parameter("any").value == "x"
    assert finished(client.set_parameters_atomically(wanted)).result.successful
    [result] = finished(client.delete_parameters(["any"])).results
    assert result.successful
    assert not robot.has_parameter("any")
    [result] = finished(client.delete_parameters(["speed"])).results
    assert "cannot be taken away" in result.reason


def test_a_file_is_loaded(pair: tuple[Node, AsyncParameterClient], tmp_path: Path):
    robot, client = pair
    file = tmp_path / "params.yaml"
    file.write_text("/**:\n  ros__parameters:\n    speed: 3.0\n")
    finished(client.load_parameter_file(str(file)))
    assert robot.get_parameter("speed").value == 3.0
    file.write_text("/**: 3\n")
    with pytest.raises(ParameterFileError, match=r"params\.yaml"):
        client.load_parameter_file(str(file))


def test_services_of_a_node_that_is_not_there_are_not_ready(
    pair: tuple[Node, AsyncParameterClient],
):
    node = pair[0]
    client = AsyncParameterClient(node, "/nobody")
    assert not client.services_are_ready()
    assert not client.wait_for_services(0.1)
    client.destroy()
