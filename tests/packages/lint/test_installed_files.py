from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.seeded_packages import codes, finding, mended, sound, written

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(
    "file", ["launch/up.launch.py", "urdf/r2d2.urdf.xml", "config/params.yaml", "srv/Old.srv"]
)
def test_a_folder_that_is_not_installed_is(tmp_path: Path, file: str):
    # A listing of the course, S0, S3:335
    package = sound(tmp_path)
    written(
        package, file, "def generate_launch_description():\n    pass\n" if ".py" in file else "\n"
    )
    mended(tmp_path, "folder-not-installed", "setup.py")
    assert "folder-not-installed" not in codes(tmp_path)


def test_a_launch_file_in_the_root_that_is_not_installed_is(tmp_path: Path):
    package = sound(tmp_path)
    written(package, "up.launch.py", "def generate_launch_description():\n    pass\n")
    mended(tmp_path, "launch-not-installed", "setup.py")
    assert "('share/' + package_name, ['up.launch.py'])" in (package / "setup.py").read_text()
    assert codes(tmp_path) == set()


def test_folders_are_installed(tmp_path: Path):
    package = sound(tmp_path, build_type="ament_cmake")
    written(package, "urdf/a.urdf", "<robot name='a'><link name='b'/></robot>")
    mended(tmp_path, "cmake-folder-not-installed", "CMakeLists.txt")
    assert codes(tmp_path) == set()
    (package / "urdf" / "a.urdf").unlink()
    (package / "urdf").rmdir()
    finding(tmp_path, "install-folder-missing", "CMakeLists.txt")


def test_the_sentence_has_the_line_that_is_missing(tmp_path: Path):
    package = sound(tmp_path)
    written(package, "config/a.yaml", "")
    written(package, "config/inner/b.yaml", "")
    sentence = finding(tmp_path, "folder-not-installed", "setup.py").sentence
    assert sentence == (
        "config/a.yaml is not installed, so ROS does not find it after the build: add ('share/' + "
        "package_name + '/config', ['config/a.yaml']) to data_files in setup.py."
    )


def test_notes_beside_launch_files_of_python_need_not_be_installed(tmp_path: Path):
    written(sound(tmp_path), "launch/README.md", "How to launch.\n")
    assert codes(tmp_path) == set()
