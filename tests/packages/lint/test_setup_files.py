from __future__ import annotations

from typing import TYPE_CHECKING

from tests.support.seeded_packages import changed, codes, finding, mended, sound

if TYPE_CHECKING:
    from pathlib import Path


def test_a_package_of_python_has_no_build_tool_of_cmake(tmp_path: Path):
    # A listing of the course, S4:268/278
    package = sound(tmp_path)
    changed(
        package,
        "package.xml",
        "  <depend>rclpy</depend>\n",
        "  <buildtool_depend>ament_cmake</buildtool_depend>\n  <depend>rclpy</depend>\n",
    )
    mended(tmp_path, "buildtool-of-cmake", "package.xml", 10)
    assert codes(tmp_path) == set()


def test_the_build_type_is_that_of_the_files(tmp_path: Path):
    changed(sound(tmp_path), "package.xml", "<build_type>ament_python", "<build_type>ament_cmake")
    mended(tmp_path, "build-type", "package.xml")
    assert codes(tmp_path) == set()


def test_a_build_type_that_is_not_said_is_said(tmp_path: Path):
    changed(sound(tmp_path), "package.xml", "    <build_type>ament_python</build_type>\n", "")
    mended(tmp_path, "build-type", "package.xml")
    assert codes(tmp_path) == set()


def test_without_its_file_nothing_is_built(tmp_path: Path):
    (sound(tmp_path) / "setup.py").unlink()
    finding(tmp_path, "build-file-missing", "package.xml")


def test_a_file_that_is_to_be_installed_and_is_not_there_is_told(tmp_path: Path):
    changed(
        sound(tmp_path), "setup.py", "['package.xml']", "['package.xml', 'launch/no.launch.py']"
    )
    finding(tmp_path, "data-file-missing", "setup.py", 11)


def test_a_manifest_that_is_not_installed_is_told(tmp_path: Path):
    package = sound(tmp_path)
    changed(package, "setup.py", "        ('share/' + package_name, ['package.xml']),\n", "")
    finding(tmp_path, "manifest-not-installed", "setup.py")
