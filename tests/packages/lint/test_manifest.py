from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.seeded_packages import changed, codes, finding, mended, sound

if TYPE_CHECKING:
    from pathlib import Path

LICENSE = "  <license>MIT</license>\n"


@pytest.mark.parametrize("half", ["", "<", "<buildtool_depend>"])
def test_half_a_tag_of_the_course_becomes_a_whole_one(tmp_path: Path, half: str):
    # A listing of the course, S0:317
    package = sound(tmp_path, build_type="ament_cmake")
    whole = "<buildtool_depend>ament_cmake</buildtool_depend>"
    changed(package, "package.xml", whole, f"{half}ament_cmake/buildtool_depend>")
    mended(tmp_path, "package-xml-unopened-tag", "package.xml", 10)
    assert codes(tmp_path) == set()


def test_a_stray_tag_of_a_web_page_is_taken_out(tmp_path: Path):
    # A listing of the course, S1
    changed(sound(tmp_path), "package.xml", LICENSE, f"{LICENSE}</pre>\n")
    mended(tmp_path, "package-xml-stray-tag", "package.xml", 9)
    assert codes(tmp_path) == set()


def test_a_tag_with_a_blank_gets_its_underscore(tmp_path: Path):
    # A listing of the course, S1: all underscores were lost
    package = sound(tmp_path)
    changed(
        package, "package.xml", "<depend>std_msgs</depend>", "<exec depend>std_msgs</exec depend>"
    )
    mended(tmp_path, "package-xml-spaced-tag", "package.xml", 11)
    mended(tmp_path, "package-xml-spaced-tag", "package.xml", 11)
    assert codes(tmp_path) == set()


def test_a_name_with_a_slash_loses_it(tmp_path: Path):
    changed(
        sound(tmp_path), "package.xml", "<depend>std_msgs</depend>", "<depend>std_msgs/</depend>"
    )
    mended(tmp_path, "package-xml-bad-name", "package.xml", 11)
    assert codes(tmp_path) == set()


@pytest.mark.parametrize("line", ["  <license>MIT</license>\n", "  <version>0.0.0</version>\n"])
def test_what_every_package_has_is_missed(tmp_path: Path, line: str):
    changed(sound(tmp_path), "package.xml", line, "")
    finding(tmp_path, "package-xml-lacks", "package.xml")


def test_what_is_still_to_do_is_no_error(tmp_path: Path):
    changed(sound(tmp_path), "package.xml", "MIT", "TODO: License declaration")
    one = finding(tmp_path, "package-xml-todo", "package.xml", 8)
    assert one.severity == "info"


def test_a_misspelt_tag_is_mended_and_a_broken_file_is_one_sentence(tmp_path: Path):
    package = sound(tmp_path)
    changed(package, "package.xml", "<depend>std_msgs</depend>", "<dependd>std_msgs</dependd>")
    mended(tmp_path, "package-xml-unknown-tag", "package.xml", 11)
    changed(package, "package.xml", "</package>", "")
    finding(tmp_path, "package-xml-broken", "package.xml")


def test_a_dependency_said_twice_goes(tmp_path: Path):
    changed(
        sound(tmp_path),
        "package.xml",
        "  <depend>std_msgs</depend>\n",
        "  <depend>std_msgs</depend>\n" * 2,
    )
    mended(tmp_path, "package-xml-repeated", "package.xml", 12)


def test_a_version_and_an_address_have_a_form(tmp_path: Path):
    package = sound(tmp_path)
    changed(package, "package.xml", "0.0.0", "1")
    changed(package, "package.xml", "ada@example.com", "ada")
    finding(tmp_path, "package-xml-version", "package.xml", 5)
    finding(tmp_path, "package-xml-maintainer", "package.xml", 7)


def test_a_bomb_of_entities_is_refused(tmp_path: Path):
    package = sound(tmp_path)
    bomb = (
        '<?xml version="1.0"?><!DOCTYPE a [<!ENTITY b "c">]><package><name>my_pkg</name></package>'
    )
    (package / "package.xml").write_text(bomb)
    assert codes(tmp_path) <= {"package-xml-broken"}


def test_a_file_that_is_too_large_is_one_sentence(tmp_path: Path):
    package = sound(tmp_path)
    text = (package / "package.xml").read_text()
    (package / "package.xml").write_text(text + "<!-- " + "a" * (1 << 20) + " -->")
    finding(tmp_path, "package-xml-unreadable", "package.xml")
