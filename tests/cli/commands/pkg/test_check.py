from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import studio
from tests.support.seeded_packages import changed, sound, written

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(autouse=True)
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("STUDIO_DATA_DIR", str(tmp_path / "data"))
    made = sound(tmp_path / "src")
    monkeypatch.chdir(tmp_path)
    return made


def test_a_sound_workspace_has_nothing_wrong():
    ran = studio("pkg", "check")
    assert (ran.code, ran.out, ran.err) == (0, "Nothing is wrong.\n", "")


def test_faults_are_listed_with_line_and_mend_and_mended(package: Path):
    changed(package, "setup.py", "talker:main", "talker:mains")
    changed(package, "package.xml", "<depend>std_msgs</depend>", "<depend>std_msgs/</depend>")
    (package / "setup.cfg").unlink()
    ran = studio("pkg", "check", "src")
    assert ran.code == 1
    assert "src/my_pkg/setup.py:22: error: " in ran.out
    assert "[Write std_msgs]" in ran.out
    assert ran.out.endswith("3 errors\n")
    assert "says nothing" not in studio("pkg", "check", "--why").out
    found = json.loads(studio("pkg", "check", "--json").out)
    assert {one["code"] for one in found} >= {"setup-cfg-missing", "package-xml-bad-name"}
    mended = studio("pkg", "check", "--fix")
    assert mended.code == 0
    assert mended.out.endswith("Nothing is wrong.\n")


def test_a_warning_is_no_error(package: Path):
    written(package, "launch/up.launch.py", "def generate_launch_description():\n    pass\n")
    ran = studio("pkg", "check", "src/my_pkg", "--why")
    assert ran.code == 0
    assert "what was installed, not the source" in ran.out


def test_no_folder_is_one_sentence():
    ran = studio("pkg", "check", "nowhere")
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.count("\n") == 1
