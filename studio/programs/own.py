"""The studio's own nodes and commands, by the packages and names that ROS gives them."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Final

import studio
from studio.course.demos import executables

COMMANDS: Final = {("rviz2", "rviz2"): "open", ("xacro", "xacro"): "xacro"}
"""Programs of ROS that are commands of the studio."""
_NODES: Final = {
    ("robot_state_publisher", "robot_state_publisher"): "studio.nodes.robot_state_publisher",
    ("joint_state_publisher", "joint_state_publisher"): "studio.nodes.joint_state_publisher",
    # The page has the sliders that upstream's window has.
    (
        "joint_state_publisher_gui",
        "joint_state_publisher_gui",
    ): "studio.nodes.joint_state_publisher",
    ("tf2_ros", "static_transform_publisher"): "studio.nodes.static_transform_publisher",
    ("demo_nodes_cpp", "talker"): "studio.course.talker",
    ("demo_nodes_cpp", "listener"): "studio.course.listener",
}
"""Nodes that are no demos of the course, and other names of those that are."""


def own_module(package: str, executable: str) -> str | None:
    """Return the module of a node of the studio's own; None: it has none of that name."""
    pair = (package, executable)
    return _NODES.get(pair) or executables().get(pair)


def own_executables() -> dict[str, dict[str, str]]:
    """Return the modules of all of them by package and executable."""
    found: dict[str, dict[str, str]] = {}
    for (package, name), module in {**executables(), **_NODES}.items():
        found.setdefault(package, {})[name] = module
    return found


def own_file(module: str) -> Path | None:
    """Return the file of a module of the studio; imports nothing but the package above it."""
    found = importlib.util.find_spec(module)
    return None if found is None or found.origin is None else Path(found.origin)


def own_folder(package: str) -> Path:
    """Return the folder that holds the code of a package of own nodes."""
    module = next(iter(own_executables()[package].values()))
    found = importlib.util.find_spec(module.rpartition(".")[0])
    return Path(next(iter((found and found.submodule_search_locations) or [""])))


def own_manifest(package: str) -> str:
    """Write the package.xml that a package of own nodes would have; empty for any other."""
    names = ", ".join(sorted(own_executables().get(package, {})))
    if not names:
        return ""
    return (
        '<?xml version="1.0"?>\n'
        "<!-- Written by the studio: these nodes come with it, in no package of their own. -->\n"
        '<package format="3">\n'
        f"  <name>{package}</name>\n"
        f"  <version>{studio.__version__}</version>\n"
        f"  <description>Demo nodes of the studio: {names}.</description>\n"
        '  <maintainer email="none@invalid">the studio</maintainer>\n'
        "  <license>Apache-2.0</license>\n"
        "</package>\n"
    )
