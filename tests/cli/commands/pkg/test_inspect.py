from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import studio
from tests.support.seeded_packages import interface_package, sound

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(autouse=True)
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("STUDIO_DATA_DIR", str(tmp_path / "data"))
    interface_package(tmp_path / "src")
    sound(tmp_path / "src", "radio", "ament_python", "rclpy", "radio_station_interfaces")
    monkeypatch.chdir(tmp_path)
    return tmp_path / "src"


def test_packages_are_listed_with_what_they_hold_and_need():
    assert studio("pkg", "inspect").out == (
        "radio (ament_python, radio): 1 executable; needs radio_station_interfaces\n"
        "radio_station_interfaces (ament_cmake, radio_station_interfaces): 1 interface\n"
    )


def test_one_package_is_told_in_full():
    ran = studio("pkg", "inspect", "radio")
    assert "  build type: ament_python\n" in ran.out
    assert "    rclpy (depend; ros)\n" in ran.out
    assert "    radio_station_interfaces (depend; workspace)\n" in ran.out
    assert "    talker: radio.talker:main\n" in ran.out


def test_a_folder_is_told_as_the_package_or_the_packages_that_it_is(
    monkeypatch: pytest.MonkeyPatch,
):
    assert studio("pkg", "inspect", ".").out == studio("pkg", "inspect").out
    in_full = studio("pkg", "inspect", "radio").out
    assert studio("pkg", "inspect", "src/radio").out.splitlines()[:2] == in_full.splitlines()[:2]
    monkeypatch.chdir("src/radio")
    assert "    talker: radio.talker:main\n" in studio("pkg", "inspect", ".").out


def test_it_is_also_json():
    whole = json.loads(studio("pkg", "inspect", "--json").out)
    assert [one["name"] for one in whole["packages"]] == ["radio", "radio_station_interfaces"]
    one = json.loads(studio("pkg", "inspect", "radio", "--json").out)
    assert one["executables"][0]["place"] == "radio.talker:main"


def test_an_unknown_package_or_an_empty_folder_is_a_sentence(tmp_path: Path):
    ran = studio("pkg", "inspect", "no_such")
    assert (ran.code, ran.out) == (2, "")
    assert "no_such" in ran.err
    (tmp_path / "empty").mkdir()
    assert "holds no package" in studio("pkg", "inspect", "--folder", "empty").out
