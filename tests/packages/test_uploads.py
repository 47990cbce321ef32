from __future__ import annotations

import json
import os
import resource
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from studio.errors import UploadError
from studio.packages.uploads import FILE_LIMIT, SentFile, Upload, read_manifest

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

MB = 1 << 20
FILES = (SentFile("robot/r.urdf", 8), SentFile("robot/empty.txt", 0), SentFile("robot/b.stl", 4))
BYTES = b"<robot/>" + b"mesh"


def manifest(*files: tuple[str, int]) -> bytes:
    return json.dumps([{"path": path, "size": size} for path, size in files]).encode()


def left(data: Path) -> set[str]:
    return {one.relative_to(data).as_posix() for one in data.rglob("*") if one.is_file()}


@pytest.mark.parametrize("step", [1, 3, 100])
def test_files_arrive_whole_in_chunks_of_any_size(tmp_path: Path, step: int):
    with Upload(tmp_path, FILES) as upload:
        for begin in range(0, len(BYTES), step):
            upload.write(BYTES[begin : begin + step])
        staged = upload.finish()
        assert (staged / "robot" / "r.urdf").read_bytes() == b"<robot/>"
        kept, is_new = upload.keep()
    assert is_new
    assert left(kept) == {"robot/r.urdf", "robot/empty.txt", "robot/b.stl"}
    assert list((tmp_path / "uploads").iterdir()) == [kept]


def test_the_same_files_sent_again_keep_what_was_edited(tmp_path: Path):
    for is_first in (True, False):
        with Upload(tmp_path, FILES) as upload:
            upload.write(BYTES)
            upload.finish()
            kept, is_new = upload.keep()
            assert is_new == is_first
        if is_first:
            (kept / "robot" / "r.urdf").write_text("edited")
    assert (kept / "robot" / "r.urdf").read_text() == "edited"
    assert len(list((tmp_path / "uploads").iterdir())) == 1


def test_what_breaks_off_leaves_nothing(tmp_path: Path):
    with Upload(tmp_path, FILES) as upload:
        upload.write(BYTES[:5])
        with pytest.raises(UploadError, match="broke off"):
            upload.finish()
    assert left(tmp_path) == set()
    assert list((tmp_path / "uploads").iterdir()) == []


def test_more_than_was_announced_is_not_written(tmp_path: Path):
    with pytest.raises(UploadError, match="more was sent"), Upload(tmp_path, FILES) as upload:
        upload.write(BYTES + b"!")
    assert left(tmp_path) == set()


def test_the_quota_counts_what_is_there_and_what_is_on_its_way(tmp_path: Path):
    (tmp_path / "uploads" / "old").mkdir(parents=True)
    (tmp_path / "uploads" / "old" / "big.stl").write_bytes(bytes(60))
    with Upload(tmp_path, FILES, reserved_bytes=28, quota_bytes=100):
        pass
    with (
        pytest.raises(UploadError, match=r"delete folders in .*uploads"),
        Upload(tmp_path, FILES, reserved_bytes=29, quota_bytes=100),
    ):
        pass


def test_more_than_one_sending_may_hold_is_refused_before_a_byte_is_read(tmp_path: Path):
    with pytest.raises(UploadError, match="are more than 1,024 MB"):
        Upload(tmp_path, [SentFile("m.stl", 2000 * MB)]).__enter__()
    assert list(tmp_path.iterdir()) == []


@contextmanager
def small_files_only(limit_bytes: int) -> Generator[None]:
    """Let the system refuse to write more into a file, as a full disk does."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit_bytes, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_a_disk_that_is_full_is_said_and_leaves_nothing(tmp_path: Path):
    files = [SentFile("m.stl", 4 * MB)]
    with (
        Upload(tmp_path, files) as upload,
        small_files_only(MB),
        pytest.raises(UploadError, match="the data folder cannot take it"),
    ):
        upload.write(bytes(4 * MB))
    assert left(tmp_path) == set()


def test_what_a_killed_studio_left_behind_is_swept_away(tmp_path: Path):
    old, young = tmp_path / "uploads" / ".sending-1-1", tmp_path / "uploads" / ".sending-1-2"
    for one in (old, young):
        one.mkdir(parents=True)
        (one / "half.stl").touch()
    os.utime(old, (0, 0))
    with Upload(tmp_path, FILES):
        assert not old.exists()
        assert young.exists()


@pytest.mark.parametrize(
    "name",
    [
        *("../out.urdf", "/etc/passwd", "a/../../b", "a//b", "", ".", "..", "a\0b", "a\nb"),
        *("a\\..\\b", "x" * 300, "/".join(["deep"] * 300), "a/./b", "\ud800"),
    ],
)
def test_a_name_that_leads_elsewhere_is_refused(name: str):
    with pytest.raises(UploadError, match=r"no file name|cannot be read"):
        read_manifest(manifest((name, 1)))


@pytest.mark.parametrize(
    "name",
    ['it\'s "mine".urdf', "<img src=x onerror=alert(1)>.urdf", "röver 🤖.xacro", "$(rm).stl"],
)
def test_a_name_that_is_only_unusual_is_kept(tmp_path: Path, name: str):
    files = read_manifest(manifest((name, 2)))
    with Upload(tmp_path, files) as upload:
        upload.write(b"ok")
        upload.finish()
        kept, _ = upload.keep()
    assert left(kept) == {name}


@pytest.mark.parametrize(
    ("files", "sentence"),
    [
        ([], "there is no file"),
        ([("a.urdf", 1), ("a.urdf", 1)], "more than once"),
        ([("A.urdf", 1), ("a.urdf", 1)], "more than once"),
        ([("a", 1), ("a/b.urdf", 1)], "a file and a folder at once"),
        ([("a.zip", 1), ("b.urdf", 1)], "opened by itself"),
        ([("big.urdf", 50 * MB)], "has 50 MB, and a description may have 20 MB"),
        ([("a.urdf", -1)], "has no size"),
        ([(f"{n}.stl", 1) for n in range(FILE_LIMIT + 1)], "more than 10,000"),
    ],
)
def test_a_list_of_files_that_cannot_be_taken_says_why(files: list[tuple[str, int]], sentence: str):
    with pytest.raises(UploadError, match=sentence):
        read_manifest(manifest(*files))


@pytest.mark.parametrize("line", [b"", b"{}", b"[1]", b'[{"path": 1}]', b"\xff", b"[" * 100_000])
def test_a_line_that_is_no_list_of_files_is_refused(line: bytes):
    with pytest.raises(UploadError, match="cannot be read"):
        read_manifest(line)
