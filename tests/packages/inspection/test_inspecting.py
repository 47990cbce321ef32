from __future__ import annotations

import time
from typing import TYPE_CHECKING

from studio.packages.edits.new_files import new_launch_file, new_node
from studio.packages.edits.new_packages import new_description_package
from studio.packages.edits.writing import write_edit
from studio.packages.inspection.inspected import Presence
from studio.packages.inspection.inspecting import (
    PackagesFound,
    inspect_workspace,
    parameter_nodes,
)
from studio.packages.roots import ServedRoots
from studio.packages.sources.package_source import PackageSource
from tests.support.packages import write_install, write_package
from tests.support.seeded_packages import KNOWN, changed, interface_package, sound, written

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.inspection.inspected import InspectedWorkspace


def inspected(folder: Path) -> InspectedWorkspace:
    return inspect_workspace(PackagesFound(folder), KNOWN)


def test_all_that_a_workspace_holds_is_shown(tmp_path: Path):
    roots = ServedRoots([tmp_path])
    interface_package(tmp_path)
    needs = ("rclpy", "radio_station_interfaces", "python3-numpy", "quux_of_mine")
    package = sound(tmp_path, "radio_station", "ament_python", *needs)
    write_edit(new_launch_file(PackageSource(package), "up"), roots)
    written(package, "config/a.yaml", "/turtlesim:\n  ros__parameters:\n    a: 1\n")
    written(package, "rviz/a.rviz", "Panels: []\n")
    written(package, "README.md", "# It\n")
    write_edit(new_description_package(tmp_path, "rover_of_mine_description", "rover"), roots)
    found = inspected(tmp_path)
    assert [one.name for one in found.packages] == [
        *("radio_station", "radio_station_interfaces", "rover_of_mine_description"),
    ]
    radio = found.package("radio_station")
    assert radio is not None
    assert (radio.build_type, radio.version, radio.licenses) == ("ament_python", "0.0.0", ("MIT",))
    assert radio.maintainers == ("Ada <ada@example.com>",)
    presences = {one.name: one.presence for one in radio.dependencies}
    assert presences["rclpy"] is Presence.ROS
    assert presences["radio_station_interfaces"] is Presence.WORKSPACE
    assert presences["python3-numpy"] is Presence.SYSTEM
    assert presences["quux_of_mine"] is Presence.UNKNOWN
    (talker,) = radio.executables
    assert (talker.name, talker.place) == ("talker", "radio_station.talker:main")
    assert (talker.language, talker.line, talker.fault) == ("python", 25, "")
    assert talker.file == package / "radio_station" / "talker.py"
    (launch,) = radio.launch_files
    assert (launch.file, launch.format, launch.is_installed) == (
        package / "launch/up.launch.py",
        "python",
        True,
    )
    assert [one.nodes for one in radio.parameter_files] == [("/turtlesim",)]
    assert radio.rviz_configs == (package / "rviz/a.rviz",)
    assert radio.readme == package / "README.md"
    station = found.package("radio_station_interfaces")
    assert station is not None
    (interface,) = station.interfaces
    assert interface.name == "radio_station_interfaces/srv/GetNowPlaying"
    assert (interface.is_generated, interface.fault) == (True, "")
    rover = found.package("rover_of_mine_description")
    assert rover is not None
    assert [one.title for one in rover.robots] == ["rover_of_mine"]


def test_what_would_not_start_says_why(tmp_path: Path):
    package = sound(tmp_path)
    write_edit(new_node(PackageSource(package), "hear", "empty", KNOWN), ServedRoots([tmp_path]))
    (package / "my_pkg" / "talker.py").unlink()
    changed(package, "my_pkg/hear.py", "def main(", "def start(")
    (found,) = inspected(tmp_path).packages
    talker, hear = found.executables
    assert "no file of the package is that module" in talker.fault
    assert "has no such function" in hear.fault


def test_programs_of_cmake_are_found_with_their_language(tmp_path: Path):
    package = sound(tmp_path, build_type="ament_cmake")
    write_edit(new_node(PackageSource(package), "tick", "timer", KNOWN), ServedRoots([tmp_path]))
    rules = (
        "add_executable(fast src/fast.cpp)\n"
        "install(TARGETS fast DESTINATION lib/${PROJECT_NAME})\n\nament_package()"
    )
    changed(package, "CMakeLists.txt", "ament_package()", rules)
    written(package, "src/fast.cpp", "int main() { return 0; }\n")
    (found,) = inspected(tmp_path).packages
    assert {(one.name, one.language, one.fault) for one in found.executables} == {
        *(("fast", "c++", ""), ("tick.py", "python", "")),
    }


def test_a_cycle_is_named_and_the_order_is_that_of_building(tmp_path: Path):
    for name, needs in (
        ("a_pkg", "b_pkg"),
        ("b_pkg", "c_pkg"),
        ("c_pkg", "b_pkg"),
        ("d_pkg", "a_pkg"),
    ):
        sound(tmp_path, name, "ament_cmake", needs)
    graph = inspected(tmp_path).graph
    names = [one.name for one in graph.nodes if one.presence is Presence.WORKSPACE]
    assert graph.cycles in ((("b_pkg", "c_pkg"),), (("c_pkg", "b_pkg"),))
    assert names.index("b_pkg") < names.index("a_pkg") < names.index("d_pkg")


def test_what_was_built_and_what_is_nested_is_told_apart(tmp_path: Path):
    package = sound(tmp_path)
    write_package(package / "example")
    write_install(tmp_path / "install", ["my_pkg"])
    found = inspected(tmp_path)
    assert [(one.name, one.is_nested) for one in found.packages] == [
        ("my_pkg", False),
        ("example", True),
    ]


def test_a_broken_package_is_shown_as_far_as_it_can_be_read(tmp_path: Path):
    written(tmp_path / "p", "package.xml", "<package><name>half</name><depend>rclpy</depend>")
    (found,) = inspected(tmp_path).packages
    assert (found.name, [one.name for one in found.dependencies]) == ("half", ["rclpy"])
    assert "as far as its fault" in found.fault


def test_a_package_without_a_name_is_not_passed_over(tmp_path: Path):
    written(tmp_path / "mine", "package.xml", "<package><name>My Package</name></package>")
    (found,) = inspected(tmp_path).packages
    assert found.name == "mine"
    assert "names no package" in found.fault


def test_names_of_nodes_are_those_above_their_parameters():
    text = b"a:\n  b:\n    ros__parameters:\n      x: 1\n'/**':\n  ros__parameters: {}\n"
    assert parameter_nodes(text) == ("a/b", "/**")
    assert parameter_nodes(b"- ros__parameters\n" * 3) == ()


def test_a_huge_folder_takes_a_bounded_time(tmp_path: Path):
    for number in range(350):
        write_package(tmp_path / f"p{number}")
    many = tmp_path / "p0" / "config"
    many.mkdir()
    for number in range(4500):
        (many / f"{number}.txt").touch()
    before = time.perf_counter()
    found = inspected(tmp_path)
    assert time.perf_counter() - before < 10
    assert len(found.packages) == 300
    assert not found.packages[0].is_complete
    assert "350 packages" in found.left_out[0]
