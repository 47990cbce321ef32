from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.errors import LaunchNotFoundError
from studio.launch.finding import find_launch_file
from tests.support.launch_files import index_of, package_at

if TYPE_CHECKING:
    from pathlib import Path


def test_a_launch_file_is_found_by_package_and_name_or_by_its_path(tmp_path: Path):
    folder = package_at(tmp_path, "mine", {"launch/a.launch.py": "x", "launch/b_launch.py": "x"})
    index = index_of(tmp_path)
    file = folder / "launch" / "a.launch.py"
    assert find_launch_file(index, ["mine", "a.launch.py"]) == file
    assert find_launch_file(index, ["mine", "b_launch.py"]) == folder / "launch" / "b_launch.py"
    assert find_launch_file(index, [str(file)]) == file


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["mine"], r"mine is a package: name its launch file, too \(it has a.launch.py\)"),
        (["mine", "a.lunch.py"], "did you mean a.launch.py"),
        (["mine", "bringup.launch.py"], "name one of these"),
        (["mime", "a.launch.py"], "did you mean mine"),
        (["talker"], "talker is a node, and what is launched is a launch file"),
        (["mine", "talker"], "talker is an executable of mine, not a launch file: studio run"),
        (["no/such.launch.py"], "there is no such launch file"),
        (["whatever"], '"whatever" is no launch file and no package'),
    ],
)
def test_what_is_not_found_says_what_there_is_instead(
    tmp_path: Path, words: list[str], sentence: str
):
    package_at(tmp_path, "mine", {"launch/a.launch.py": "x", "mine/talker.py": ""}, "talker")
    with pytest.raises(LaunchNotFoundError, match=sentence):
        find_launch_file(index_of(tmp_path), words)


def test_two_files_of_a_name_are_told_apart_by_their_path(tmp_path: Path):
    package_at(tmp_path, "mine", {"x/a.launch.py": "x", "y/a.launch.py": "x"})
    with pytest.raises(LaunchNotFoundError, match=r"several files a\.launch\.py"):
        find_launch_file(index_of(tmp_path), ["mine", "a.launch.py"])
