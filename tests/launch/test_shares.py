from __future__ import annotations

import os
from typing import TYPE_CHECKING

from studio.launch.shares import Shares, real_paths, why_not_installed
from studio.packages.shares import installed_files
from tests.support.launch_files import index_of, package_at

if TYPE_CHECKING:
    from pathlib import Path


def test_a_package_whose_files_install_where_they_lie_is_its_own_share(tmp_path: Path):
    folder = package_at(tmp_path, "mine", {"launch/a.launch.py": "x"})
    assert Shares(index_of(tmp_path), tmp_path).share_of("mine") == folder


def test_files_that_move_are_linked_where_they_would_be(tmp_path: Path):
    folder = package_at(tmp_path, "mine", {"urdf/r.urdf": "x", "launch/a.launch.py": "y"})
    share = Shares(index_of(tmp_path), tmp_path).share_of("mine")
    assert share != folder
    assert os.path.realpath(share / "r.urdf") == str(folder / "urdf" / "r.urdf")
    assert (share / "launch" / "a.launch.py").read_text() == "y"
    assert real_paths(f"-d {share}/r.urdf") == f"-d {folder}/urdf/r.urdf"


def test_what_cmake_installs_is_read(tmp_path: Path):
    folder = package_at(tmp_path, "mine", {"launch/a.launch.py": "x", "cfg/b.yaml": "x"})
    (folder / "setup.py").unlink()
    (folder / "CMakeLists.txt").write_text(
        "install(DIRECTORY launch\n  DESTINATION share/${PROJECT_NAME})\n"
        "install(FILES cfg/b.yaml DESTINATION share/${PROJECT_NAME}/config)\n"
    )
    assert sorted(installed_files(folder, "mine")) == [
        ("config/b.yaml", "cfg/b.yaml"),
        ("launch/a.launch.py", "launch/a.launch.py"),
    ]


def test_a_file_that_is_not_installed_is_a_sentence_with_the_mend(tmp_path: Path):
    folder = package_at(tmp_path, "mine", {"launch/a.launch.py": "x", "other/b.launch.py": "x"})
    assert why_not_installed(folder / "launch" / "a.launch.py") == ""
    assert (
        "add ('share/' + package_name + '/other', glob('other/*.launch.py')) to data_files in"
        in (why_not_installed(folder / "other" / "b.launch.py"))
    )
    (folder / "setup.py").unlink()
    (folder / "CMakeLists.txt").write_text("")
    assert "add install(DIRECTORY other DESTINATION" in (
        why_not_installed(folder / "other" / "b.launch.py")
    )


def test_the_mend_of_a_file_in_the_root_names_the_file_alone(tmp_path: Path):
    folder = package_at(tmp_path, "mine", {"up.launch.py": "x"})
    assert why_not_installed(folder / "up.launch.py").endswith(
        ": add ('share/' + package_name, ['up.launch.py']) to data_files in setup.py"
    )
    (folder / "setup.py").unlink()
    (folder / "CMakeLists.txt").write_text("")
    assert "add install(FILES up.launch.py DESTINATION share/${PROJECT_NAME})" in (
        why_not_installed(folder / "up.launch.py")
    )


def test_the_mend_says_what_its_row_needs(tmp_path: Path):
    folder = package_at(tmp_path, "mine", {"other/b.launch.py": "x"})
    (folder / "setup.py").write_text("from setuptools import setup\nsetup(name='mine')\n")
    assert why_not_installed(folder / "other" / "b.launch.py").endswith(
        ": write from glob import glob at the top of setup.py, and add ('share/mine/other', "
        "glob('other/*.launch.py')) to its data_files"
    )
