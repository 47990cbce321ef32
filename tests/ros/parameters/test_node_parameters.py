from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import (
    NotCallableError,
    ParameterAlreadyDeclaredError,
    ParameterNotDeclaredError,
    ParameterUninitializedError,
)
from studio.ros.node.context import Context
from studio.ros.node.node import Node
from studio.ros.parameters.parameter import Parameter, usual_messages
from tests.support.wire import open_test_session, running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

pytestmark = pytest.mark.network
RESULT = usual_messages().SetParametersResult
BY_ITSELF = {"use_sim_time", "start_type_description_service"}


@pytest.fixture(scope="module")
def context() -> Generator[Context]:
    with running_router() as endpoint, open_test_session(endpoint) as wire:
        joined = Context.over(wire)
        yield joined
        joined.shutdown()


@pytest.fixture
def node(context: Context) -> Generator[Node]:
    made = Node("parameter_node", context=context)
    yield made
    made.destroy_node()


def test_a_callback_that_is_no_function_is_refused(node: Node):
    nothing: Any = None
    for add in (node.add_on_set_parameters_callback, node.add_post_set_parameters_callback):
        with pytest.raises(NotCallableError, match="must be callable, and None is not"):
            add(nothing)


def test_a_node_declares_what_every_node_has(node: Node):
    assert set(node.get_parameters_by_prefix("")) == BY_ITSELF
    assert node.get_parameter("use_sim_time").value is False
    with pytest.raises(ParameterAlreadyDeclaredError, match="every node declares use_sim_time"):
        node.declare_parameter("use_sim_time", value=False)


def test_a_parameter_is_declared_and_read_as_in_the_course(node: Node):
    node.declare_parameter("robot_name", "turtlebot")
    node.declare_parameter("max_velocity", 1.0)
    assert node.get_parameter("robot_name").value == "turtlebot"
    assert node.get_parameter("max_velocity").get_parameter_value().double_value == 1.0
    assert node.get_parameter_type("max_velocity") is Parameter.Type.DOUBLE


def test_several_are_declared_in_a_group_and_found_by_it(node: Node):
    declared: list[tuple[Any, ...]] = [("left", 1), ("right", 2), ("names", ["a"])]
    assert [one.name for one in node.declare_parameters("wheels", declared)] == [
        "wheels.left",
        "wheels.right",
        "wheels.names",
    ]
    found = node.get_parameters_by_prefix("wheels")
    assert {name: one.value for name, one in found.items()} == {
        "left": 1,
        "right": 2,
        "names": ["a"],
    }
    assert [one.value for one in node.get_parameters(["wheels.right", "wheels.left"])] == [2, 1]


def test_another_value_stands_in_for_one_that_is_not_there(node: Node):
    node.declare_parameter("unset", Parameter.Type.STRING)
    assert node.get_parameter_or("nowhere", 5).value == 5
    assert node.get_parameter_or("unset", Parameter("unset", value="x")).value == "x"
    with pytest.raises(ParameterUninitializedError):
        node.get_parameter("unset")
    with pytest.raises(ParameterNotDeclaredError):
        node.get_parameter("nowhere")


def test_callbacks_are_asked_in_turn_until_they_are_removed(node: Node):
    node.declare_parameter("speed", 1.0)
    asked: list[str] = []

    def first(_: list[Parameter]) -> object:
        asked.append("first")
        return RESULT(successful=True)

    def refuse(_: list[Parameter]) -> object:
        asked.append("refuse")
        return RESULT(successful=False, reason="too fast")

    node.add_on_set_parameters_callback(first)
    node.add_on_set_parameters_callback(refuse)
    [result] = node.set_parameters([Parameter("speed", value=9.0)])
    assert (result.successful, result.reason, asked) == (False, "too fast", ["refuse"])
    node.remove_on_set_parameters_callback(refuse)
    assert node.set_parameters_atomically([Parameter("speed", value=9.0)]).successful
    assert asked == ["refuse", "first"]


def test_callbacks_before_and_after_see_what_is_set(node: Node):
    node.declare_parameter("speed", 1.0)
    heard: list[Any] = []

    def limit(given: list[Parameter]) -> list[Parameter]:
        return [Parameter(one.name, value=min(one.value, 2.0)) for one in given]

    def hear(given: list[Parameter]) -> None:
        heard.extend(one.value for one in given)

    node.add_pre_set_parameters_callback(limit)
    node.add_post_set_parameters_callback(hear)
    node.set_parameters([Parameter("speed", value=9.0)])
    assert (node.get_parameter("speed").value, heard) == (2.0, [2.0])
    node.remove_pre_set_parameters_callback(limit)
    node.remove_post_set_parameters_callback(hear)
    node.set_parameters([Parameter("speed", value=9.0)])
    assert (node.get_parameter("speed").value, heard) == (9.0, [2.0])


def test_a_parameter_may_be_taken_away(node: Node):
    node.declare_parameter("a", 1)
    assert node.has_parameter("a")
    node.undeclare_parameter("a")
    assert not node.has_parameter("a")


def test_what_is_given_at_the_start_comes_first_and_may_be_declared_by_itself(context: Context):
    given = [Parameter("a", value=5), Parameter("b.c", value="x")]
    node = Node("one", context=context, parameter_overrides=given)
    assert node.declare_parameter("a", 1).value == 5
    assert not node.has_parameter("b.c")
    node.destroy_node()
    node = Node(
        "two",
        context=context,
        parameter_overrides=given,
        automatically_declare_parameters_from_overrides=True,
    )
    assert node.get_parameter("b.c").value == "x"
    node.destroy_node()


def test_descriptors_are_read_as_they_were_given(node: Node):
    descriptor = usual_messages().ParameterDescriptor(description="how fast", read_only=True)
    node.declare_parameter("speed", 1.0, descriptor)
    [told] = node.describe_parameters(["speed"])
    assert (told.name, told.type, told.description) == ("speed", 3, "how fast")
    assert node.get_parameter_types(["speed", "use_sim_time"]) == [
        Parameter.Type.DOUBLE,
        Parameter.Type.BOOL,
    ]
    node.declare_parameter("gain", 1.0)
    assert node.set_descriptor("gain", descriptor) == 1.0
    assert node.describe_parameter("gain").read_only


def test_a_node_of_humble_describes_no_types():
    with running_router() as endpoint, open_test_session(endpoint, distro="humble") as wire:
        joined = Context.over(wire)
        node = Node("old", context=joined)
        assert set(node.get_parameters_by_prefix("")) == {"use_sim_time"}
        wait_until("it is seen", lambda: node.graph.has_server("/old/get_parameters"))
        assert not node.graph.has_server("/old/get_type_description")
        joined.shutdown()
