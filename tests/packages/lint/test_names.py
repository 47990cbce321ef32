from __future__ import annotations

from typing import TYPE_CHECKING

from tests.support.seeded_packages import changed, codes, finding, mended, sound

if TYPE_CHECKING:
    from pathlib import Path


def test_the_name_in_setup_py_is_made_that_of_package_xml(tmp_path: Path):
    # A listing of the course, S0:344: radio_station, radio_communication
    package = sound(tmp_path, "radio_station")
    changed(
        package,
        "setup.py",
        "package_name = 'radio_station'",
        "package_name = 'radio_communication'",
    )
    mended(tmp_path, "setup-name", "setup.py", 6)
    assert codes(tmp_path) == set()


def test_the_project_of_cmake_is_made_the_name_of_package_xml(tmp_path: Path):
    changed(
        sound(tmp_path, build_type="ament_cmake"),
        "CMakeLists.txt",
        "project(my_pkg)",
        "project(other)",
    )
    mended(tmp_path, "project-name", "CMakeLists.txt", 2)
    assert codes(tmp_path) == set()


def test_a_marker_that_is_missing_is_made(tmp_path: Path):
    package = sound(tmp_path)
    (package / "resource" / "my_pkg").unlink()
    mended(tmp_path, "resource-marker", "setup.py")
    assert codes(tmp_path) == set()


def test_a_marker_that_is_not_installed_is(tmp_path: Path):
    row = "        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),\n"
    changed(sound(tmp_path), "setup.py", row, "")
    mended(tmp_path, "resource-index", "setup.py")
    assert codes(tmp_path) == set()


def test_a_folder_of_another_name_is_worth_knowing(tmp_path: Path):
    sound(tmp_path).rename(tmp_path / "other")
    assert finding(tmp_path, "folder-name", "package.xml").severity == "info"


def test_a_name_that_ros_refuses_is_an_error(tmp_path: Path):
    package = sound(tmp_path, build_type="ament_cmake")
    changed(package, "package.xml", "<name>my_pkg</name>", "<name>My-Pkg</name>")
    finding(tmp_path, "package-name", "package.xml", 4)
