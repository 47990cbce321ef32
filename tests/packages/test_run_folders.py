"""Which files may be run: those of the folders of --allow-run, and nothing that others brought."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from studio.errors import NotRunnableError
from studio.packages.run_folders import RunFolders, is_launch_file, is_program

if TYPE_CHECKING:
    from pathlib import Path


def made(path: Path, text: str = "") -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def test_without_a_folder_nothing_may_be_run(tmp_path: Path):
    allowed = RunFolders()
    assert not allowed.is_on
    with pytest.raises(NotRunnableError, match=f"--allow-run {tmp_path}"):
        allowed.resolve(made(tmp_path / "a.py"))


def test_a_file_of_the_folder_may_be_run_and_no_other(tmp_path: Path):
    allowed = RunFolders([tmp_path / "ws"], tmp_path / "data")
    inside, outside = made(tmp_path / "ws/a/b.py"), made(tmp_path / "ws_two/b.py")
    assert allowed.resolve(inside) == inside
    assert allowed.folder_of(inside) == tmp_path / "ws"
    for path in (outside, tmp_path / "ws/../ws_two/b.py", tmp_path, "/", "", "a\0b"):
        assert not allowed.allows(path), path


def test_a_link_out_of_the_folder_is_followed_first(tmp_path: Path):
    allowed = RunFolders([tmp_path / "ws"])
    target = made(tmp_path / "elsewhere/b.py")
    (tmp_path / "ws").mkdir()
    (tmp_path / "ws/link.py").symlink_to(target)
    (tmp_path / "ws/folder").symlink_to(target.parent)
    assert not allowed.allows(tmp_path / "ws/link.py")
    assert not allowed.allows(tmp_path / "ws/folder/b.py")


def test_a_folder_that_is_itself_a_link_counts_as_where_it_leads(tmp_path: Path):
    file = made(tmp_path / "real/b.py")
    (tmp_path / "ws").symlink_to(tmp_path / "real")
    assert RunFolders([tmp_path / "ws"]).resolve(tmp_path / "ws/b.py") == file


@pytest.mark.parametrize("name", ["uploads/x", "untitled/u", "from_ros/r", "class-8765/ada/1"])
def test_what_was_unpacked_pasted_received_or_copied_is_never_run(tmp_path: Path, name: str):
    data = tmp_path / "data"
    allowed = RunFolders([tmp_path, data, data / name], data)
    file = made(data / name / "launch/a.launch.py")
    with pytest.raises(NotRunnableError, match="archive"):
        allowed.resolve(file)
    assert not allowed.may_edit(file)
    assert not allowed.may_edit(data / name / "new.py")


def test_robots_that_the_owner_made_in_the_data_folder_may_be_run(tmp_path: Path):
    data = tmp_path / "data"
    allowed = RunFolders([data / "robots"], data)
    assert allowed.allows(made(data / "robots/mine/launch/a.launch.py"))


def test_what_is_not_there_is_said(tmp_path: Path):
    with pytest.raises(NotRunnableError, match="not there"):
        RunFolders([tmp_path]).resolve(tmp_path / "gone.py")


@pytest.mark.parametrize(
    ("name", "is_one"),
    [
        ("a.launch.py", True),
        ("view_launch.py", True),
        ("a.launch.xml", True),
        ("a.launch.yaml", True),
        ("a.launch", True),
        ("launch/a.xml", True),
        ("launch/a.yml", True),
        ("launch/more/a.yaml", True),
        ("config/a.yaml", False),
        ("package.xml", False),
        ("launch/readme.md", False),
        ("launcher.py", False),
    ],
)
def test_launch_files_are_known_by_their_names(tmp_path: Path, name: str, is_one: bool):
    assert is_launch_file(tmp_path / name) is is_one


@pytest.mark.parametrize("name", ["a.py", "A.PY", "setup.cfg", "run.sh", "a.launch.xml", "x.pth"])
def test_programs_are_edited_only_where_they_may_be_run(tmp_path: Path, name: str):
    assert is_program(tmp_path / name)
    assert not RunFolders([tmp_path / "ws"]).may_edit(made(tmp_path / name))
    assert RunFolders([tmp_path]).may_edit(made(tmp_path / name))


def test_texts_that_nobody_runs_are_no_programs_though_they_bear_the_bit(tmp_path: Path):
    robot, script = made(tmp_path / "arm.urdf.xacro"), made(tmp_path / "node")
    for one in (robot, script):
        one.chmod(0o755)
    assert not is_program(robot)
    assert RunFolders().may_edit(robot)
    assert is_program(script)
    assert not RunFolders().may_edit(script)


@pytest.mark.parametrize(
    ("name", "text", "is_one"),
    [
        ("node", "#!/usr/bin/env python3\n", True),
        ("node.pl", "#!/usr/bin/perl\n", True),
        ("node", "import rclpy\n", False),
        ("CMakeLists.txt", "", True),
        ("bringup.xml", "<launch/>", True),
        ("bringup.xml", '<?xml version="1.0"?>\n<!-- <robot> -->\n<launch name="a"/>', True),
        ("bringup.txt", "<launch/>", True),
        ("robot.xml", '<robot name="r"><launch/></robot>', False),
        ("robot.xml", "<!-- <launch> --><robot/>", False),
        ("bringup.yaml", "%YAML 1.2\n---\nlaunch:\n- node: {}\n", True),
        ("bringup.yml", '{"launch": []}', True),
        ("poses.yaml", "launcher: 1\nlaunch_delay: 2\narm:\n  relaunch: 3\n", False),
        ("poses.yaml", "\n" * 20_000, False),
    ],
)
def test_what_a_name_does_not_say_the_file_does(tmp_path: Path, name: str, text: str, is_one: bool):
    (tmp_path / name).write_text(text)
    assert is_program(tmp_path / name) is is_one


def test_a_pipe_is_not_waited_for(tmp_path: Path):
    os.mkfifo(tmp_path / "pipe")
    assert not is_program(tmp_path / "pipe")
