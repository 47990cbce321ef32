from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.seeded_packages import (
    changed,
    codes,
    finding,
    interface_package,
    mended,
    sound,
    written,
)

if TYPE_CHECKING:
    from pathlib import Path

LISTED = 'rosidl_generate_interfaces(${PROJECT_NAME}\n  "srv/GetNowPlaying.srv"\n)'
INSTALL = "install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})\n\nament_package()"


def test_interfaces_behind_the_parenthesis_are_put_inside(tmp_path: Path):
    # A listing of the course, S0:317
    package = interface_package(tmp_path)
    early = 'rosidl_generate_interfaces(${PROJECT_NAME})\n  "srv/GetNowPlaying.srv"\n)'
    changed(package, "CMakeLists.txt", LISTED, early)
    mended(tmp_path, "interfaces-closed-early", "CMakeLists.txt", 11)
    assert codes(tmp_path) == set()


def test_a_placeholder_is_told(tmp_path: Path):
    # A listing of the course, S0:329: srv/<service_type>
    package = interface_package(tmp_path)
    changed(package, "CMakeLists.txt", '"srv/GetNowPlaying.srv"', '"srv/<service_type>"')
    finding(tmp_path, "cmake-placeholder", "CMakeLists.txt", 12)
    finding(tmp_path, "interface-not-listed", "CMakeLists.txt", 11)


def test_a_backslash_before_a_variable_is_taken_out(tmp_path: Path):
    # A listing of the course, S0:141
    package = sound(tmp_path, build_type="ament_cmake")
    written(package, "launch/up.launch.py", "def generate_launch_description():\n    pass\n")
    line = INSTALL.replace("$", "\\$")
    changed(package, "CMakeLists.txt", "ament_package()", line)
    mended(tmp_path, "cmake-escaped-variable", "CMakeLists.txt", 19)
    assert codes(tmp_path) == set()


def test_a_destination_that_breaks_off_is_finished(tmp_path: Path):
    # A listing of the course, S0:141: /la
    package = sound(tmp_path, build_type="ament_cmake")
    written(package, "launch/up.launch.py", "def generate_launch_description():\n    pass\n")
    line = INSTALL.replace("NAME})", "NAME}/la)").replace("Y launch ", "Y launch/ ")
    changed(package, "CMakeLists.txt", "ament_package()", line)
    mended(tmp_path, "install-destination", "CMakeLists.txt", 19)
    assert codes(tmp_path) == set()


@pytest.mark.parametrize(
    "text",
    [
        INSTALL.replace("})\n", "}\n"),
        "install(DIRECTORY launch\n  DESTINATION share/${PROJECT_NAME}\n\nament_package()",
    ],
)
def test_a_command_that_is_not_closed_is_closed(tmp_path: Path, text: str):
    # A listing of the course, S0:141
    package = sound(tmp_path, build_type="ament_cmake")
    written(package, "launch/up.launch.py", "def generate_launch_description():\n    pass\n")
    changed(package, "CMakeLists.txt", "ament_package()", text)
    mended(tmp_path, "cmake-unclosed", "CMakeLists.txt", 19)
    assert codes(tmp_path) == set()


def test_an_interface_that_is_not_listed_is(tmp_path: Path):
    package = interface_package(tmp_path)
    written(package, "msg/Song.msg", "string title\n")
    mended(tmp_path, "interface-not-listed", "CMakeLists.txt", 11)
    assert '"msg/Song.msg"' in (package / "CMakeLists.txt").read_text()
    assert codes(tmp_path) == set()


def test_an_interface_that_is_listed_by_another_name_is_found(tmp_path: Path):
    package = interface_package(tmp_path)
    changed(package, "CMakeLists.txt", "GetNowPlaying.srv", "NowPlaying.srv")
    mended(tmp_path, "interface-file-missing", "CMakeLists.txt", 12)
    assert codes(tmp_path) == set()


def test_packages_that_are_used_are_found_first(tmp_path: Path):
    package = interface_package(tmp_path)
    changed(package, "CMakeLists.txt", "find_package(rosidl_default_generators REQUIRED)\n", "")
    mended(tmp_path, "find-package-missing", "CMakeLists.txt")
    assert codes(tmp_path) == set()
    changed(
        package,
        "CMakeLists.txt",
        "ament_package()",
        "add_executable(a src/a.cpp)\nament_target_dependencies(a rclcpp)\nament_package()",
    )
    written(package, "src/a.cpp", "int main() { return 0; }\n")
    mended(tmp_path, "find-package-missing", "CMakeLists.txt")


def test_types_of_other_packages_are_dependencies_of_the_interfaces(tmp_path: Path):
    package = interface_package(tmp_path)
    written(package, "srv/GetNowPlaying.srv", "---\ngeometry_msgs/Point where\n")
    mended(tmp_path, "interface-dependency", "CMakeLists.txt", 11)
    mended(tmp_path, "missing-interface-depend", "package.xml")
    assert codes(tmp_path) == set()


def test_what_every_list_has_is_missed(tmp_path: Path):
    package = sound(tmp_path, build_type="ament_cmake")
    changed(package, "CMakeLists.txt", "\nament_package()\n", "")
    mended(tmp_path, "ament-package-missing", "CMakeLists.txt")
    changed(package, "CMakeLists.txt", "project(my_pkg)", "")
    finding(tmp_path, "cmake-project-missing", "CMakeLists.txt")
