from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import pytest

from studio.errors import CompiledProgramError, ProgramNotFoundError
from studio.packages.discovery import discover
from studio.packages.folder_memory import FolderMemory
from studio.packages.index import Indexed, PackageIndex
from studio.packages.passing import VARIABLE
from studio.packages.roots import ServedRoots
from studio.programs.finding import (
    command_program,
    executables_of_all,
    file_program,
    find_program,
)
from studio.programs.program import RUNNER
from tests.support.student_programs import python_package

if TYPE_CHECKING:
    from pathlib import Path

MAIN = "def main():\n    pass\n"


def index_of(*roots: Path, prefixes: tuple[Path, ...] = ()) -> PackageIndex:
    memory = FolderMemory(None, ServedRoots([*roots, *prefixes]))
    found = [(root, False) for root in roots] + [(prefix, True) for prefix in prefixes]
    return PackageIndex(
        Indexed.found(package)
        for root, is_prefix in found
        for package in discover(root, memory, is_prefix=is_prefix).packages
    )


def test_an_entry_point_of_the_workspace_is_run_from_its_sources(tmp_path: Path):
    folder = python_package(tmp_path, "own_pkg", {"talk": MAIN}, "talk = own_pkg.talk:main")
    found = find_program(index_of(tmp_path), "own_pkg", "talk")
    assert (found.kind, found.module, found.file) == (
        "workspace",
        RUNNER,
        folder / "own_pkg/talk.py",
    )
    assert found.command[:4] == (sys.executable, "-P", "-m", RUNNER)
    name = str(folder / "lib" / "own_pkg" / "talk")
    assert found.command[4:] == ("entry", str(folder), "own_pkg.talk:main", name)
    assert found.environment == {VARIABLE: f"own_pkg={folder}"}


def test_a_package_of_the_workspace_comes_before_the_studios_own_node(tmp_path: Path):
    python_package(tmp_path, "turtlesim", {"own": MAIN}, "turtlesim_node = turtlesim.own:main")
    index = index_of(tmp_path)
    assert find_program(index, "turtlesim", "turtlesim_node").kind == "workspace"
    own = find_program(index, "turtlesim", "turtlesim_node", demo=True)
    assert (own.kind, own.module) == ("studio", "studio.course.turtlesim_node")


@pytest.mark.parametrize(
    ("package", "executable", "module"),
    [
        ("turtlesim", "turtlesim_node", "studio.course.turtlesim_node"),
        ("robot_state_publisher", "robot_state_publisher", "studio.nodes.robot_state_publisher"),
        ("joint_state_publisher_gui", "joint_state_publisher_gui",
         "studio.nodes.joint_state_publisher"),
        ("tf2_ros", "static_transform_publisher", "studio.nodes.static_transform_publisher"),
        ("demo_nodes_cpp", "talker", "studio.course.talker"),
    ],
)  # fmt: skip
def test_the_studios_own_nodes_have_the_names_of_ros(package: str, executable: str, module: str):
    found = find_program(PackageIndex([]), package, executable)
    assert (found.kind, found.module, found.environment) == ("studio", module, {})
    assert found.file is not None
    assert found.file.is_file()


def test_rviz_and_xacro_are_commands_of_the_studio():
    index = PackageIndex([])
    for name, command in (("rviz2", "open"), ("xacro", "xacro")):
        found = find_program(index, name, name)
        assert (found.kind, found.command[3:]) == ("command", ("studio", command))


def test_an_installed_program_is_run_as_it_is(tmp_path: Path):
    share, programs = tmp_path / "share" / "own_pkg", tmp_path / "lib" / "own_pkg"
    share.mkdir(parents=True)
    programs.mkdir(parents=True)
    (share / "package.xml").write_text("<package><name>own_pkg</name></package>")
    (programs / "node").write_text("#!/bin/sh\n")
    (programs / "node").chmod(0o755)
    index = index_of(prefixes=(tmp_path,))
    found = find_program(index, "own_pkg", "node")
    assert (found.kind, found.command) == ("installed", (str(programs / "node"),))
    with pytest.raises(ProgramNotFoundError, match="it has node"):
        find_program(index, "own_pkg", "../own_pkg/node")


CMAKE = """\
add_executable(cpp_node src/node.cpp)
add_executable(gone src/gone.cpp)
install(TARGETS cpp_node gone DESTINATION lib/${PROJECT_NAME})
install(PROGRAMS scripts/script.py DESTINATION lib/${PROJECT_NAME})
"""


