"""What the shell's variables name."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from studio.packages.environment import RosEnvironment, is_installed
from tests.support.packages import write_install

if TYPE_CHECKING:
    from pathlib import Path


def test_an_empty_environment_names_nothing():
    assert RosEnvironment.from_variables({}).folders == ()


def test_prefixes_keep_their_order_and_come_once(tmp_path: Path):
    first, second = (write_install(tmp_path / name, [], isolated=False) for name in ("a", "b"))
    variables = {
        "AMENT_PREFIX_PATH": os.pathsep.join(map(str, (second, first, second))),
        "COLCON_PREFIX_PATH": str(first),
    }
    assert RosEnvironment.from_variables(variables).prefixes == (second, first)


def test_the_prefixes_of_an_isolated_workspace_are_its_install_folder(tmp_path: Path):
    install = write_install(tmp_path / "ws" / "install", ["rover", "arm"])
    value = os.pathsep.join(str(install / name) for name in ("rover", "arm"))
    found = RosEnvironment.from_variables({"AMENT_PREFIX_PATH": value})
    assert found.prefixes == (install,)


def test_the_sources_beside_an_install_folder_are_served_for_its_links(tmp_path: Path):
    install = write_install(tmp_path / "ws" / "install", ["rover"])
    (tmp_path / "ws" / "src").mkdir()
    found = RosEnvironment.from_variables({"COLCON_PREFIX_PATH": str(install)})
    assert found.folders == (install, tmp_path / "ws" / "src")


@pytest.mark.parametrize("value", ["", ".", "relative/path", os.pathsep, "/", "/no/such/folder"])
def test_what_is_relative_gone_or_too_wide_is_left_out(value: str):
    names = ("AMENT_PREFIX_PATH", "COLCON_PREFIX_PATH", "ROS_PACKAGE_PATH")
    assert RosEnvironment.from_variables(dict.fromkeys(names, value)).folders == ()


def test_ros_package_path_is_told_apart_into_sources_and_prefixes(tmp_path: Path):
    for name in ("src", "opt/share"):
        (tmp_path / name).mkdir(parents=True)
    value = os.pathsep.join([str(tmp_path / "src"), str(tmp_path / "opt" / "share")])
    found = RosEnvironment.from_variables({"ROS_PACKAGE_PATH": value})
    assert (found.sources, found.prefixes) == ((tmp_path / "src",), (tmp_path / "opt",))


def test_a_file_in_an_install_space_is_known_to_be_installed(tmp_path: Path):
    install = write_install(tmp_path / "ws" / "install", ["rover"])
    assert is_installed(install)
    assert is_installed(install / "rover" / "share" / "rover")
    assert is_installed(install / "rover" / "share" / "rover" / "urdf")
    assert not is_installed(tmp_path / "ws" / "src" / "rover")
