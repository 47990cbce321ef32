"""The demos by name, and what `studio run PACKAGE EXECUTABLE` starts: plain data, not run."""

from __future__ import annotations

import ast
import importlib.util
from dataclasses import dataclass
from pathlib import Path

_ROOM = "studio.nodes.demos"
_Executables = tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class Demo:
    """One node of a system of the course.

    Attributes:
        name: As `studio demos NAME` starts it; also the name of its module.
        executables: Packages and names under which `studio run` knows it.
    """

    name: str
    executables: _Executables

    @property
    def module(self) -> str:
        """What `python -m` runs."""
        return f"{_ROOM}.{self.name}"

    @property
    def shows(self) -> str:
        """What it is, in one line."""
        return self._docstring().partition("\n\n")[0].replace("\n", " ")

    @property
    def to_try(self) -> str:
        """What to do with it, in a few lines."""
        return self._docstring().partition("\n\n")[2].removeprefix("Try: ")

    def _docstring(self) -> str:
        """Read what the module says of itself, without running it."""
        found = importlib.util.find_spec(self.module)
        if found is None or found.origin is None:
            return ""
        text = Path(found.origin).read_text(encoding="utf-8")
        return ast.get_docstring(ast.parse(text)) or ""


DEMOS = (
    Demo("rover", (("rover_demo", "rover"),)),
    Demo("talker", (("demo_nodes_py", "talker"), ("python_pkg_name", "publisher_node"))),
    Demo("listener", (("demo_nodes_py", "listener"), ("python_pkg_name", "subscriber_node"))),
    Demo("hello_world", (("python_pkg_name", "node_helloworld"),)),
    Demo("adder_server", (("learning_interface", "server"), ("python_pkg_name", "server"))),
    Demo("adder_client", (("learning_interface", "client"), ("python_pkg_name", "client"))),
    Demo("state_publisher", (("urdf_view", "state_publisher"),)),
    Demo("turtlesim_node", (("turtlesim", "turtlesim_node"),)),
    Demo("turtle_teleop_key", (("turtlesim", "turtle_teleop_key"),)),
    Demo("now_playing_server", (("radio_station", "service_server"),)),
    Demo("now_playing_client", (("radio_station", "service_client"),)),
    Demo("radio_dj", (("radio_station", "radio_dj"),)),
    Demo("song_requester", (("radio_station", "song_requester"),)),
    Demo("print_forever", (("py_pkg_node", "print_forever_node"),)),
    Demo("quote_publisher", (("py_pkg_using_messages", "amazing_quote_publisher_node"),)),
    Demo("quote_subscriber", (("py_pkg_using_messages", "amazing_quote_subscriber_node"),)),
    Demo("add_points_server", (("py_pkg_using_messages", "add_points_service_server_node"),)),
    Demo("add_points_client", (("py_pkg_using_messages", "add_points_service_client_node"),)),
    Demo("jerry_command_publisher", (("jerry", "command_publisher_node"),)),
    Demo("jerry_robot", (("jerry", "jerry_robot_node"),)),
    Demo("jerry_client", (("jerry", "client_node"),)),
    Demo("my_first_node", (("my_py_pkg", "test_node"),)),
    Demo("my_tiny_node", (("my_py_pkg", "my_tiny_node"),)),
    Demo("number_publisher", (("my_py_pkg", "my_tiny_pub"),)),
    Demo("number_counter", (("my_py_pkg", "my_tiny_sub"),)),
    Demo("telemetry_publisher", (("my_py_pkg", "telemetry_publisher"),)),
    Demo("basic_node", (("my_robot_package", "basic_node"),)),
    Demo("publisher_node", (("my_robot_package", "publisher_node"),)),
    Demo("subscriber_node", (("my_robot_package", "subscriber_node"),)),
    Demo("qos_topic_node", (("my_robot_package", "qos_topic_node"),)),
    Demo("service_server_node", (("my_robot_package", "service_server_node"),)),
    Demo("service_client_node", (("my_robot_package", "service_client_node"),)),
    Demo("parameter_node", (("my_robot_package", "parameter_node"),)),
    Demo("timer_node", (("my_robot_package", "timer_node"),)),
    Demo("temperature_publisher", (("my_robot_package", "temperature_publisher"),)),
    Demo("temperature_subscriber", (("my_robot_package", "temperature_subscriber"),)),
    Demo("transform_point", (("my_robot_package", "transform_point"),)),
    Demo("lifecycle_talker", (("lifecycle", "lifecycle_talker"), ("lifecycle_py", "talker"))),
)
"""Every demo, in the order in which `studio demos` lists them."""

COMPANIONS = {
    ("robot_state_publisher", "robot_state_publisher"): "studio.nodes.robot_state_publisher",
    ("joint_state_publisher", "joint_state_publisher"): "studio.nodes.joint_state_publisher",
}
"""Nodes of ours that are no demos: the module of each executable."""


def executables() -> dict[tuple[str, str], str]:
    """Give the module of every executable by package and name."""
    demos = {pair: demo.module for demo in DEMOS for pair in demo.executables}
    return demos | COMPANIONS


def find_demo(name: str) -> Demo | None:
    """Find a demo by its name, or by the name of one of its executables."""
    for demo in DEMOS:
        if name == demo.name:
            return demo
    return next((demo for demo in DEMOS if any(name == exe for _, exe in demo.executables)), None)
