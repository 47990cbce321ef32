from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.command_line import studio

SETUP = """\
from setuptools import setup
import os
os.system("touch ran")
setup(name="own_pkg", entry_points={"console_scripts": [
    "node_helloworld = own_pkg.node_helloworld:main",
    "topic_helloworld_pub = own_pkg.topic_helloworld_pub:main",
]})
"""


@pytest.fixture(autouse=True)
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("STUDIO_DATA_DIR", str(tmp_path / "data"))
    package = tmp_path / "src" / "own_pkg"
    package.mkdir(parents=True)
    (package / "package.xml").write_text(
        "<package><name>own_pkg</name><version>1.2.3</version><depend>rclpy</depend>"
        "<depend>std_msgs</depend></package>"
    )
    (package / "setup.py").write_text(SETUP)
    monkeypatch.chdir(tmp_path)
    return package


def test_k3_packages_of_opened_folders_are_listed():
    listed = studio("pkg", "list").out.split()
    assert {"own_pkg", "rover_description"} <= set(listed)
    assert listed == sorted(listed)


def test_k5_entry_points_are_listed_and_nothing_is_run(workspace: Path, tmp_path: Path):
    listed = studio("pkg", "executables", "own_pkg").out
    assert listed == "own_pkg node_helloworld\nown_pkg topic_helloworld_pub\n"
    assert not (tmp_path / "ran").exists()
    assert not (workspace / "ran").exists()
    (workspace / "setup.py").unlink()
    (workspace / "setup.cfg").write_text(
        "[options.entry_points]\nconsole_scripts =\n    other = own_pkg.other:main\n"
    )
    assert studio("pkg", "executables", "own_pkg").out == "own_pkg other\n"
    assert studio("pkg", "executables", "own_pkg", "--full-path").out == "own_pkg.other:main\n"


def test_a_manifest_and_its_tags_are_printed(workspace: Path):
    assert studio("pkg", "xml", "own_pkg").out == (workspace / "package.xml").read_text() + "\n"
    assert studio("pkg", "xml", "own_pkg", "-t", "depend").out == "rclpy\nstd_msgs\n"
    assert studio("pkg", "xml", "own_pkg", "-t", "none").code == 1
    assert studio("pkg", "prefix", "own_pkg").out == f"{workspace}\n"


def test_only_a_workspace_is_searched_not_whatever_folder_one_stands_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    for below in ("one", "deep/down/two"):
        package = tmp_path / "downloads" / below
        package.mkdir(parents=True)
        (package / "package.xml").write_text(f"<package><name>{package.name}</name></package>")
    monkeypatch.chdir(tmp_path / "downloads")
    listed = studio("pkg", "list").out.split()
    assert "one" in listed
    assert "two" not in listed
    monkeypatch.chdir(tmp_path / "downloads" / "deep")
    assert "one" not in studio("pkg", "list").out.split()


@pytest.mark.parametrize("verb", ["xml", "prefix", "executables"])
def test_an_unknown_package_is_one_sentence(verb: str):
    ran = studio("pkg", verb, "no_such")
    assert (ran.code, ran.out) == (2, "")
    assert "no_such" in ran.err


@pytest.mark.parametrize("setup", ["def (", "x" * 2_000_000, "(" * 5_000, "\0", '{"a": 1}'])
def test_a_broken_setup_file_names_nothing(workspace: Path, setup: str):
    (workspace / "setup.py").write_text(setup)
    ran = studio("pkg", "executables", "own_pkg")
    assert (ran.code, ran.out) == (0, "")


def test_every_package_that_is_listed_has_a_prefix_and_a_manifest():
    for name in ("turtlesim", "demo_nodes_py", "robot_state_publisher", "rover_demo"):
        assert name in studio("pkg", "list").out.split()
        prefix = studio("pkg", "prefix", name)
        assert (prefix.code, Path(prefix.out.strip()).is_dir()) == (0, True)
        assert studio("pkg", "xml", name, "-t", "name").out == f"{name}\n"
    assert "turtle_teleop_key" in studio("pkg", "xml", "turtlesim", "-t", "description").out
    assert studio("pkg", "prefix", "no_such").code == 2
