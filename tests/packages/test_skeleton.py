from __future__ import annotations

import ast
from typing import TYPE_CHECKING

import pytest

from studio.errors import NotMadeError
from studio.packages.manifest import package_name
from studio.packages.skeleton import Template, make_file, make_package, template_text
from tests.support.permissions import open_folder, unprivileged

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

TEMPLATES: tuple[Template, ...] = ("blank", "rover", "arm")


def made(folder: Path) -> Iterator[str]:
    return (one.relative_to(folder).as_posix() for one in folder.rglob("*") if one.is_file())


def test_a_package_has_all_that_ros_needs_and_nothing_left_to_fill_in(tmp_path: Path):
    file = make_package(tmp_path, "my_rover_description", template_text("rover", "my_rover"))
    assert file == tmp_path / "my_rover_description" / "urdf" / "my_rover.urdf.xacro"
    package = tmp_path / "my_rover_description"
    assert set(made(package)) == {
        *("package.xml", "CMakeLists.txt", "README.md"),
        *("launch/display.launch.py", "urdf/my_rover.urdf.xacro"),
    }
    assert package_name((package / "package.xml").read_bytes()) == "my_rover_description"
    ast.parse((package / "launch" / "display.launch.py").read_text())
    assert not [
        name
        for name in made(package)
        if "@" in (package / name).read_text().replace("you@example", "")
    ]
    assert [one.name for one in tmp_path.iterdir()] == ["my_rover_description"]


@pytest.mark.parametrize("template", TEMPLATES)
def test_each_template_bears_the_name_of_its_robot(template: Template):
    assert b'<robot name="mine"' in template_text(template, "mine")


def test_the_launch_file_holds_still_the_first_link_of_a_text_of_ones_own(tmp_path: Path):
    make_package(tmp_path, "own", b"<robot name='r'><link name='chassis'/></robot>")
    launch = (tmp_path / "own" / "launch" / "display.launch.py").read_text()
    assert '"-f", "chassis"' in launch


def test_what_is_there_is_never_written_over(tmp_path: Path):
    (tmp_path / "rover").mkdir()
    (tmp_path / "arm.urdf.xacro").write_text("mine")
    with pytest.raises(NotMadeError, match="something of that name"):
        make_package(tmp_path, "rover", b"<robot/>")
    with pytest.raises(NotMadeError, match="it is there already"):
        make_file(tmp_path, "arm", b"<robot/>")
    assert (tmp_path / "arm.urdf.xacro").read_text() == "mine"


@pytest.mark.parametrize("name", ["../out", "My Robot", "a/b", ".hidden"])
def test_a_bad_name_makes_nothing(tmp_path: Path, name: str):
    for make in (make_package, make_file):
        with pytest.raises(NotMadeError, match="A package name"):
            make(tmp_path / "inner", name, b"<robot/>")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_may_not_be_written_is_said_and_nothing_is_left():
    with open_folder() as folder:
        folder.chmod(0o555)
        with unprivileged():
            for make in (make_package, make_file):
                with pytest.raises(NotMadeError, match="Permission denied"):
                    make(folder, "rover", b"<robot/>")
        assert list(folder.iterdir()) == []


def test_a_text_of_tags_without_end_is_kept_as_fast_as_any_other(tmp_path: Path):
    text = b"<robot>" + b"<link " * 150_000
    file = make_package(tmp_path, "rover", text)
    assert file.read_bytes() == text
