"""The demos of the course: their names, chapters, lessons and code; imports none of them."""

from __future__ import annotations

import ast
import importlib.util
import re
from dataclasses import dataclass
from pathlib import Path

_ROOM = "studio.course"
_Executables = tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class Demo:
    """One node of a system of the course.

    Attributes:
        name: As `studio demos NAME` starts it; also the name of its module.
        executables: Packages and names by which `studio run` finds it.
    """

    name: str
    executables: _Executables

    @property
    def module(self) -> str:
        """The module for `python -m`."""
        return f"{_ROOM}.{self.name}"

    @property
    def shows(self) -> str:
        """A summary in one line."""
        return self._docstring().partition("\n\n")[0].replace("\n", " ")

    @property
    def to_try(self) -> str:
        """What to try, in a few lines."""
        return self._docstring().partition("\n\n")[2].removeprefix("Try: ")

    def _docstring(self) -> str:
        """Return the docstring of the module, without running it."""
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
    Demo("basic_controls", (("interactive_marker_tutorials", "basic_controls"),)),
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


def executables() -> dict[tuple[str, str], str]:
    """Return the module of every demo by package and executable."""
    return {pair: demo.module for demo in DEMOS for pair in demo.executables}


def find_demo(name: str) -> Demo | None:
    """Find a demo by its name, or by the name of one of its executables."""
    for demo in DEMOS:
        if name == demo.name:
            return demo
    return next((demo for demo in DEMOS if any(name == exe for _, exe in demo.executables)), None)


@dataclass(frozen=True, slots=True)
class Lesson:
    """One demo as a lesson.

    Attributes:
        demo: Its name in `DEMOS`.
        node: The full name of its node, while it runs.
        arguments: Arguments that it needs.
        has_keys: Whether it is driven by key presses.
    """

    demo: str
    node: str
    arguments: tuple[str, ...] = ()
    has_keys: bool = False


CHAPTERS: dict[str, tuple[Lesson, ...]] = {
    "nodes": (
        Lesson("hello_world", "/node_helloworld_class"),
        Lesson("my_first_node", "/my_node_name"),
        Lesson("my_tiny_node", "/my_tiny_node"),
        Lesson("basic_node", "/basic_node"),
        Lesson("print_forever", "/print_forever"),
    ),
    "topics": (
        Lesson("talker", "/topic_helloworld_pub"),
        Lesson("listener", "/topic_helloworld_sub"),
        Lesson("publisher_node", "/publisher_node"),
        Lesson("subscriber_node", "/subscriber_node"),
        Lesson("timer_node", "/timer_node"),
        Lesson("quote_publisher", "/amazing_quote_publisher_node"),
        Lesson("quote_subscriber", "/amazing_quote_subscriber_node"),
        Lesson("number_publisher", "/my_tiny_pub"),
        Lesson("number_counter", "/my_tiny_sub"),
        Lesson("telemetry_publisher", "/telemetry_publisher"),
        Lesson("temperature_publisher", "/temperature_publisher"),
        Lesson("temperature_subscriber", "/temperature_subscriber"),
        Lesson("qos_topic_node", "/qos_topic_node"),
    ),
    "services": (
        Lesson("adder_server", "/service_adder_server"),
        Lesson("adder_client", "/service_adder_client", arguments=("41", "1")),
        Lesson("service_server_node", "/service_server_node"),
        Lesson("service_client_node", "/service_client_node"),
        Lesson("now_playing_server", "/get_now_playing"),
        Lesson("now_playing_client", "/now_playing_client_sol"),
        Lesson("add_points_server", "/add_points_service_server"),
        Lesson("add_points_client", "/add_points_service_client"),
    ),
    "actions": (
        Lesson("radio_dj", "/action_server_node"),
        Lesson("song_requester", "/song_requester"),
    ),
    "parameters": (Lesson("parameter_node", "/parameter_node"),),
    "turtlesim": (
        Lesson("turtlesim_node", "/turtlesim"),
        Lesson("turtle_teleop_key", "/teleop_turtle", has_keys=True),
    ),
    "jerry": (
        Lesson("jerry_robot", "/jerry_robot_node"),
        Lesson("jerry_command_publisher", "/command_publisher_node"),
        Lesson("jerry_client", "/client_node"),
    ),
    "robots": (
        Lesson("state_publisher", "/state_publisher"),
        Lesson("rover", "/rover"),
        Lesson("transform_point", "/transform_point"),
        Lesson("basic_controls", "/basic_controls"),
    ),
    "lifecycle": (Lesson("lifecycle_talker", "/lc_talker"),),
}
"""Every demo stands in one of them."""

LESSONS = {lesson.demo: lesson for chapter in CHAPTERS.values() for lesson in chapter}
"""By the demo's name."""


_FOLDER = Path(__file__).parent
_FOR_LINTERS = re.compile(r"  # noqa\b.*$", re.MULTILINE)
_IMPORTED = re.compile(r"^from studio\.course\.(\w+)\.(\w+) import", re.MULTILINE)


def code_of(demo: str) -> dict[str, str]:
    """Return the text of each file of a demo by its path below the folder of the course.

    Args:
        demo: Its name in `DEMOS`.

    Returns:
        The file with the node first, then the files that it imports from a folder of the course.
    """
    alone = _FOLDER / f"{demo}.py"
    if alone.is_file():
        imported = _IMPORTED.findall(alone.read_text(encoding="utf-8"))
        files = [alone, *(_FOLDER / package / f"{module}.py" for package, module in imported)]
    else:
        parts = sorted((_FOLDER / demo).glob("[!_]*.py"))
        files = sorted(parts, key=lambda part: part.stem != "node")
    return {
        file.relative_to(_FOLDER).as_posix(): _FOR_LINTERS.sub("", file.read_text("utf-8"))
        for file in files
    }
