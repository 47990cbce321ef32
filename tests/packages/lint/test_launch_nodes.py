from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.packages.edits.new_files import new_launch_file
from studio.packages.edits.writing import write_edit
from studio.packages.roots import ServedRoots
from studio.packages.skeleton import make_package, template_text
from studio.packages.sources.package_source import PackageSource
from tests.support.seeded_packages import changed, codes, mended, sound, written

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.edits.new_files import LaunchFormat


def launched(folder: Path, form: LaunchFormat) -> Path:
    package = sound(folder)
    rows = [("my_pkg", "talker"), ("robot_state_publisher", "robot_state_publisher")]
    write_edit(new_launch_file(PackageSource(package), "up", form, rows), ServedRoots([folder]))
    assert codes(folder) == set()
    return package


def test_a_package_and_a_program_with_a_plus_are_mended(tmp_path: Path):
    # A listing of the course, S3:459
    package = launched(tmp_path, "py")
    before = "package='robot_state_publisher', executable='robot_state_publisher'"
    changed(package, "launch/up.launch.py", before, before.replace("state_", "state+_"))
    mended(tmp_path, "launch-package", "up.launch.py", 9)
    mended(tmp_path, "launch-executable", "up.launch.py", 9)
    assert codes(tmp_path) == set()


def test_a_program_that_no_package_has_is_mended_in_xml(tmp_path: Path):
    package = launched(tmp_path, "xml")
    changed(package, "launch/up.launch.xml", 'exec="talker"', 'exec="talkr"')
    mended(tmp_path, "launch-executable", "up.launch.xml", 2)
    assert codes(tmp_path) == set()


@pytest.mark.parametrize("form", ["py", "xml"])
def test_a_package_whose_node_is_started_is_depended_on(tmp_path: Path, form: LaunchFormat):
    package = launched(tmp_path, form)
    element = "  <exec_depend>robot_state_publisher</exec_depend>\n"
    changed(package, "package.xml", element, "")
    mended(tmp_path, "launch-depend", f"up.launch.{form}", {"py": 9, "xml": 3}[form])
    assert element in (package / "package.xml").read_text()
    changed(package, "package.xml", element, element.replace("exec_depend", "depend"))
    assert codes(tmp_path) == set()


@pytest.mark.parametrize(
    ("name", "text"), [("a.launch.py", "# nothing yet\n"), ("a.launch.xml", "\n")]
)
def test_an_empty_launch_file_is_told(tmp_path: Path, name: str, text: str):
    package = launched(tmp_path, "py")
    written(package, f"launch/{name}", text)
    assert "launch-empty" in codes(tmp_path)


def test_a_created_description_depends_on_all_that_it_starts(tmp_path: Path):
    make_package(tmp_path, "my_arm_description", template_text("arm", "my_arm"))
    assert codes(tmp_path) == set()
