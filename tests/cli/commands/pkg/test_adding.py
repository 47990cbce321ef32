from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import studio
from tests.support.seeded_packages import codes, sound

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(autouse=True)
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("STUDIO_DATA_DIR", str(tmp_path / "data"))
    made = sound(tmp_path / "src")
    monkeypatch.chdir(made)
    return made


def test_a_node_and_a_launch_file_are_written_with_their_entries(package: Path):
    ran = studio("pkg", "add", "node", "hear", "--template", "subscriber")
    assert (ran.code, ran.err) == (0, "")
    assert ran.out == "written: my_pkg/hear.py\nwritten: setup.py\n"
    ran = studio("pkg", "add", "launch", "up", "--node", "my_pkg", "hear", "--format", "xml")
    assert ran.out.startswith("written: launch/up.launch.xml\n")
    assert codes(package.parent) == set()


def test_interfaces_are_added_to_a_package_of_cmake(tmp_path: Path):
    sound(tmp_path / "src", "my_interfaces", "ament_cmake")
    text = tmp_path / "text"
    text.write_text("string a\n---\nstring b\n")
    line = ("srv", "Ask", "--package", "../my_interfaces", "--text", str(text))
    assert studio("pkg", "add", *line).code == 0
    assert codes(tmp_path / "src") == set()
    refused = studio("pkg", "add", "msg", "Quote")
    assert (refused.code, refused.out) == (2, "")
    assert "my_pkg_interfaces" in refused.err


def test_what_is_to_be_written_by_hand_is_told(package: Path):
    (package / "setup.py").write_text("setup(")
    ran = studio("pkg", "add", "node", "hear")
    assert ran.code == 1
    assert "written: my_pkg/hear.py" in ran.out
    assert "'hear = my_pkg.hear:main' in console_scripts" in ran.out


def test_outside_of_packages_it_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    ran = studio("pkg", "add", "node", "hear")
    assert (ran.code, ran.out) == (2, "")
    assert "--package" in ran.err
