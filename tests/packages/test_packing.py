"""Zips made while they are sent: whole, as they were, and with nothing that is not served."""

from __future__ import annotations

import io
import os
import zipfile
from typing import TYPE_CHECKING

import pytest

from studio.errors import ExportError
from studio.packages import packing
from studio.packages.packing import PackedFile, check_size, package_files, zip_chunks
from studio.packages.roots import ServedRoots
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path


def unzipped(files: list[PackedFile], served: ServedRoots) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(b"".join(zip_chunks(files, served)))) as archive:
        assert archive.testzip() is None
        return {name: archive.read(name) for name in archive.namelist()}


def test_every_file_of_a_package_is_in_it_with_its_bytes(tmp_path: Path):
    names = {"urdf/a.xacro": "<a/>", 'we"ird ü🤖.txt': "x", ".git/config": "no", ".clang": "yes"}
    folder = write_package(tmp_path / "arm", files=names)
    served = ServedRoots([tmp_path])
    found = unzipped(package_files(folder, "arm", served), served)
    assert found["arm/urdf/a.xacro"] == b"<a/>"
    assert found['arm/we"ird ü🤖.txt'] == b"x"
    assert found.keys() == {
        "arm/package.xml",
        "arm/urdf/a.xacro",
        'arm/we"ird ü🤖.txt',
        "arm/.clang",
    }


def test_links_are_followed_to_served_files_only(tmp_path: Path):
    folder = write_package(tmp_path / "served/arm", files={"a.xacro": "<a/>"})
    (tmp_path / "secret").write_text("secret")
    (folder / "inside").symlink_to(folder / "a.xacro")
    (folder / "outside").symlink_to(tmp_path / "secret")
    (folder / "folder").symlink_to(tmp_path)
    (folder / "nowhere").symlink_to(folder / "nowhere")
    served = ServedRoots([tmp_path / "served"])
    found = unzipped(package_files(folder, "arm", served), served)
    assert found.keys() == {"arm/package.xml", "arm/a.xacro", "arm/inside"}
    assert found["arm/inside"] == b"<a/>"


def test_bytes_take_the_place_of_a_file_and_a_file_that_went_is_left_out(tmp_path: Path):
    files = [PackedFile("a", b"edited"), PackedFile("b", tmp_path / "gone")]
    assert unzipped(files, ServedRoots([tmp_path])) == {"a": b"edited"}


def test_a_file_older_than_zips_know_is_packed(tmp_path: Path):
    old = tmp_path / "old"
    old.write_text("x")
    os.utime(old, (0, 0))
    assert unzipped([PackedFile("old", old)], ServedRoots([tmp_path])) == {"old": b"x"}


def test_the_first_bytes_come_before_the_last_file_is_read(tmp_path: Path):
    (tmp_path / "a").write_bytes(content := bytes(range(256)) * 64)
    (tmp_path / "b").write_text("b")
    chunks = zip_chunks(
        [PackedFile("a", tmp_path / "a"), PackedFile("b", tmp_path / "b")], ServedRoots([tmp_path])
    )
    first = next(chunks)
    (tmp_path / "b").unlink()
    with zipfile.ZipFile(io.BytesIO(first + b"".join(chunks))) as archive:
        assert {name: archive.read(name) for name in archive.namelist()} == {"a": content}


def test_what_is_too_much_is_refused_in_a_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(packing, "ZIP_SIZE_LIMIT_BYTES", 4 << 20)
    large = [PackedFile("a", bytes(3 << 20)), PackedFile("b", bytes(2 << 20))]
    with pytest.raises(ExportError, match="arm was not exported: its files are more than 4 MB"):
        check_size(large, "arm")
    check_size(large[:1], "arm")
    monkeypatch.setattr(packing, "FILE_LIMIT", 1)
    folder = write_package(tmp_path / "arm", files={"a": "", "b": ""})
    with pytest.raises(ExportError, match="more than 1 files"):
        package_files(folder, "arm", ServedRoots([tmp_path]))


def test_a_name_that_is_no_text_is_packed_with_question_marks(tmp_path: Path):
    folder = write_package(tmp_path / "arm")
    (folder / os.fsdecode(b"a\xff.txt")).write_text("x")
    served = ServedRoots([tmp_path])
    found = unzipped(package_files(folder, "arm", served), served)
    assert found["arm/a?.txt"] == b"x"


def test_the_size_is_checked_though_a_file_went_meanwhile(tmp_path: Path):
    check_size([PackedFile("a", tmp_path / "gone"), PackedFile("b", b"x")], "arm")
