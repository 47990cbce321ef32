"""Descriptions from ROS are kept as files, whatever their text and their source are."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.errors import NotMadeError
from studio.packages.index import PackageIndex, load_choices, save_choices
from studio.packages.received_texts import FROM_ROS_FOLDER, choose_packages, keep_description
from studio.settings import SOURCE_SIZE_LIMIT_BYTES
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

ROBOT = '<robot name="r"><link name="a"/></robot>'


def test_a_description_is_kept_and_a_newer_one_takes_its_place(tmp_path: Path):
    file = keep_description(tmp_path, "/robot_description", ROBOT)
    assert file.read_text() == ROBOT
    newer = ROBOT.replace("a", "b")
    assert keep_description(tmp_path, "/robot_description", newer) == file
    assert file.read_text() == newer
    assert [one.name for one in file.parent.iterdir()] == ["robot_description.urdf"]


def test_the_same_text_again_touches_nothing(tmp_path: Path):
    file = keep_description(tmp_path, "/r", ROBOT)
    before = file.stat().st_mtime_ns, file.stat().st_ino
    keep_description(tmp_path, "/r", ROBOT)
    assert (file.stat().st_mtime_ns, file.stat().st_ino) == before


@pytest.mark.parametrize("source", ["/../../etc/passwd", "/", "a" * 4000, "/ns/robot\0x", "ü🤖"])
def test_no_source_leads_out_of_the_folder(tmp_path: Path, source: str):
    file = keep_description(tmp_path, source, ROBOT)
    assert (tmp_path / FROM_ROS_FOLDER).resolve() == file.resolve().parent.parent


def test_packages_that_an_open_robot_has_are_found_and_what_was_chosen_stays(tmp_path: Path):
    for name in ("arm", "wheels", "other"):
        write_package(tmp_path / name)
    index = PackageIndex((), {"arm": tmp_path / "arm", "wheels": tmp_path / "wheels"})
    text = ROBOT + "<!-- package://arm/a.stl package://wheels/b.stl package://missing/c.stl -->"
    file = keep_description(tmp_path, "/r", text)
    save_choices(tmp_path, file.parent, {"wheels": tmp_path / "other"})
    choose_packages(tmp_path, file, text, [index])
    found = load_choices(tmp_path, file.parent)
    assert found == {"arm": tmp_path / "arm", "wheels": tmp_path / "other"}


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "no <robot>"),
        ("hello", "no <robot>"),
        (ROBOT + " " * SOURCE_SIZE_LIMIT_BYTES, "too long"),
    ],
    ids=("nothing", "a word", "too long"),
)
def test_what_is_no_robot_is_refused(tmp_path: Path, text: str, reason: str):
    with pytest.raises(NotMadeError, match=reason):
        keep_description(tmp_path, "/robot_description", text)
    assert not (tmp_path / FROM_ROS_FOLDER).exists()
