from __future__ import annotations

import pytest

from studio.cli.mending import instead_of
from tests.support.command_line import studio


@pytest.mark.parametrize(
    ("line", "meant"),
    [
        ("service call_ /_spawn turtlesim_/srv/_Spawn_", "studio service call"),
        ("topic ehco /chatter", "studio topic echo"),
        ("nodes list", "studio node"),
        ("pkg creat my_package", "studio pkg create"),
    ],
)
def test_a_misspelt_word_is_answered_with_the_one_that_was_meant(line: str, meant: str):
    ran = studio(*line.split())
    assert ran.code == 2
    assert ran.err.endswith(f"did you mean: {meant}\n")


def test_a_word_that_is_like_none_is_answered_with_all():
    ran = studio("topic", "xyzzy")
    assert ran.code == 2
    assert "choose from" in ran.err
    assert "did you mean" not in ran.err


def test_a_line_may_be_pasted_with_its_ros2():
    assert studio("ros2", "daemon", "stop").out == studio("daemon", "stop").out != ""


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("colcon build --symlink-install", "nothing is built here"),
        ("rosdep install -i --from-path src -y", "package.xml"),
        ("source install/setup.bash", "needs no ROS"),
        ("rqt_graph", "Node graph"),
        ("rviz2 -d x.rviz", "studio open"),
        ("ros2 doctor --report --include-dds", "studio doctor --report"),
        ("ros2 bag convert -i bag1 -o out.yaml", "studio bag cut IN OUT"),
        ("ros2 bag burst bag1 --num-messages 5", "/rosbag2_player/burst"),
        ("bag list storage", "mcap and sqlite3"),
        ("ros2 run lifecycle lifecycle_service_client --ros-args", "studio lifecycle get NODE"),
    ],
)
def test_a_line_of_the_shell_is_answered_with_what_there_is_here(line: str, said: str):
    ran = studio(*line.split())
    assert (ran.code, ran.out) == (2, "")
    assert said in ran.err
    assert ran.err.count("\n") == 1


def test_nothing_is_said_of_commands_that_nobody_knows():
    assert instead_of(["topic", "list"]) is None
    assert instead_of([]) is None
