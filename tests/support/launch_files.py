"""Workspaces with launch files, and their plans."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.launch.planning import PlanLimits, plan_launch_file
from studio.packages.discovery import discover
from studio.packages.folder_memory import FolderMemory
from studio.packages.index import Indexed, PackageIndex
from studio.packages.roots import ServedRoots
from studio.settings import repository_or_wheel

if TYPE_CHECKING:
    from pathlib import Path

    from studio.launch.plan import Plan

PLENTY = PlanLimits(seconds=60.0)
"""For a plan that ends by itself, on a busy machine."""
_MANIFEST = (
    '<package format="3"><name>{name}</name><version>0.0.1</version><description>x</description>'
    '<maintainer email="a@b.invalid">a</maintainer><license>Apache-2.0</license>'
    "<export><build_type>ament_python</build_type></export></package>\n"
)
_SETUP_PY = """\
import os
from glob import glob
from setuptools import setup
package_name = '{name}'
setup(name=package_name, packages=[package_name],
      data_files=[(os.path.join('share', package_name, 'launch'), glob('launch/*')),
                  (os.path.join('share', package_name), glob('urdf/*')),
                  (os.path.join('share', package_name, 'config'), glob('config/*'))],
      entry_points={{'console_scripts': [{scripts}]}})
"""
_SETUP_CFG = """\
[develop]
script_dir=$base/lib/{name}
[install]
install_scripts=$base/lib/{name}
"""


def package_at(src: Path, name: str, files: dict[str, str], *scripts: str) -> Path:
    """Write a Python package with files by their path, and executables; return its folder."""
    folder = src / name
    listed = ", ".join(f"'{one} = {name}.{one}:main'" for one in scripts)
    whole = {
        "package.xml": _MANIFEST.format(name=name),
        "setup.py": _SETUP_PY.format(name=name, scripts=listed),
        "setup.cfg": _SETUP_CFG.format(name=name),
        f"{name}/__init__.py": "",
        **files,
    }
    for path, text in whole.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    return folder


def index_of(*folders: Path) -> PackageIndex:
    """Find the packages of folders, and those that the studio brings."""
    roots = [*folders, repository_or_wheel("models")]
    memory = FolderMemory(None, ServedRoots(roots))
    found = [Indexed.found(one) for root in roots for one in discover(root, memory).packages]
    return PackageIndex(found)


def plan_of(file: Path, index: PackageIndex | None = None, **given: str) -> Plan:
    """Plan a launch file."""
    return plan_launch_file(file, given, index or index_of(file.parent), PLENTY)


def planned(folder: Path, text: str, name: str = "a.launch.py", **given: str) -> Plan:
    """Write a launch file and plan it."""
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return plan_of(file, None, **given)


def described(folder: Path, actions: str, **given: str) -> Plan:
    """Plan a Python launch file with these actions; all names of launch are imported."""
    return planned(folder, f"{_IMPORTS}\n{_BEGIN}{actions}\n    ])\n", **given)


_BEGIN = "def generate_launch_description():\n    return LaunchDescription([\n"
_IMPORTS = """\
from launch import LaunchDescription
from launch.actions import (
    DeclareLaunchArgument, EmitEvent, ExecuteProcess, ForLoop, GroupAction,
    IncludeLaunchDescription, LogInfo, OpaqueFunction, RegisterEventHandler,
    SetEnvironmentVariable, SetLaunchConfiguration, Shutdown, TimerAction)
from launch.conditions import IfCondition, LaunchConfigurationEquals, UnlessCondition
from launch.event_handlers import OnProcessExit, OnProcessStart
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import (
    AndSubstitution, Command, EnvironmentVariable, EqualsSubstitution, FindExecutable,
    IfElseSubstitution, LaunchConfiguration, NotSubstitution, PathJoinSubstitution,
    PythonExpression, TextSubstitution, ThisLaunchFileDir)
from launch_ros.actions import (
    ComposableNodeContainer, LifecycleNode, LoadComposableNodes, Node, PushRosNamespace,
    SetParameter, SetRemap)
from launch_ros.descriptions import ComposableNode, ParameterFile
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare
"""
