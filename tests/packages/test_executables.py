from __future__ import annotations

from typing import TYPE_CHECKING

from studio.packages.executables import executables, executables_of
from studio.packages.sources.package_source import PackageSource
from tests.support.student_programs import python_package

if TYPE_CHECKING:
    from pathlib import Path

CMAKE = """\
project(own_cpp)
add_executable(fast src/fast.cpp)  # add_executable(none src/none.cpp)
install(TARGETS fast ARCHIVE DESTINATION lib RUNTIME DESTINATION lib/${PROJECT_NAME})
install(PROGRAMS scripts/slow.py DESTINATION lib/${PROJECT_NAME})
install(PROGRAMS scripts/helper DESTINATION bin)
catkin_install_python(PROGRAMS scripts/old.py DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
"""


def test_programs_of_cmake_are_those_that_ros2_run_finds(tmp_path: Path):
    folder = tmp_path / "own_cpp"
    (folder / "src").mkdir(parents=True)
    (folder / "src" / "fast.cpp").write_text("int main() {}\n")
    (folder / "CMakeLists.txt").write_text(CMAKE)
    found = executables(PackageSource(folder))
    assert [(one.name, one.place, one.language, one.line, one.fault) for one in found] == [
        ("fast", "src/fast.cpp", "c++", 2, ""),
        ("slow.py", "scripts/slow.py", "python", 4, "scripts/slow.py is not there."),
        ("old.py", "scripts/old.py", "python", 6, "scripts/old.py is not there."),
    ]
    assert found[0].file == folder / "src" / "fast.cpp"


def test_faults_are_the_sentences_of_the_checks_where_they_are_asked_for(tmp_path: Path):
    folder = python_package(
        tmp_path, "own_pkg", {"talk": "def main(:\n"}, "talk = own_pkg.talk:main"
    )
    (one,) = executables(PackageSource(folder))
    assert one.fault == ""
    (one,) = executables(PackageSource(folder), with_faults=True)
    assert one.fault.startswith("own_pkg/talk.py is no Python that runs: ")
    (folder / "setup.cfg").unlink()
    (one,) = executables(PackageSource(folder), with_faults=True)
    assert one.fault.startswith("There is no setup.cfg: ")


def test_what_is_installed_comes_before_what_is_declared(tmp_path: Path):
    folder = python_package(tmp_path / "share", "own_pkg", {}, "a = own_pkg.a:main", "a = b.c:d")
    programs = tmp_path / "lib" / "own_pkg"
    programs.mkdir(parents=True)
    for name in ("a", "b", "no_program"):
        (programs / name).write_text("")
        (programs / name).chmod(0o644 if name == "no_program" else 0o755)
    assert executables_of(folder, "own_pkg") == {"a": str(programs / "a"), "b": str(programs / "b")}


def test_of_two_entries_the_first_counts(tmp_path: Path):
    folder = python_package(tmp_path, "own_pkg", {}, "a = own_pkg.a:main", "a = b.c:d", "no place")
    assert executables_of(folder, "own_pkg") == {"a": "own_pkg.a:main"}
