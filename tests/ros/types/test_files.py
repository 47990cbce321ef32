from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

import pytest

from studio.errors import RosNameError, UnreadableFileError
from studio.ros.types.files import read_text, texts_of_package
from studio.ros.types.interface_text import TEXT_BYTES_MAX
from studio.ros.types.library import TypeLibrary

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def package(tmp_path: Path) -> Path:
    for kind, text in {"msg": "int8 x", "srv": "---", "action": "---\n---"}.items():
        (tmp_path / "pkg" / kind).mkdir(parents=True)
        (tmp_path / "pkg" / kind / f"Thing.{kind}").write_text(text)
    return tmp_path / "pkg"


def test_all_kinds_of_a_folder_are_read_and_usable_at_once(package: Path):
    library = TypeLibrary("jazzy")
    assert library.add_sound_texts(texts_of_package(package, "my_pkg")) == {}
    assert library.own_names() == ["my_pkg/action/Thing", "my_pkg/msg/Thing", "my_pkg/srv/Thing"]
    assert library.action("my_pkg/action/Thing").Goal() is not None


def test_a_folder_without_interfaces_has_none(tmp_path: Path):
    assert texts_of_package(tmp_path, "my_pkg").texts == {}


@pytest.mark.parametrize(
    ("name", "better"),
    [
        ("thing.msg", "Thing.msg"),
        ("Thing-2.msg", "Thing2.msg"),
        ("my_own.msg", "MyOwn.msg"),
        ("A_Request.msg", "ARequest.msg"),
    ],
)
def test_a_bad_name_of_a_file_is_told_with_a_better_one_and_the_others_stay(
    package: Path, name: str, better: str
):
    path = package / "msg" / name
    path.write_text("int8 x")
    found = texts_of_package(package, "my_pkg")
    (fault,) = found.faults.values()
    assert str(fault).startswith(f"{path}: its name defines no type")
    assert str(fault).endswith(f": call it {better}.")
    assert "my_pkg/msg/Thing" in found.texts


def test_a_huge_file_is_left_out_and_told(package: Path):
    (package / "msg" / "Big.msg").write_bytes(b"#" * (TEXT_BYTES_MAX + 1))
    found = texts_of_package(package, "my_pkg")
    assert "larger than" in str(found.faults["my_pkg/msg/Big"])
    assert "my_pkg/msg/Thing" in found.texts


def test_a_package_of_a_bad_name_has_no_types(package: Path):
    with pytest.raises(RosNameError, match="a package is named"):
        texts_of_package(package, "My-pkg")


@pytest.mark.skipif(sys.platform == "win32", reason="no pipes and links there")
def test_links_that_lead_out_and_pipes_are_passed_over(package: Path):
    outside = package.parent / "Secret.msg"
    outside.write_text("int8 secret")
    (package / "msg" / "Secret.msg").symlink_to(outside)
    os.mkfifo(package / "msg" / "Pipe.msg")
    assert "my_pkg/msg/Secret" not in texts_of_package(package, "my_pkg").texts
    with pytest.raises(UnreadableFileError, match="no regular file"):
        read_text(package / "msg" / "Pipe.msg")


def test_what_cannot_be_read_says_so(package: Path):
    with pytest.raises(UnreadableFileError, match="cannot be read"):
        read_text(package / "msg" / "None.msg")
