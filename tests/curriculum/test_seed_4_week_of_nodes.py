"""S4 as a student works through it: a node of each kind, and its exercises."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.course_workspaces import week_of_nodes
from tests.support.student import student_in

if TYPE_CHECKING:
    from collections.abc import Generator

    from tests.support.student import Student

ADD = "example_interfaces/srv/AddTwoInts"


@pytest.fixture(scope="module")
def student(tmp_path_factory: pytest.TempPathFactory) -> Generator[Student]:
    with student_in(week_of_nodes, tmp_path_factory.mktemp("s4")) as found:
        yield found


def test_nodes_begin_with_a_line_in_the_log(student: Student):
    with (
        student.running("run my_robot_package my_node"),
        student.running("run my_robot_package basic_node"),
    ):
        student.sees("node list", "/basic_node\n")
        student.sees("node list", "/my_node_name\n")


@pytest.mark.parametrize(
    ("publisher", "subscriber"),
    [("topic_publisher", "topic_subscriber"), ("publisher_node", "subscriber_node")],
)
def test_a_topic_is_published_and_heard(student: Student, publisher: str, subscriber: str):
    with (
        student.running(f"run my_robot_package {publisher}"),
        student.running(f"run my_robot_package {subscriber}") as hears,
    ):
        hears.wait_for('I heard: "Hello World: ')
        student.sees("topic type /topic_name", "std_msgs/msg/String")
        assert "data: 'Hello World: " in student.types("topic echo --once /topic_name").out


def test_the_qos_of_a_topic_is_as_its_code_says(student: Student):
    with student.running("run my_robot_package qos_topic_node"):
        student.sees("topic info -v /reliable_topic", "Reliability: RELIABLE")
        assert "Durability: VOLATILE" in student.types("topic info -v /reliable_topic").out


@pytest.mark.parametrize("which", ["", "_node"])
def test_a_service_is_called_by_a_client_and_from_the_terminal(student: Student, which: str):
    with student.running(f"run my_robot_package service_server{which}") as server:
        student.sees("service list", "/add_two_ints\n")
        called = student.types(f'service call /add_two_ints {ADD} "{{a: 1, b: 2}}"')
        assert "sum=3" in called.out, called
        with student.running(f"run my_robot_package service_client{which}") as client:
            client.wait_for("Result")
            assert client.wait() == 0
            assert "3" in client.printed.splitlines()[-1]
        server.wait_for("Returning 1 + 2 = 3")


def test_parameters_are_listed_and_set(student: Student):
    with student.running("run my_robot_package parameter_node") as node:
        node.wait_for("Use sim time: False")
        student.sees("param list /parameter_node", "max_velocity")
        assert student.types("param get /parameter_node robot_name").out.endswith("turtlebot\n")
        assert student.types("param set /parameter_node max_velocity 0.5").code == 0
        node.wait_for("Parameter max_velocity changed to 0.5")
    with student.running(
        "run my_robot_package parameter_node --ros-args -p robot_name:=rover"
    ) as node:
        node.wait_for("Robot name: rover")


def test_a_timer_counts(student: Student):
    with student.running("run my_robot_package timer_node") as node:
        node.wait_for('Publishing: "Timer message: 1"')
        assert "Timer message: " in student.types("topic echo --once /timer_topic").out


def test_the_exercise_of_a_temperature_pair(student: Student):
    with (
        student.running("run my_package temperature_publisher"),
        student.running("run my_package temperature_subscriber") as hears,
    ):
        hears.wait_for("temperature_subscriber")
        student.sees("topic list -t", "sensor_msgs/msg/Temperature")
