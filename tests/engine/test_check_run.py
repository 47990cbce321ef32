"""Files and folders checked as `studio check` does, with real workers."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.engine.check_run import CheckedFile, check_path
from studio.errors import PackageError
from studio.problems import Severity
from studio.settings import Settings
from tests.support.broken_snippet import PRINTED
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path


GOOD = '<robot name="r"><link name="a"/></robot>'
XACRO = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="n" default="1"/>
  <xacro:property name="old" value="1"/>
  <link name="a"/>
  <xacro:if value="${'$(arg n)' == '2'}"><link name="b"/></xacro:if>
</robot>
"""


def check(path: Path, data: Path, **arguments: str) -> list[CheckedFile]:
    data.mkdir(exist_ok=True)
    told: list[tuple[int, int]] = []
    found = asyncio.run(
        check_path(
            Settings(data_folder=data), path, arguments, lambda _, n, all_: told.append((n, all_))
        )
    )
    assert told[-1] == (len(found), len(found))
    return found


def codes(file: CheckedFile) -> list[str]:
    return [problem.code for problem in file.problems]


def test_a_file_is_checked_as_the_page_does(tmp_path: Path):
    file = tmp_path / "robots" / "d4.urdf"
    file.parent.mkdir()
    file.write_text(PRINTED)
    (checked,) = check(file, tmp_path / "data")
    hinders = [one.code for one in checked.problems if one.severity is not Severity.INFO]
    assert hinders == ["xml-open-element", "dangling-parent", "dangling-child"]
    assert checked.has_errors
    assert checked.is_readable
    assert file.read_text() == PRINTED


def test_arguments_are_passed_on(tmp_path: Path):
    file = tmp_path / "robots" / "r.xacro"
    file.parent.mkdir()
    file.write_text(XACRO)
    (plain,) = check(file, tmp_path / "data")
    assert "unused-property" in codes(plain)
    assert "several-roots" not in codes(plain)
    (given,) = check(file, tmp_path / "data", n="2")
    assert "several-roots" in codes(given)


def test_a_robot_that_needs_an_argument_is_no_error_but_a_misspelt_one_is(tmp_path: Path):
    file = tmp_path / "robots" / "r.xacro"
    file.parent.mkdir()
    file.write_text(XACRO.replace('<link name="a"/>', '<link name="$(arg needed)"/>'))
    (waiting,) = check(file, tmp_path / "data")
    assert [(one.code, one.severity) for one in waiting.problems] == [
        ("undefined-argument", Severity.WARNING)
    ]
    assert waiting.problems[0].sentence.endswith("pass needed:=value. It was not checked.")
    (given,) = check(file, tmp_path / "data", needed="a")
    assert not given.has_errors
    file.write_text(XACRO.replace('name="n" default', 'name="side" default'))
    file.write_text(file.read_text().replace("$(arg n)", "$(arg sid)"))
    (misspelt,) = check(file, tmp_path / "data")
    assert misspelt.has_errors


def test_a_folder_is_every_robot_of_it_that_can_be_opened(tmp_path: Path):
    package = write_package(
        tmp_path / "ws" / "r_description",
        files={
            "urdf/r.urdf": GOOD,
            "urdf/broken.urdf": PRINTED,
            "urdf/macros.xacro": '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">'
            '<xacro:macro name="m"/></robot>',
        },
    )
    files = check(package, tmp_path / "data")
    assert {file.path.name: file.has_errors for file in files} == {
        "r.urdf": False,
        "broken.urdf": True,
    }


def test_what_cannot_be_read_is_told(tmp_path: Path):
    empty = tmp_path / "robots" / "empty.urdf"
    empty.parent.mkdir()
    empty.write_text("")
    (checked,) = check(empty, tmp_path / "data")
    assert not checked.is_readable
    for path in (tmp_path / "gone.urdf", tmp_path / "data"):
        with pytest.raises(PackageError):
            check(path, tmp_path / "data")
