"""Files and folders checked as `studio check` does, with real workers."""

from __future__ import annotations

import asyncio
import os
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from studio.documents.check_run import CheckedFile, check_path
from studio.errors import PackageError
from studio.problems import Severity
from studio.settings import Settings
from tests.support.broken_snippet import PRINTED
from tests.support.corpus import corpus
from tests.support.packages import write_package

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


NAMESPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
FRAGMENT = f"""<robot name="camera" {NAMESPACE}>
  <joint name="mount" type="fixed"><parent link="chassis"/><child link="camera"/></joint>
  <link name="camera"/>
</robot>"""


def including(*names: str, inner: str = '<link name="chassis"/>') -> str:
    includes = "".join(f'<xacro:include filename="{name}"/>' for name in names)
    return f'<robot name="whole" {NAMESPACE}>{inner}{includes}</robot>'


def package(folder: Path, **texts: str) -> Path:
    files = {f"urdf/{name}.xacro": text for name, text in texts.items()}
    return write_package(folder / "ws" / "r_description", files=files)


def names(files: list[CheckedFile]) -> list[str]:
    return sorted(file.path.stem for file in files)


def test_a_fragment_that_another_file_includes_is_checked_with_that_file_only(tmp_path: Path):
    texts = {"robot": including("camera.xacro"), "camera": FRAGMENT}
    files = check(package(tmp_path, **texts), tmp_path / "data")
    assert names(files) == ["robot"]
    assert not files[0].has_errors
    (alone,) = check(tmp_path / "ws/r_description/urdf/camera.xacro", tmp_path / "data")
    assert "dangling-parent" in codes(alone)


def test_files_that_include_each_other_are_checked_as_one_robot(tmp_path: Path):
    texts = {"one": including("two.xacro"), "two": including("one.xacro")}
    files = check(package(tmp_path, **texts), tmp_path / "data")
    assert [codes(file)[0] for file in files] == ["include-recursion"]


def test_what_a_robot_might_include_and_does_not_is_checked_when_it_is_whole(tmp_path: Path):
    choice = (
        '<xacro:arg name="kind" default="none"/><xacro:if value="${\'$(arg kind)\' == \'%s\'}">'
    )
    inner = "".join(
        f'{choice % one}<xacro:include filename="{one}.xacro"/></xacro:if>'
        for one in ("whole", "camera")
    )
    texts = {
        "robot": including(inner=f'<link name="chassis"/>{inner}'),
        "whole": f'<robot name="w" {NAMESPACE}><link name="a"/></robot>',
        "camera": FRAGMENT,
    }
    files = check(package(tmp_path, **texts), tmp_path / "data")
    assert names(files) == ["robot", "whole"]


def test_types_that_cannot_be_used_are_told_once_and_of_packages_below_the_path_only(
    tmp_path: Path,
):
    robots = {f"urdf/r{n}.urdf": GOOD for n in range(3)}
    mine = write_package(
        tmp_path / "ws" / "mine", files={**robots, "msg/Bad.msg": "uint8 a\nuint8 a\n"}
    )
    write_package(tmp_path / "ws" / "other", files={"msg/Bad.msg": "uint8 b\nuint8 b\n"})
    files = check(mine, tmp_path / "data")
    told = [one for file in files for one in file.problems if one.code == "unusable-interfaces"]
    assert [one.place and one.place.file.endswith("mine/msg/Bad.msg") for one in told] == [True]
    (single,) = check(mine / "urdf" / "r0.urdf", tmp_path / "data")
    assert "unusable-interfaces" not in codes(single)
    everything = check(tmp_path / "ws", tmp_path / "data")
    assert [code for file in everything for code in codes(file)].count("unusable-interfaces") == 2


def test_a_robot_after_another_in_the_same_process_is_as_if_it_were_alone(tmp_path: Path):
    robots = {
        f"r{n}": f'<robot name="r{n}" {NAMESPACE}><link name="a{n}" nme="1"/></robot>'
        for n in range(12)
    }
    files = check(package(tmp_path, **robots), tmp_path / "data")
    assert len(files) == 12
    for file in files[::5]:
        (alone,) = check(file.path, tmp_path / "data")
        assert alone.problems == file.problems


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """How many processes of each module were started since."""
    counts: Counter[str] = Counter()
    start = asyncio.create_subprocess_exec

    async def counted(*command: str, **options: Any) -> asyncio.subprocess.Process:  # noqa: ANN401
        counts[command[command.index("-m") + 1]] += 1
        return await start(*command, **options)

    monkeypatch.setattr(asyncio, "create_subprocess_exec", counted)
    return counts


def assert_workers_were_used_again(started: Counter[str]) -> None:
    assert 1 <= started["studio.description.worker"] <= (os.cpu_count() or 1) + 2
    assert started["studio.robot.worker"] <= 2  # meshes, and yourdfpy


def test_named_poses_beside_a_robot_cost_a_check_no_process(tmp_path: Path, started: Counter[str]):
    texts = {
        f"r{n}": f'<robot name="r{n}" {NAMESPACE}><link name="a{n}"/></robot>' for n in range(12)
    }
    folder = package(tmp_path, **texts)
    states = '<group_state name="home" group="all"><joint name="j" value="0"/></group_state>'
    for n in range(12):
        srdf = folder / "config" / f"r{n}.srdf.xacro"
        srdf.parent.mkdir(exist_ok=True)
        srdf.write_text(f'<robot name="r{n}" {NAMESPACE}>{states}</robot>')
    assert len(check(folder, tmp_path / "data")) == 12
    assert_workers_were_used_again(started)


def test_meshes_are_told_in_the_order_of_the_links_whichever_failed_first(tmp_path: Path):
    file = tmp_path / "robots" / "r.urdf"
    file.parent.mkdir()
    (file.parent / "unread.stl").write_text("this takes a worker to find out")
    links = "".join(
        f'<link name="{name}"><visual><geometry><mesh filename="{name}.stl"/></geometry></visual>'
        "</link>"
        for name in ("unread", "gone")
    )
    file.write_text(f'<robot name="r">{links}</robot>')
    (checked,) = check(file, tmp_path / "data")
    told = [one.sentence for one in checked.problems if one.code == "mesh"]
    named = [Path(sentence.split()[1].rstrip(":")).name for sentence in told]
    assert named == ["unread.stl", "gone.stl"]


def test_real_repositories_are_checked_by_few_processes(tmp_path: Path, started: Counter[str]):
    """Their arms have SRDFs beside them; their robots share files and meshes."""
    files = check(corpus(), tmp_path / "data")
    assert len(files) > 90
    assert_workers_were_used_again(started)
