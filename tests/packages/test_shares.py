from __future__ import annotations

from typing import TYPE_CHECKING

from studio.packages.shares import installed_files, left_out, share_of
from studio.packages.sources.package_source import PackageSource
from tests.support.student_programs import python_package

if TYPE_CHECKING:
    from pathlib import Path


def test_files_that_install_to_where_they_lie_are_shared_by_the_package_itself(tmp_path: Path):
    folder = python_package(tmp_path / "src", "own_pkg", {})
    (folder / "launch").mkdir()
    (folder / "launch" / "a.launch.py").write_text("")
    assert share_of(folder, "own_pkg", lambda: tmp_path / "links") == folder
    assert not (tmp_path / "links").exists()


def test_files_that_install_elsewhere_are_links_in_a_folder_of_their_own(tmp_path: Path):
    folder = python_package(tmp_path / "src", "own_pkg", {})
    for name in ("urdf/robot.urdf", "launch/a.launch.py"):
        (folder / name).parent.mkdir()
        (folder / name).write_text(name)
    share = share_of(folder, "own_pkg", lambda: tmp_path / "links")
    assert (share / "robot.urdf").read_text() == "urdf/robot.urdf"
    assert (share / "launch" / "a.launch.py").read_text() == "launch/a.launch.py"
    assert (share / "robot.urdf").resolve() == folder / "urdf" / "robot.urdf"
    assert share.parent.name == "share"
    assert share_of(folder, "own_pkg", lambda: tmp_path / "links") == share


def test_what_cmake_installs_is_known(tmp_path: Path):
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "a.stl").write_text("")
    (tmp_path / "CMakeLists.txt").write_text(
        "install(DIRECTORY meshes DESTINATION share/${PROJECT_NAME})\n"
        "install(FILES other.txt DESTINATION share/${PROJECT_NAME}/config) # install(x)\n"
    )
    assert installed_files(tmp_path, "pkg") == [
        ("meshes/a.stl", "meshes/a.stl"),
        ("config/other.txt", "other.txt"),
    ]


def test_an_installed_share_folder_is_itself(tmp_path: Path):
    share = tmp_path / "share" / "pkg"
    share.mkdir(parents=True)
    assert share_of(share, "pkg", lambda: tmp_path / "links") == share


def test_files_without_build_files_are_where_most_packages_install_them(tmp_path: Path):
    (tmp_path / "robot" / "urdf").mkdir(parents=True)
    (tmp_path / "robot" / "urdf" / "a.urdf").write_text("")
    assert installed_files(tmp_path, "pkg") == [("urdf/a.urdf", "robot/urdf/a.urdf")]


def test_the_patterns_of_setup_py_are_those_of_the_package_alone(tmp_path: Path):
    (tmp_path / "up").mkdir()
    folder = tmp_path / "pkg"
    (folder / "b").mkdir(parents=True)
    (folder / "b" / "x.yaml").write_text("")
    (folder / "setup.py").write_text(
        "setup(data_files=[('share/pkg', glob('../*')), ('share/pkg', glob('/etc/*')),\n"
        "('share/pkg/b', glob('b/*')), ('share/pkg/c', ['gone.txt'])])"
    )
    assert installed_files(folder, "pkg") == [("b/x.yaml", "b/x.yaml"), ("c/gone.txt", "gone.txt")]
    source = PackageSource(folder)
    assert left_out(source, ["b/x.yaml", "b/deep/x.yaml"]) == ["b/deep/x.yaml"]


def test_what_a_build_computes_is_not_known(tmp_path: Path):
    files = ["launch/a.launch.py", "urdf/a.urdf"]
    (tmp_path / "setup.py").write_text("setup(data_files=rows())")
    assert left_out(PackageSource(tmp_path), files) == []
    (tmp_path / "setup.py").unlink()
    (tmp_path / "CMakeLists.txt").write_text("install(DIRECTORY launch DESTINATION share/p)")
    assert left_out(PackageSource(tmp_path), files) == ["urdf/a.urdf"]
