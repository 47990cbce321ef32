"""S1 as a student works through it: a first package, a library, quotes, points, and Jerry."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.course_workspaces import quotes_and_jerry
from tests.support.student import student_in

if TYPE_CHECKING:
    from collections.abc import Generator

    from tests.support.student import Student

MESSAGES = "run py_pkg_using_messages"


@pytest.fixture(scope="module")
def student(tmp_path_factory: pytest.TempPathFactory) -> Generator[Student]:
    with student_in(quotes_and_jerry, tmp_path_factory.mktemp("s1")) as found:
        yield found


def test_a_node_prints_for_ever_and_a_library_is_imported(student: Student):
    with (
        student.running("run py_pkg_node print_forever_node") as prints,
        student.running("run py_pkg_node sample_py_node"),
        student.running("run py_pkg_library uses") as uses,
    ):
        uses.wait_for("quote")
        assert uses.wait() == 0
        prints.wait_for("Printed 1 times.")
        student.sees("node list", "/print_forever")


def test_quotes_are_published_and_heard(student: Student):
    with (
        student.running(f"{MESSAGES} amazing_quote_publisher_node"),
        student.running(f"{MESSAGES} amazing_quote_subscriber_node") as hears,
    ):
        hears.wait_for("Uncle Ben")
        student.sees("topic info /amazing_quote", "pkg_with_interfaces/msg/AmazingQuote")
        echoed = student.types("topic echo --once /amazing_quote").out
        assert "philosopher_name: Uncle Ben" in echoed
    shown = student.types("interface show pkg_with_interfaces/msg/AmazingQuoteStamped").out
    assert "std_msgs/Header header" in shown


def test_points_are_added(student: Student):
    with (
        student.running(f"{MESSAGES} add_points_service_server_node"),
        student.running(f"{MESSAGES} add_points_service_client_node") as client,
    ):
        client.wait_for("The result was (")
        called = student.types(
            "service call /add_points pkg_with_interfaces/srv/AddPoints "
            '"{a: {x: 1.0, y: 2.0}, b: {x: 0.5, z: 3.0}}"'
        )
        assert "x=1.5, y=2.0, z=3.0" in called.out, called


def test_jerry_goes_where_he_is_told_and_knows_how_far_it_is(student: Student):
    command = "pkg_with_interfaces/msg/JerryCommand"
    with (
        student.running(f"{MESSAGES} jerry_robot_node"),
        student.running(f"{MESSAGES} client_node") as client,
    ):
        student.sees("topic info /jerry_command", "Subscription count: 1")
        sent = f"topic pub --once /jerry_command {command}"
        student.types(f"{sent} '{{direction: left, steps: 3}}'")
        student.sees("topic echo --once /jerry/pose", "y: 3.0")
        student.types(
            f"topic pub --once /jerry_command {command} '{{direction: backward, steps: 4}}'"
        )
        student.sees("topic echo --once /jerry/pose", "x: -4.0")
        called = student.types(
            'service call /distance pkg_with_interfaces/srv/Distance "{x: -1.0, y: 7.0}"'
        )
        assert "distance=5.0" in called.out, called
        client.wait_for("client_node")
    with student.running(f"{MESSAGES} command_publisher_node"):
        student.sees("topic info /jerry_command", "Publisher count: 1")
