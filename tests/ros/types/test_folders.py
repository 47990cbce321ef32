from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

import pytest

from studio.errors import RosNameError, UnreadableFileError
from studio.ros.types.folders import read_text, texts_of_package
from studio.ros.types.library import TypeLibrary
from studio.ros.types.parser import TEXT_BYTES_MAX

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
    added = library.add_texts(texts_of_package(package, "my_pkg"))
    assert added == ["my_pkg/msg/Thing", "my_pkg/srv/Thing", "my_pkg/action/Thing"]
    assert library.action("my_pkg/action/Thing").Goal() is not None


def test_a_folder_without_interfaces_has_none(tmp_path: Path):
    assert texts_of_package(tmp_path, "my_pkg") == {}


@pytest.mark.parametrize("name", ["thing.msg", "Thing-2.msg", "A_Request.msg"])
def test_a_bad_name_of_a_file_is_told(package: Path, name: str):
    (package / "msg" / name).write_text("int8 x")
    with pytest.raises(RosNameError, match=name):
        texts_of_package(package, "my_pkg")


def test_a_huge_file_is_refused(package: Path):
    (package / "msg" / "Big.msg").write_bytes(b"#" * (TEXT_BYTES_MAX + 1))
    with pytest.raises(UnreadableFileError, match="larger than"):
        texts_of_package(package, "my_pkg")


@pytest.mark.skipif(sys.platform == "win32", reason="no pipes and links there")
def test_links_that_lead_out_and_pipes_are_passed_over(package: Path):
    outside = package.parent / "Secret.msg"
    outside.write_text("int8 secret")
    (package / "msg" / "Secret.msg").symlink_to(outside)
    os.mkfifo(package / "msg" / "Pipe.msg")
    assert "my_pkg/msg/Secret" not in texts_of_package(package, "my_pkg")
    with pytest.raises(UnreadableFileError, match="no regular file"):
        read_text(package / "msg" / "Pipe.msg")


def test_what_cannot_be_read_says_so(package: Path):
    with pytest.raises(UnreadableFileError, match="cannot be read"):
        read_text(package / "msg" / "None.msg")
