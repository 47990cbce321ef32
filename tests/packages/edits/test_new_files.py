from __future__ import annotations

import ast
import shutil
from typing import TYPE_CHECKING

import pytest

from studio.errors import NotMadeError
from studio.packages.edits.new_files import (
    LAUNCH_FORMATS,
    NODE_TEMPLATES,
    new_interface,
    new_launch_file,
    new_node,
    node_text,
)
from studio.packages.edits.writing import write_edit
from studio.packages.roots import ServedRoots
from studio.packages.sources.package_source import PackageSource
from tests.support.seeded_packages import KNOWN, codes, sound

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.edits.package_edit import PackageEdit


def write(edit: PackageEdit, folder: Path) -> list[str]:
    assert edit.by_hand == ()
    return [
        one.relative_to(folder).as_posix() for one in write_edit(edit, ServedRoots([folder])).after
    ]


def test_every_node_has_its_entry_and_its_dependencies(tmp_path: Path):
    package = sound(tmp_path)
    for one in NODE_TEMPLATES:
        written = write(new_node(PackageSource(package), f"{one}_node", one, KNOWN), package)
        assert written[0] == f"my_pkg/{one}_node.py"
        assert "setup.py" in written
        assert codes(tmp_path) == set()
    manifest = (package / "package.xml").read_text()
    assert "<depend>example_interfaces</depend>" in manifest


def test_a_node_of_a_package_of_cmake_is_a_script_that_is_installed(tmp_path: Path):
    package = sound(tmp_path, build_type="ament_cmake")
    written = write(new_node(PackageSource(package), "tick", "timer", KNOWN), package)
    assert written == ["scripts/tick.py", "CMakeLists.txt", "package.xml"]
    assert codes(tmp_path) == set()


@pytest.mark.parametrize("form", LAUNCH_FORMATS)
@pytest.mark.parametrize("build_type", ["ament_python", "ament_cmake"])
def test_a_launch_file_is_installed(tmp_path: Path, form: str, build_type: str):
    package = sound(tmp_path, "my_pkg", build_type)  # pyright: ignore[reportArgumentType]
    rows = [("turtlesim", "turtlesim_node")]
    edit = new_launch_file(PackageSource(package), "up", form, rows)  # pyright: ignore[reportArgumentType]
    assert write(edit, package)[0] == f"launch/up.launch.{form}"
    assert codes(tmp_path) == set()


def test_interfaces_are_generated_with_what_they_need(tmp_path: Path):
    package = sound(tmp_path, build_type="ament_cmake")
    points = "geometry_msgs/Point a\ngeometry_msgs/Point b\n---\ngeometry_msgs/Point result"
    write(new_interface(PackageSource(package), "srv", "AddPoints", points, KNOWN), package)
    write(new_interface(PackageSource(package), "msg", "Quote", "", KNOWN), package)
    write(new_interface(PackageSource(package), "action", "ChooseSong", "", KNOWN), package)
    assert codes(tmp_path) == set()
    assert "DEPENDENCIES geometry_msgs action_msgs" in (package / "CMakeLists.txt").read_text()


@pytest.mark.parametrize("template", NODE_TEMPLATES)
def test_a_template_is_python_without_anything_left_to_fill_in(template: str):
    text = node_text("my_node_2", template)  # pyright: ignore[reportArgumentType]
    ast.parse(text)
    assert "@" not in text
    assert "class MyNode2(Node)" in text


def test_names_that_cannot_be_are_sentences(tmp_path: Path):
    package = sound(tmp_path)
    source = PackageSource(package)
    for name in ("My-Node", "class", "../x", "talker", ""):
        with pytest.raises(NotMadeError):
            new_node(source, name)
    for name in ("a b", "../up", ""):
        with pytest.raises(NotMadeError):
            new_launch_file(source, name)
    with pytest.raises(NotMadeError, match="my_pkg_interfaces"):
        new_interface(source, "msg", "Quote")
    shutil.rmtree(package)
    other = PackageSource(sound(tmp_path, build_type="ament_cmake"))
    with pytest.raises(NotMadeError, match="a capital first"):
        new_interface(other, "msg", "quote")
    with pytest.raises(NotMadeError, match="Quote"):
        new_interface(other, "msg", "Quote", "text a", KNOWN)


def test_a_broken_file_is_told_what_to_write_by_hand(tmp_path: Path):
    package = sound(tmp_path)
    (package / "setup.py").write_text("setup(")
    (package / "package.xml").write_text("<package><name>my_pkg</name>")
    edit = new_node(PackageSource(package), "hear", "subscriber", KNOWN)
    assert [one.file for one in edit.new_files] == [str(package / "my_pkg" / "hear.py")]
    assert edit.edits == ()
    assert "'hear = my_pkg.hear:main' in console_scripts" in edit.by_hand[0]
    assert "<depend>rclpy</depend>" in edit.by_hand[1]


def test_edits_are_made_of_what_is_edited_now(tmp_path: Path):
    package = sound(tmp_path)
    draft = (package / "setup.py").read_bytes() + b"# draft\n"
    source = PackageSource(package, lambda path: draft if path.name == "setup.py" else None)
    edit = new_node(source, "hear", "empty", KNOWN)
    (change,) = [one for one in edit.edits if one.file.endswith("setup.py")]
    assert draft[change.start : change.end].decode() == change.before
