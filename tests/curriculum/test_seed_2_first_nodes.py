"""S2 as a student works through it: first nodes, a number, a message of one's own, parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.course_workspaces import first_nodes
from tests.support.student import student_in

if TYPE_CHECKING:
    from collections.abc import Generator

    from tests.support.student import Student

TELEMETRY = "my_robot_interfaces/msg/CustomTelemetry"


@pytest.fixture(scope="module")
def student(tmp_path_factory: pytest.TempPathFactory) -> Generator[Student]:
    with student_in(first_nodes, tmp_path_factory.mktemp("s2")) as found:
        yield found


def test_the_first_node_is_called_as_its_code_says_and_not_as_its_executable(student: Student):
    with student.running("run my_py_pkg test_node"):
        student.sees("node list", "/my_node_name\n")


def test_a_timer_says_hello(student: Student):
    with student.running("run my_py_pkg my_tiny_node") as node:
        node.wait_for("Hello 1")


def test_numbers_are_published_and_counted(student: Student):
    with (
        student.running("run my_py_pkg my_tiny_pub"),
        student.running("run my_py_pkg my_tiny_sub") as counts,
    ):
        counts.wait_for("Counter: 4")
        student.sees("topic info /number", "Subscription count: 1")
        info = student.types("topic info /number").out
        assert "Type: example_interfaces/msg/Int64\nPublisher count: 1\n" in info
        assert "data: 2" in student.types("topic echo --once /number").out


def test_a_node_is_renamed_and_its_topic_moved_by_ros_args(student: Student):
    with student.running(
        "run my_py_pkg my_tiny_pub --ros-args -r __node:=other -r number:=/lot -r __ns:=/here"
    ):
        student.sees("node list", "/here/other\n")
        student.sees("topic echo --once /lot", "data: 2")


def test_a_message_of_ones_own_is_published_without_a_build(student: Student):
    shown = student.types(f"interface show {TELEMETRY}").out
    assert "int32 error_count" in shown
    node = student.workspace.write(
        "my_py_pkg/my_py_pkg/telemetry.py",
        f"import rclpy\nfrom my_robot_interfaces.msg import CustomTelemetry\n{TELLS}",
    )
    with student.running(f"run {node}"):
        student.sees("topic type /telemetry", TELEMETRY)
        echoed = student.types("topic echo --once /telemetry").out
        assert echoed == "robot_name: r2\nbattery_voltage: 12.5\nerror_count: 3\n---\n"


TELLS = """
rclpy.init()
node = rclpy.create_node('teller')
publisher = node.create_publisher(CustomTelemetry, 'telemetry', 10)
message = CustomTelemetry(robot_name='r2', battery_voltage=12.5, error_count=3)
node.create_timer(0.1, lambda: publisher.publish(message))
rclpy.spin(node)
"""
