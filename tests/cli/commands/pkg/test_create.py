from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import studio

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("STUDIO_DATA_DIR", str(tmp_path / "data"))
    folder = tmp_path / "src"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder


def test_a_package_is_made_and_what_was_made_is_printed(here: Path):
    line = "--build-type ament_python --license MIT --node-name talker my_pkg --dependencies rclpy"
    ran = studio("pkg", "create", *line.split())
    assert ran.code == 0
    assert ran.out.startswith("going to create a new package\npackage name: my_pkg\n")
    assert "creating folder ./my_pkg\ncreating ./my_pkg/package.xml\n" in ran.out
    assert studio("pkg", "executables", "my_pkg").out == "my_pkg talker\n"
    assert studio("pkg", "xml", "my_pkg", "-t", "depend").out == "rclpy\n"
    assert (here / "my_pkg" / "LICENSE").is_file()


def test_a_licence_without_a_text_is_warned_of_and_names_are_listed(here: Path):
    assert (
        "[WARNING]: Unknown license 'Mine'"
        in studio("pkg", "create", "a_pkg", "--license", "Mine").out
    )
    assert not (here / "a_pkg" / "LICENSE").exists()
    assert "Apache-2.0\n" in studio("pkg", "create", "--license", "?").out
    assert "says where" in studio("pkg", "create", "b_pkg", "--license", "gpl-3.0-only").out


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("create Bad-Name", "small letters"),
        ("create --dependencies rclpy my_pkg", '"my_pkg" was taken for a dependency'),
        ("create", "needs the name"),
        ("create my_pkg --maintainer-email nobody", "no e-mail address"),
        ("create src --destination-directory ..", "something of that name"),
    ],
)
def test_what_cannot_be_made_is_one_sentence(here: Path, line: str, says: str):
    ran = studio("pkg", *line.split())
    assert (ran.code, ran.out) == (2, "")
    assert says in ran.err
    assert list(here.iterdir()) == []
