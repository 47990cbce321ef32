from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from studio.ros.parameters.parameter import Parameter, usual_messages
from tests.support.demos import call, heard, node_at
from tests.support.wire import running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.node import Node

pytestmark = pytest.mark.network
RESULT = usual_messages().SetParametersResult


@pytest.fixture(scope="module")
def nodes() -> Generator[tuple[Node, Node]]:
    with (
        running_router() as endpoint,
        node_at(endpoint, "robot") as robot,
        node_at(endpoint, "asking") as asking,
    ):
        robot.declare_parameter("max_velocity", 1.0)
        robot.declare_parameter("wheels.left", 1)
        robot.declare_parameter("wheels.motor.gain", 2.5)
        yield robot, asking


def ask(nodes: tuple[Node, Node], kind: str, name: str, **fields: Any) -> Any:  # noqa: ANN401
    return call(nodes[1], f"rcl_interfaces/srv/{kind}", f"/robot/{name}", **fields)


def set_one(nodes: tuple[Node, Node], name: str, value: object) -> Any:  # noqa: ANN401
    wanted = [Parameter(name, value=value).to_parameter_msg()]
    return ask(nodes, "SetParameters", "set_parameters", parameters=wanted).results[0]


def test_parameters_are_listed_with_their_groups(nodes: tuple[Node, Node]):
    result = ask(nodes, "ListParameters", "list_parameters").result
    assert set(result.names) >= {"max_velocity", "use_sim_time", "wheels.left"}
    assert result.prefixes == ["wheels", "wheels.motor"]
    result = ask(nodes, "ListParameters", "list_parameters", prefixes=["wheels"], depth=1).result
    assert result.names == ["wheels.left"]


def test_values_and_types_are_told_and_what_is_unknown_is_not_set(nodes: tuple[Node, Node]):
    names = ["wheels.left", "nowhere"]
    values = ask(nodes, "GetParameters", "get_parameters", names=names).values
    assert [one.type for one in values] == [2, 0]
    assert values[0].integer_value == 1
    types = ask(nodes, "GetParameterTypes", "get_parameter_types", names=names).types
    assert list(types) == [2, 0]


def test_descriptors_are_told(nodes: tuple[Node, Node]):
    names = ["start_type_description_service", "nowhere"]
    told = ask(nodes, "DescribeParameters", "describe_parameters", names=names).descriptors
    assert [(one.name, one.type, one.read_only) for one in told] == [
        ("start_type_description_service", 1, True),
        ("nowhere", 0, False),
    ]


def test_a_change_is_told_to_all(nodes: tuple[Node, Node]):
    events = heard(nodes[1], "rcl_interfaces/msg/ParameterEvent", "/parameter_events")
    robot = nodes[0]
    wait_until("it is heard", lambda: bool(robot.graph.subscriptions("/parameter_events")))
    assert set_one(nodes, "max_velocity", 2.0).successful
    wait_until("the change is heard", lambda: bool(events))
    [event] = events
    assert event.node == "/robot"
    assert event.stamp.sec > 0
    [changed] = event.changed_parameters
    assert (changed.name, changed.value.double_value) == ("max_velocity", 2.0)
    assert (event.new_parameters, event.deleted_parameters) == ([], [])


def test_a_refusal_has_its_reason(nodes: tuple[Node, Node]):
    assert "is not declared" in set_one(nodes, "nowhere", 1).reason
    assert "it is double, string was given" in set_one(nodes, "max_velocity", "fast").reason
    assert "read-only" in set_one(nodes, "start_type_description_service", value=False).reason


def test_a_type_that_there_is_not_is_refused(nodes: tuple[Node, Node]):
    wanted = Parameter("max_velocity", value=1.5).to_parameter_msg()
    wanted.value.type = 99
    [result] = ask(nodes, "SetParameters", "set_parameters", parameters=[wanted]).results
    assert (result.successful, "there is no type 99" in result.reason) == (False, True)


def test_all_are_set_or_none(nodes: tuple[Node, Node]):
    wanted = [Parameter("wheels.left", value=7), Parameter("max_velocity", value="fast")]
    messages = [one.to_parameter_msg() for one in wanted]
    result = ask(
        nodes, "SetParametersAtomically", "set_parameters_atomically", parameters=messages
    ).result
    assert not result.successful
    assert nodes[0].get_parameter("wheels.left").value == 1


def test_a_callback_that_raises_is_a_refusal_and_the_node_goes_on(
    nodes: tuple[Node, Node], capsys: pytest.CaptureFixture[str]
):
    robot = nodes[0]

    def fail(given: list[Parameter]) -> object:
        raise ValueError(f"no {given[0].name} today")

    robot.add_on_set_parameters_callback(fail)
    try:
        result = set_one(nodes, "max_velocity", 3.0)
    finally:
        robot.remove_on_set_parameters_callback(fail)
    assert "ValueError: no max_velocity today" in result.reason
    assert "no max_velocity today" in capsys.readouterr().err
    assert set_one(nodes, "max_velocity", 3.0).successful


def test_a_callback_that_fails_after_a_value_was_set_makes_no_failure_of_it(
    nodes: tuple[Node, Node], capsys: pytest.CaptureFixture[str]
):
    robot, _ = nodes

    def fails(_: list[Parameter]) -> None:
        raise ValueError("told too late")

    robot.add_post_set_parameters_callback(fails)
    result = set_one(nodes, "max_velocity", 0.25)
    robot.remove_post_set_parameters_callback(fails)
    assert (result.successful, result.reason) == (True, "")
    assert robot.get_parameter("max_velocity").value == 0.25
    assert "failed after parameters were set: ValueError: told too late" in capsys.readouterr().err
