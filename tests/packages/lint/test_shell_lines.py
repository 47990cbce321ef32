from __future__ import annotations

from typing import TYPE_CHECKING

from tests.support.seeded_packages import codes, finding, mended, sound, written

if TYPE_CHECKING:
    from pathlib import Path


def test_an_option_of_doctor_that_does_not_exist_is_mended(tmp_path: Path):
    # A listing of the course, S2:259
    written(sound(tmp_path), "README.md", "# a\n\n    ros2 doctor --include-dds\n")
    mended(tmp_path, "shell-doctor", "README.md", 3)
    assert codes(tmp_path) == set()


def test_a_type_is_named_without_its_ending(tmp_path: Path):
    # A listing of the course, S0:425
    line = "ros2 service call /a radio_station_interfaces/srv/GetNowPlaying.srv '{}'\n"
    written(sound(tmp_path), "run.sh", line)
    mended(tmp_path, "shell-type", "run.sh", 1)
    assert codes(tmp_path) == set()


def test_launch_takes_a_package_and_a_file(tmp_path: Path):
    # A listing of the course, S3:77
    written(
        sound(tmp_path),
        "README.md",
        "`ros2 launch <node_name>`\n\nros2 launch my_pkg up.launch.py\n",
    )
    finding(tmp_path, "shell-launch", "README.md", 1)


def test_the_build_is_run_in_the_workspace(tmp_path: Path):
    # A listing of the course, S3:117
    written(sound(tmp_path), "README.md", "```\ncd ~/ros2_ws/src\ncolcon build\n```\n")
    mended(tmp_path, "shell-colcon", "README.md", 3)
    assert codes(tmp_path) == set()


def test_run_names_executables_of_the_workspace(tmp_path: Path):
    written(sound(tmp_path), "README.md", "ros2 run my_pkg talker_node\nros2 run turtlesim any\n")
    mended(tmp_path, "shell-run", "README.md", 1)
    assert codes(tmp_path) == set()
