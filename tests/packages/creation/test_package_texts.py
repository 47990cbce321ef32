from __future__ import annotations

import ast
import subprocess
import sys
from dataclasses import replace
from importlib.metadata import distributions
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.packages.creation.licenses import LICENSES, known_license, license_text
from studio.packages.creation.making import create_package
from studio.packages.creation.new_package import NewPackage, faults
from studio.packages.creation.package_texts import package_files
from studio.packages.sources.cmake import CMakeLists
from studio.packages.sources.package_xml import PackageXml
from studio.packages.sources.setup_py import SetupPy
from tests.support.seeded_packages import codes, sound

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.creation.new_package import BuildType

MINE = NewPackage("my_pkg", "ament_python", ("rclpy",), "talker", "tools", "MIT", "Mine.")
TEXTS = st.text(
    st.characters(codec="utf-8", exclude_categories=("Cc", "Cs", "Cn", "Cf", "Zl", "Zp", "Co")),
    min_size=1,
    max_size=40,
)


@pytest.mark.parametrize("build_type", ["ament_python", "ament_cmake", "cmake"])
def test_a_new_package_of_each_build_type_has_no_fault(tmp_path: Path, build_type: BuildType):
    sound(tmp_path, "my_pkg", build_type)
    assert codes(tmp_path) == set()


def test_a_package_of_cmake_with_node_and_library_has_no_fault(tmp_path: Path):
    new = replace(
        MINE, build_type="ament_cmake", dependencies=("rclcpp",), maintainer_email="a@b.c"
    )
    files = {
        path.relative_to(tmp_path / "my_pkg").as_posix() for path in create_package(tmp_path, new)
    }
    assert files == {
        *("package.xml", "CMakeLists.txt", "LICENSE", "src/talker.cpp", "src/tools.cpp"),
        *("include/my_pkg/tools.hpp", "include/my_pkg/visibility_control.h"),
    }
    assert codes(tmp_path) == set()


def test_the_tree_of_python_is_that_of_ros2_pkg_create():
    assert set(package_files(MINE)) == {
        *("package.xml", "setup.py", "setup.cfg", "resource/my_pkg", "LICENSE"),
        *("my_pkg/__init__.py", "my_pkg/talker.py", "my_pkg/tools/__init__.py"),
        *("test/test_copyright.py", "test/test_flake8.py", "test/test_pep257.py"),
    }


@given(TEXTS, TEXTS, st.sampled_from(["ament_python", "ament_cmake", "cmake"]))
def test_any_text_that_may_be_written_is_read_back(says: str, person: str, build_type: BuildType):
    new = replace(MINE, description=says, maintainer_name=person, build_type=build_type)
    if list(faults(new)):
        return
    files = package_files(new)
    manifest = PackageXml("package.xml", files["package.xml"].encode())
    assert not manifest.fault
    assert manifest.text_of("description") == says.strip()
    assert manifest.text_of("maintainer") == person.strip()
    if build_type == "ament_python":
        setup = SetupPy("setup.py", files["setup.py"].encode())
        assert (setup.text("description"), setup.text("maintainer")) == (says, person)
        assert [one.text for one in setup.scripts] == ["talker = my_pkg.talker:main"]
    else:
        assert not CMakeLists("CMakeLists.txt", files["CMakeLists.txt"].encode()).fault


def test_every_python_file_is_python():
    for name, text in package_files(MINE).items():
        if name.endswith(".py"):
            ast.parse(text)


@pytest.mark.parametrize("name", LICENSES)
def test_each_licence_has_a_text_and_its_name_is_known_in_small_letters(name: str):
    assert len(license_text(name, "Ada", 2026).split()) > 80
    assert "@" not in license_text(name, "Ada", 2026)
    assert known_license(name.lower()) == name


def test_setuptools_installs_the_entry_points_and_the_marker(tmp_path: Path):
    package = sound(tmp_path)
    target = tmp_path / "site"
    # As colcon has it: setup.cfg puts the executables where ros2 run looks for them.
    build = [sys.executable, "setup.py", "-q", "install", "--prefix", str(target)]
    options = ["--single-version-externally-managed", "--record", str(tmp_path / "record.txt")]
    ran = subprocess.run(
        [*build, *options], cwd=package, capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stderr
    assert (target / "lib" / "my_pkg" / "talker").is_file()
    assert (target / "share/ament_index/resource_index/packages/my_pkg").is_file()
    assert (target / "share" / "my_pkg" / "package.xml").is_file()
    folder = next(target.rglob("my_pkg-*.egg-info")).parent
    (found,) = [one for one in distributions(path=[str(folder)]) if one.metadata["Name"]]
    assert [(one.name, one.value) for one in found.entry_points] == [
        ("talker", "my_pkg.talker:main")
    ]
    started = [sys.executable, "-c", "from my_pkg.talker import main; main()"]
    said = subprocess.run(started, cwd=folder, capture_output=True, text=True, check=True)
    assert said.stdout == "Hi from my_pkg.\n"