@pytest.fixture
def cmake_package(tmp_path: Path) -> Path:
    """A package of C++ with a script of Python, below `src`."""
    folder = tmp_path / "src" / "own_cpp"
    for name in ("src/node.cpp", "scripts/script.py"):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text("")
    (folder / "package.xml").write_text("<package><name>own_cpp</name></package>")
    (folder / "CMakeLists.txt").write_text(CMAKE)
    return folder


def test_an_executable_of_cpp_is_named_as_such(cmake_package: Path):
    index = index_of(cmake_package.parent)
    with pytest.raises(CompiledProgramError) as caught:
        find_program(index, "own_cpp", "cpp_node")
    assert caught.value.source == str(cmake_package / "src" / "node.cpp")
    assert "colcon build --packages-select own_cpp" in str(caught.value)
    with pytest.raises(ProgramNotFoundError, match=r"gone is to be made of src/gone\.cpp"):
        find_program(index, "own_cpp", "gone")


def test_a_build_of_an_executable_of_cpp_is_run(cmake_package: Path, tmp_path: Path):
    programs = tmp_path / "install" / "own_cpp" / "lib" / "own_cpp"
    share = tmp_path / "install" / "own_cpp" / "share" / "own_cpp"
    for folder in (programs, share):
        folder.mkdir(parents=True)
    (share / "package.xml").write_text("<package><name>own_cpp</name></package>")
    (programs / "cpp_node").write_text("")
    (programs / "cpp_node").chmod(0o755)
    index = index_of(cmake_package.parent, prefixes=(tmp_path / "install",))
    found = find_program(index, "own_cpp", "cpp_node")
    assert (found.kind, found.file) == ("installed", programs / "cpp_node")


def test_a_script_that_cmake_installs_is_run_as_a_file(cmake_package: Path):
    found = find_program(index_of(cmake_package.parent), "own_cpp", "script.py")
    script = cmake_package / "scripts" / "script.py"
    assert (found.kind, found.command[4:]) == ("workspace", ("file", str(script)))


def test_what_is_not_known_is_told_with_what_is(tmp_path: Path):
    python_package(tmp_path, "own_pkg", {"talk": MAIN}, "talk = own_pkg.talk:main")
    python_package(tmp_path, "radio_station", {})
    index = index_of(tmp_path)
    for package, executable, said in (
        ("own_pkg", "other", 'no executable "other": it has talk; a new one is a line of'),
        ("radio_station", "radio_dj", "studio run --demo radio_station radio_dj"),
        ("nope", "x", 'No package "nope" is known'),
        ("own_pgk", "talk", 'No package "own_pgk" is known: did you mean own_pkg?'),
        ("turtlesim", "x", "it has turtle_teleop_key, turtlesim_node"),
    ):
        with pytest.raises(ProgramNotFoundError) as caught:
            find_program(index, package, executable)
        assert said in str(caught.value)


def test_a_file_of_python_is_a_program(tmp_path: Path):
    file = tmp_path / "own.py"
    file.write_text("")
    assert file_program(file).command[4:] == ("file", str(file))
    for name, said in (("gone.py", "no such file"), ("own.txt", r"does not end in \.py")):
        (tmp_path / "own.txt").write_text("")
        with pytest.raises(ProgramNotFoundError, match=said):
            file_program(tmp_path / name)


def test_command_lines_of_ros_are_known(tmp_path: Path):
    file = tmp_path / "own.py"
    file.write_text("")
    index = PackageIndex([])
    for words, ends in (
        (
            ["ros2", "run", "turtlesim", "turtlesim_node", "a"],
            ("studio.course.turtlesim_node", "a"),
        ),
        (["/opt/ros/bin/xacro", "r.xacro"], ("studio", "xacro", "r.xacro")),
        (["ros2", "bag", "play", "bag1"], ("studio", "bag", "play", "bag1")),
        (["rviz2", "-d", "x.rviz"], ("studio", "open", "-d", "x.rviz")),
        (["python3", str(file), "b"], (RUNNER, "file", str(file), "b")),
    ):
        found = command_program(index, words)
        assert found is not None
        assert found.command[3:] == ends
    for words in ([], ["gazebo"], ["ros2", "topic", "list"], ["python3", "-c", "x"]):
        assert command_program(index, words) is None


def test_all_executables_are_those_of_the_workspace_and_the_studios_own(tmp_path: Path):
    python_package(tmp_path, "turtlesim", {}, "mine = turtlesim.own:main")
    found = executables_of_all(index_of(tmp_path))
    assert found["turtlesim"] == {"mine": "turtlesim.own:main"}
    assert "radio_dj" in found["radio_station"]
