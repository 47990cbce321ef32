"""S3 as a student works through it: hello, chatter, the adder, and R2D2 by a launch file."""

from __future__ import annotations

import re
import subprocess
import sys
from functools import partial
from typing import TYPE_CHECKING

import pytest

from tests.support.course_listings import course_folder, demo_launch
from tests.support.course_workspaces import DEMO_LAUNCH, REPOSITORY, chatter_and_r2d2
from tests.support.student import student_in

if TYPE_CHECKING:
    from collections.abc import Generator

    from tests.support.student import Student

ROBOT = REPOSITORY / "models" / "r2d2_description" / "urdf" / "r2d2.urdf.xacro"


@pytest.fixture(scope="module")
def student(tmp_path_factory: pytest.TempPathFactory) -> Generator[Student]:
    # The course links a file to be downloaded, and does not give it: the studio's R2D2 is alike.
    words = [sys.executable, "-m", "studio", "xacro", str(ROBOT), "stands:=false"]
    robot = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    launch = demo_launch() if course_folder() else DEMO_LAUNCH
    make = partial(chatter_and_r2d2, robot=robot, launch=launch)
    with student_in(make, tmp_path_factory.mktemp("s3")) as found:
        yield found


def test_chatter_is_said_and_heard(student: Student):
    with (
        student.running("run python_pkg_name publisher_node"),
        student.running("run python_pkg_name subscriber_node") as hears,
    ):
        hears.wait_for('I heard: "Hello World"')
        info = student.types("node info /topic_helloworld_sub").out
        assert "/chatter: std_msgs/msg/String" in info
        assert student.types("topic echo --once /chatter").out == "data: Hello World\n---\n"


def test_the_adder_is_waited_for_and_answers(student: Student):
    with student.running("run python_pkg_name client 41 1") as client:
        client.wait_for("service not available, waiting again...")
        with student.running("run python_pkg_name server") as server:
            client.wait_for("Result of add_two_ints: for 41 + 1 = 42")
            assert client.wait() == 0
            server.wait_for("Incoming request")
            called = student.types(
                'service call /add_two_ints learning_interface/srv/AddTwoInts "{a: 1, b: 2}"'
            )
            assert "sum=3" in called.out, called


@pytest.mark.skipif(course_folder() is None, reason="the studio's own node has no such loop")
def test_a_constructor_that_never_ends_prints_and_is_hinted_at(student: Student):
    with student.running("run python_pkg_name node_helloworld") as hello:
        hello.wait_for("Hello World")
        student.sees("node list", "/node_helloworld_class\n")
        hello.wait_for("hint: The constructor of HelloWorldNode has run for 5 s")


def test_r2d2_is_published_thirty_times_a_second(student: Student):
    with student.running("run urdf_view state_publisher") as publisher:
        publisher.wait_for("state_publisher started")
        said = student.types("topic hz --window 60 --once /joint_states")
        if said.code == 2:  # it goes on until Ctrl-C
            said = student.types("topic echo --once /joint_states")
            assert "- periscope" in said.out, said
        else:
            rate = re.search(r"average rate: ([\d.]+)", said.out)
            assert rate, said
            assert 25 < float(rate[1]) < 35
        assert "child_frame_id: axis" in student.types("topic echo --once /tf").out


def test_r2d2_is_launched_and_led_through_odom(student: Student):
    shown = student.types("launch urdf_view demo.launch.py --show-args").out
    assert "'use_sim_time':" in shown
    with student.launched("launch urdf_view demo.launch.py") as launch:
        student.sees("node list", "/robot_state_publisher\n")
        student.sees("node list", "/state_publisher\n")
        student.sees("topic echo --once /tf", "axis")
        student.sees("topic info /robot_description", "Publisher count: 1")
        assert launch.stop() == 0, launch.printed
    student.sees_that("node list", lambda ran: "state_publisher" not in ran.out)
