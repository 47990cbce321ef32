"""What was meant by an import of a module that is not here: a near name, or where it would be."""

from __future__ import annotations

import difflib
from typing import Final

from studio.importable.names import MODULES
from studio.ros.messages import shared_types
from studio.ros.names import KINDS

_NEAR: Final = 0.8
_TOPS: Final = tuple(sorted({module.partition(".")[0] for module in MODULES}))
_OF_TYPES: Final = ("_msgs", "_interfaces", "_srvs", "_msg", "_srv", "_action")
_NOT_HERE: Final = {
    "cv_bridge": "numpy.frombuffer(msg.data, numpy.uint8) has the bytes of an Image",
    "tf_transformations": "quaternions are four numbers, and transforms3d of PyPI turns them",
    "message_filters": "keep the last message of each topic, and compare their stamps",
    "image_transport": "subscribe to sensor_msgs/msg/CompressedImage itself",
    "rosbag2_py": "rosbags of PyPI reads and writes bags",
    "ros2cli": "the studio has the lines of ros2 as studio node, topic, service and so on",
    "tf2_sensor_msgs": "transform the array of read_points_numpy with numpy",
    "tf2_kdl": "",
    "nav2_simple_commander": "",
    "moveit": "",
    "moveit_py": "",
    "moveit_configs_utils": "",
    "gazebo_ros": "",
    "pcl_ros": "",
    "urdf_parser_py": "",
    "robot_localization": "",
    "rqt_gui_py": "",
}
"""Python packages of ROS that courses import, and what to do instead."""


def is_ours(module: str) -> bool:
    """Whether a module belongs to a package that the studio makes importable."""
    return module.partition(".")[0].startswith(("rclpy", "tf2_")) or (
        module.partition(".")[0] in _TOPS
    )


def name_sentence(module: str, names: list[str]) -> str | None:
    """Return where a name is that a module of ours, or one misspelt, was to give; None: nowhere.

    Args:
        module: As it was written.
        names: Those that were imported from it; none where the module itself was.
    """
    meant = _near_module(module)
    if module not in MODULES and meant is not None:
        known = all(name in MODULES[meant] for name in names)
        if not names:
            return f"there is no module {module}: write import {meant}."
        if known:
            return f"there is no module {module}: write from {meant} import {', '.join(names)}."
    for name in names:
        if name in MODULES.get(module, {}):
            continue
        if home := _home(meant or module, name):
            return f"{module} has no {name}: write from {home[0]} import {home[1]}."
    if module not in MODULES and meant is not None:
        return f"there is no module {module}: {meant} was probably meant."
    return None


def absent_sentence(module: str) -> str | None:
    """Return what to do about a package that is not here; None: it is none of ROS, as far as known.

    Args:
        module: The module that was not found, `nope_msgs.msg`.
    """
    top, _, kind = module.partition(".")
    if top in _NOT_HERE:
        instead = f": {_NOT_HERE[top]}" if _NOT_HERE[top] else ""
        return f"{top} is a package of ROS that is not in the studio{instead}."
    if not (kind in KINDS or top.endswith(_OF_TYPES)):
        return None
    packages = {one.partition("/")[0] for one in shared_types().names()}
    if top in packages:
        return None
    near = difflib.get_close_matches(top, sorted(packages), n=1, cutoff=_NEAR)
    if near:
        return f"there is no package {top}: {near[0]} was probably meant."
    return (
        f"there is no package {top} with types: if it is yours, name it in package.xml "
        f"(<depend>{top}</depend>) and have its folder in the workspace, or name the folder with "
        "--package-path."
    )


def _near_module(module: str) -> str | None:
    if module in MODULES:
        return module
    near = difflib.get_close_matches(module, list(MODULES), n=1, cutoff=_NEAR)
    return near[0] if near else None


def _home(module: str, name: str) -> tuple[str, str] | None:
    """Return module and name of what was meant, as near to the module as there is one."""
    top = module.partition(".")[0]
    inside = [one for one in MODULES if one.partition(".")[0] == top]
    own = [*MODULES.get(module, {})]
    if near := difflib.get_close_matches(name, own, n=1, cutoff=_NEAR):
        return module, near[0]
    for wanted in (name, *_close(name, inside)):
        homes = [one for one in inside or MODULES if wanted in MODULES[one]]
        if homes:
            # Of the modules that show a class the one that is named after its file, or the class.
            return min(
                homes, key=lambda one: (not _is_named_after(one, wanted), len(one), one)
            ), wanted
    return None


def _close(name: str, modules: list[str]) -> list[str]:
    names = {one for module in modules for one in MODULES[module]}
    return difflib.get_close_matches(name, sorted(names), n=1, cutoff=_NEAR)


def _is_named_after(module: str, name: str) -> bool:
    last = module.rpartition(".")[2].replace("_", "").rstrip("s")
    source = MODULES[module][name].partition(":")[0].rpartition(".")[2].replace("_", "")
    return last in {name.lower(), source.rstrip("s")} or name.lower().endswith(last)
