"""What is said of modules that are not here, and of names that they do not have."""

from __future__ import annotations

import pytest

from studio.importable.hints.modules import absent_sentence, is_ours, name_sentence


@pytest.mark.parametrize(
    ("module", "names", "said"),
    [
        (
            "rclpy.nodes",
            ["Node"],
            "there is no module rclpy.nodes: write from rclpy.node import Node.",
        ),
        (
            "rclpi.node",
            ["Node"],
            "there is no module rclpi.node: write from rclpy.node import Node.",
        ),
        ("rclpy.nods", [], "there is no module rclpy.nods: write import rclpy.node."),
        ("rclpy", ["Node"], "rclpy has no Node: write from rclpy.node import Node."),
        ("rclpy", ["Time"], "rclpy has no Time: write from rclpy.time import Time."),
        ("rclpy.node", ["Nodes"], "rclpy.node has no Nodes: write from rclpy.node import Node."),
        (
            "rclpy.executor",
            ["MultiThreadedExecutor"],
            "there is no module rclpy.executor: write from rclpy.executors import "
            "MultiThreadedExecutor.",
        ),
        (
            "tf2_ros",
            ["TransformListner"],
            "tf2_ros has no TransformListner: write from tf2_ros import TransformListener.",
        ),
        (
            "rclpy.nodes",
            ["Zebra"],
            "there is no module rclpy.nodes: rclpy.node was probably meant.",
        ),
        ("rclpy.node", ["Zebra"], None),
        ("helpers", ["zebra"], None),
    ],
)
def test_a_near_module_or_the_one_that_has_the_name_is_said(
    module: str, names: list[str], said: str | None
):
    assert name_sentence(module, names) == said


@pytest.mark.parametrize(
    ("module", "said"),
    [
        ("nope_msgs.msg", "<depend>nope_msgs</depend>"),
        ("nope_msgs.msg", "--package-path"),
        ("nope.srv", "there is no package nope with types"),
        ("std_msg.msg", "there is no package std_msg: std_msgs was probably meant."),
        ("cv_bridge", "cv_bridge is a package of ROS that is not in the studio: numpy"),
        ("moveit", "moveit is a package of ROS that is not in the studio."),
    ],
)
def test_a_package_that_is_not_here_is_said_with_what_to_do(module: str, said: str):
    assert said in (absent_sentence(module) or "")


@pytest.mark.parametrize("module", ["helpers", "numpy.linalg", "std_msgs.msg"])
def test_nothing_is_said_of_modules_that_are_none_of_ros_or_are_here(module: str):
    assert absent_sentence(module) is None


def test_only_what_the_studio_makes_is_its_own():
    assert is_ours("rclpy.nodes")
    assert is_ours("tf2_ross")
    assert not is_ours("std_msgs.msg")
