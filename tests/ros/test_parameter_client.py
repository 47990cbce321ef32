from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.errors import NotServedError
from studio.ros.parameter_client import ParameterClient
from studio.ros.parameters.parameter import Parameter
from tests.support.demos import node_at
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.node import Node

pytestmark = pytest.mark.network


@pytest.fixture
def nodes() -> Generator[tuple[Node, Node]]:
    with (
        running_router() as endpoint,
        node_at(endpoint, "robot") as robot,
        node_at(endpoint, "asking") as asking,
    ):
        robot.declare_parameter("speed", 1.0)
        robot.declare_parameter("wheels.names", ["left", "right"])
        yield robot, asking


def test_parameters_of_another_node_are_seen_and_set(nodes: tuple[Node, Node]):
    robot, asking = nodes
    with ParameterClient(asking, "robot") as client:
        assert client.remote == "/robot"
        names = ["speed", "start_type_description_service", "use_sim_time", "wheels.names"]
        assert client.names() == names
        assert client.names(["wheels"]) == ["wheels.names"]
        assert [one.value for one in client.get(["wheels.names", "no"])] == [
            ["left", "right"],
            None,
        ]
        assert client.types(["speed", "no"]) == [Parameter.Type.DOUBLE, Parameter.Type.NOT_SET]
        assert client.describe(["speed"])[0].type == Parameter.Type.DOUBLE
        results = client.set([Parameter("speed", value=2.0), Parameter("speed", value=2)])
        assert [one.successful for one in results] == [True, False]
        assert robot.get_parameter("speed").value == 2.0
        assert client.set_atomically([Parameter("speed", value=3.0)]).successful


def test_what_is_dumped_is_loaded_again(nodes: tuple[Node, Node]):
    robot, asking = nodes
    with ParameterClient(asking, "robot") as client:
        text = client.dump()
        assert text.startswith("/robot:\n  ros__parameters:\n    speed: 1.0\n")
        robot.set_parameters([Parameter("speed", value=9.0)])
        loaded = {one.name: result for one, result in client.load(text)}
        assert loaded["speed"].successful
        assert "read-only" in loaded["start_type_description_service"].reason
        assert robot.get_parameter("speed").value == 1.0
        assert client.load("/other:\n  ros__parameters:\n    speed: 5.0\n") == []


def test_a_node_that_is_not_there_is_said_by_name(nodes: tuple[Node, Node]):
    with (
        ParameterClient(nodes[1], "/nobody", timeout_s=1.0) as client,
        pytest.raises(NotServedError, match="/nobody/list_parameters"),
    ):
        client.names()


def test_a_node_that_leaves_values_out_has_them_not_set(nodes: tuple[Node, Node]):
    robot, asking = nodes
    for kind, name in (
        ("GetParameters", "get_parameters"),
        ("GetParameterTypes", "get_parameter_types"),
    ):
        service = robot.wire.types.service(f"rcl_interfaces/srv/{kind}")
        robot.create_service(service, f"/curt/{name}", lambda _, response: response)
    with ParameterClient(asking, "/curt") as client:
        assert client.get(["a", "b"]) == [Parameter("a"), Parameter("b")]
        assert client.types(["a"]) == [Parameter.Type.NOT_SET]
