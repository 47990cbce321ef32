from __future__ import annotations

from typing import TYPE_CHECKING

from tests.support.seeded_packages import codes, finding, interface_package, mended, written

if TYPE_CHECKING:
    from pathlib import Path

FILE = "srv/GetNowPlaying.srv"


def test_several_fields_on_a_line_get_a_line_each(tmp_path: Path):
    # A listing of the course, S0:308
    package = interface_package(tmp_path)
    written(package, FILE, "---\nstring station string song_title string artist\n")
    mended(tmp_path, "interface-several-fields", "GetNowPlaying.srv", 2)
    assert (package / FILE).read_text() == "---\nstring station\nstring song_title\nstring artist\n"
    assert codes(tmp_path) == set()


def test_parts_that_are_missing_are_told_and_added(tmp_path: Path):
    # A listing of the course, S0:544: the feedback stood outside
    written(interface_package(tmp_path), FILE, "string station\n")
    mended(tmp_path, "interface-parts", "GetNowPlaying.srv", 1)
    assert codes(tmp_path) == set()


def test_a_part_too_many_is_told_at_its_line(tmp_path: Path):
    written(interface_package(tmp_path), FILE, "---\nstring station\n---\nint32 a\n")
    finding(tmp_path, "interface-parts", "GetNowPlaying.srv", 3)


def test_names_of_fields_and_types_have_a_form(tmp_path: Path):
    package = interface_package(tmp_path)
    written(package, FILE, "---\nstring songTitle\n")
    mended(tmp_path, "interface-field-name", "GetNowPlaying.srv", 2)
    assert (package / FILE).read_text() == "---\nstring song_title\n"
    (package / FILE).rename(package / "srv" / "get_now_playing.srv")
    one = finding(tmp_path, "interface-name", "get_now_playing.srv")
    assert "GetNowPlaying.srv" in one.sentence


def test_punctuation_behind_a_field_goes(tmp_path: Path):
    written(interface_package(tmp_path), FILE, "---\nstring station;\n")
    mended(tmp_path, "interface-punctuation", "GetNowPlaying.srv", 2)
    assert codes(tmp_path) == set()


def test_any_other_fault_is_what_the_parser_says(tmp_path: Path):
    written(interface_package(tmp_path), FILE, "---\ntext station\n")
    finding(tmp_path, "interface-text", "GetNowPlaying.srv", 2)
