from __future__ import annotations

import time
from typing import TYPE_CHECKING

import pytest

from studio.packages import lint
from studio.packages.inspection.inspecting import PackagesFound
from studio.packages.lint.package_checks import ALIKE_AT_MOST, check_packages
from studio.problems import whys
from studio.settings import repository_or_wheel
from tests.support.packages import write_package
from tests.support.seeded_packages import KNOWN, codes, problems, sound, written

if TYPE_CHECKING:
    from pathlib import Path

SECONDS_MAX = 12.0
BOMBS = {
    "my_pkg/names.py": "".join(f"unknown_name_{n}.attribute_{n}\n" for n in range(25_000)),
    "my_pkg/words.py": "import rclpy\n" + "".join(f"rclpy.spinn{n}()\n" for n in range(25_000)),
    "my_pkg/deep.py": "x = " + "-" * 90 + "1\nif " + " and ".join(["a"] * 50_000) + ":\n    pass\n",
    "README.md": "ros2 topic ros2 service a/msg/" * 30_000,
    "run.sh": "ros2 launch " + "a" * 900_000 + "!",
    "msg/A.msg": "a b  c d  " * 190 + "!\n" + "int32 a int32 b\n" * 10_000,
    "launch/a.launch.xml": "<node pkg='robot_stat' exec='a+b' " * 25_000,
    "package.xml": "<package>" + "<depend>rclpyy</depend>" * 4_000 + "</package>",
    "setup.py": "from setuptools import setup\nsetup(entry_points={'console_scripts': ["
    + "'a = b = c.d:e', " * 20_000
    + "]})\n",
    "CMakeLists.txt": "rosidl_generate_interfaces(${PROJECT_NAME})\n" * 15_000,
}


@pytest.mark.parametrize("file", BOMBS)
def test_a_hostile_file_takes_a_bounded_time(tmp_path: Path, file: str):
    package = sound(tmp_path)
    written(package, file, BOMBS[file])
    before = time.perf_counter()
    found = problems(tmp_path)
    assert time.perf_counter() - before < SECONDS_MAX
    assert len(found) < 1_000


def test_many_alike_are_cut_with_a_sentence(tmp_path: Path):
    for number in range(ALIKE_AT_MOST + 5):
        write_package(tmp_path / f"p{number}")
    found = [one for one in problems(tmp_path) if one.code == "build-file-missing"]
    assert len(found) == ALIKE_AT_MOST + 1
    assert "5 times more" in found[-1].sentence


def test_packages_of_ros_1_keep_to_other_rules(tmp_path: Path):
    text = "<package><name>old</name><buildtool_depend>catkin</buildtool_depend></package>"
    written(tmp_path / "old", "package.xml", text)
    assert codes(tmp_path) == set()


def test_one_package_is_checked_alone(tmp_path: Path):
    for name in ("a_pkg", "b_pkg"):
        (sound(tmp_path, name) / "setup.cfg").unlink()
    (one,) = check_packages(PackagesFound(tmp_path), KNOWN, ["b_pkg"])
    assert one.place is not None
    assert "b_pkg" in one.place.file


def test_the_models_of_the_studio_have_no_fault():
    assert problems(repository_or_wheel("models")) == ()


def test_every_code_says_why_in_both_languages():
    for code, why in whys(lint).items():
        assert set(why) == {"en", "de"}, code
        assert all(len(text.split()) > 3 and text.endswith(".") for text in why.values()), code
