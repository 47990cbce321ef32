"""Names that ROS 2 has, as facts: packages, the programs of some, and where Python modules are.

Not all there are: what is not here may exist all the same, and is said so.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

PACKAGES: Final = frozenset(Path(__file__).with_suffix(".txt").read_text(encoding="utf-8").split())
"""Packages of ROS 2's distributions that courses and robots use most."""

EXECUTABLES: Final[dict[str, frozenset[str]]] = {
    package: frozenset(names.split())
    for package, names in {
        "robot_state_publisher": "robot_state_publisher",
        "joint_state_publisher": "joint_state_publisher",
        "joint_state_publisher_gui": "joint_state_publisher_gui",
        "rviz2": "rviz2",
        "turtlesim": "turtlesim_node turtle_teleop_key draw_square mimic",
        "xacro": "xacro",
        "teleop_twist_keyboard": "teleop_twist_keyboard",
        "rqt_graph": "rqt_graph",
        "demo_nodes_py": (
            "talker listener talker_qos listener_qos talker_serialized listener_serialized "
            "add_two_ints_client add_two_ints_client_async add_two_ints_server async_param_client "
            "introspection_client introspection_service matched_event_detect "
            "set_parameters_callback"
        ),
    }.items()
}
"""Every program of these packages."""

PYTHON_MODULES: Final = {
    "ament_index_python": "ament_index_python",
    "cv2": "python3-opencv",
    "matplotlib": "python3-matplotlib",
    "numpy": "python3-numpy",
    "PIL": "python3-pil",
    "requests": "python3-requests",
    "rosbag2_py": "rosbag2_py",
    "scipy": "python3-scipy",
    "serial": "python3-serial",
    "tf2_ros": "tf2_ros_py",
    "transforms3d": "python3-transforms3d",
    "yaml": "python3-yaml",
}
"""What to depend on for a module whose name says something else; `tf2_ros` is as good."""
ALSO: Final = {
    "tf2_ros": frozenset({"tf2_ros", "tf2_ros_py"}),
    "numpy": frozenset({"python3-numpy", "python-numpy", "numpy"}),
    "yaml": frozenset({"python3-yaml", "yaml"}),
    "cv2": frozenset({"python3-opencv", "cv_bridge", "vision_opencv", "opencv2"}),
}
"""For modules that more than one dependency brings."""

_SYSTEM_KEY: Final = re.compile(
    r"(python3?-.+|lib.+|.+-dev|.+-vendor|.+_vendor|eigen|boost|opencv.*|yaml-cpp|assimp|curl"
    r"|git|cmake|pkg-config|tinyxml2?|qt.*|protobuf.*|sdl.*|ffmpeg|clang.*|ros_.*|"
    r"graphicsmagick|asio|bullet|cppzmq|nlohmann-.*|spdlog|fmt|gtest|benchmark|doxygen)"
)


def is_system_key(name: str) -> bool:
    """Whether a dependency is, by its name, one of the operating system, which rosdep installs."""
    return bool(_SYSTEM_KEY.fullmatch(name))
