"""Zips, harmless and hostile, made for real."""

from __future__ import annotations

import os
import stat
import struct
import zipfile
from typing import TYPE_CHECKING

import pytest

from studio.errors import UnsafeArchiveError
from studio.packages.archive import ENTRY_LIMIT, unpack_zip

if TYPE_CHECKING:
    from pathlib import Path

MB = 1 << 20


def make_zip(path: Path, files: dict[str, bytes]) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(zipfile.ZipInfo(name), data, zipfile.ZIP_DEFLATED)
    return path


def refused(tmp_path: Path, zip_path: Path, limit_bytes: int = 100 * MB) -> str:
    """Unpack, expect a refusal that leaves nothing behind, and give its sentence."""
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(UnsafeArchiveError) as caught:
        unpack_zip(zip_path, tmp_path / "into", limit_bytes)
    assert sorted(tmp_path.rglob("*")) == before
    assert str(zip_path) in str(caught.value)
    return caught.value.reason


def test_a_zip_with_one_folder_at_the_top_opens_that_folder(tmp_path: Path):
    made = make_zip(
        tmp_path / "a.zip", {"rover/package.xml": b"<p/>", "rover/urdf/a.urdf": b"<r/>"}
    )
    assert unpack_zip(made, tmp_path / "into", MB) == tmp_path / "into" / "rover"
    assert (tmp_path / "into" / "rover" / "urdf" / "a.urdf").read_bytes() == b"<r/>"


def test_a_zip_with_several_things_at_the_top_opens_as_a_whole(tmp_path: Path):
    made = make_zip(tmp_path / "a.zip", {"package.xml": b"", "urdf/a.urdf": b""})
    assert unpack_zip(made, tmp_path / "into", MB) == tmp_path / "into"


def test_what_macos_adds_is_left_out(tmp_path: Path):
    made = make_zip(tmp_path / "a.zip", {"rover/a.urdf": b"", "__MACOSX/rover/._a.urdf": b""})
    assert unpack_zip(made, tmp_path / "into", MB) == tmp_path / "into" / "rover"
    assert not (tmp_path / "into" / "__MACOSX").exists()


def test_names_written_with_backslashes_become_folders(tmp_path: Path):
    made = make_zip(tmp_path / "a.zip", {"rover\\urdf\\a.urdf": b"x"})
    unpack_zip(made, tmp_path / "into", MB)
    assert (tmp_path / "into" / "rover" / "urdf" / "a.urdf").read_bytes() == b"x"


def test_progress_is_told_and_ends_at_the_total(tmp_path: Path):
    told: list[tuple[int, int]] = []
    made = make_zip(tmp_path / "a.zip", {"a": os.urandom(MB), "b": b"1"})
    unpack_zip(made, tmp_path / "into", 2 * MB, lambda done, total: told.append((done, total)))
    assert told[-1] == (MB + 1, MB + 1)
    assert len(told) > 3


@pytest.mark.parametrize(
    "name",
    ["../evil", "a/../../evil", "/etc/evil", "..", "a/..", "..\\evil", "\\evil", "a\x01b", "a/\n"],
)
def test_a_name_that_leads_outside_is_refused(tmp_path: Path, name: str):
    made = make_zip(tmp_path / "a.zip", {"good": b"1", name: b"evil"})
    assert "leads outside or is no file name" in refused(tmp_path, made)


def test_a_name_with_a_nul_is_refused(tmp_path: Path):
    made = make_zip(tmp_path / "a.zip", {"goodXevil": b""})
    made.write_bytes(made.read_bytes().replace(b"goodXevil", b"good\0evil"))
    assert refused(tmp_path, made)


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        (stat.S_IFLNK, "a link"),
        (stat.S_IFIFO, "a device or pipe"),
        (stat.S_IFCHR, "a device or pipe"),
        (stat.S_IFBLK, "a device or pipe"),
        (stat.S_IFSOCK, "a device or pipe"),
    ],
)
def test_an_entry_that_is_no_plain_file_is_refused(tmp_path: Path, kind: int, said: str):
    entry = zipfile.ZipInfo("entry")
    entry.create_system = 3
    entry.external_attr = (kind | 0o777) << 16
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        archive.writestr(entry, "/etc/passwd")
    assert said in refused(tmp_path, tmp_path / "a.zip")


def test_a_name_that_is_there_twice_is_refused(tmp_path: Path):
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        archive.writestr("a", "1")
        with pytest.warns(UserWarning, match="Duplicate"):
            archive.writestr("a", "2")
    assert "more than once" in refused(tmp_path, tmp_path / "a.zip")


@pytest.mark.parametrize("names", [("a", "a/b"), ("a/b", "a")])
def test_a_name_that_is_a_file_and_a_folder_is_refused(tmp_path: Path, names: tuple[str, str]):
    made = make_zip(tmp_path / "a.zip", dict.fromkeys(names, b""))
    assert refused(tmp_path, made)


def test_gigabytes_of_zeros_are_refused_by_their_announced_size(tmp_path: Path):
    with zipfile.ZipFile(tmp_path / "a.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        for n in range(4):
            archive.writestr(f"zeros{n}", bytes(40 * MB), compresslevel=1)
    assert "would unpack to more than 100 MB" in refused(tmp_path, tmp_path / "a.zip")


def test_what_unpacks_to_200_times_its_size_is_refused(tmp_path: Path):
    made = make_zip(tmp_path / "a.zip", {"zeros": bytes(60 * MB)})
    assert "would unpack to more than 50 MB" in refused(tmp_path, made, limit_bytes=1000 * MB)


def test_a_size_that_lies_does_not_help(tmp_path: Path):
    """The entry says 10 bytes, and holds 60 MB: what is written is counted."""
    made = make_zip(tmp_path / "a.zip", {"zeros": bytes(60 * MB)})
    data = bytearray(made.read_bytes())
    assert data.count(struct.pack("<I", 60 * MB)) == 2
    made.write_bytes(bytes(data).replace(struct.pack("<I", 60 * MB), struct.pack("<I", 10)))
    assert refused(tmp_path, made, limit_bytes=20 * MB)


def test_too_many_files_are_refused(tmp_path: Path):
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        for n in range(ENTRY_LIMIT + 1):
            archive.writestr(f"{n}", b"")
    assert "more than 100,000 files" in refused(tmp_path, tmp_path / "a.zip")


def test_a_list_of_files_that_is_said_to_be_huge_is_not_read(tmp_path: Path):
    made = make_zip(tmp_path / "a.zip", {"a": b""})
    data = bytearray(made.read_bytes())
    data[-10:-6] = struct.pack("<I", 2000 * MB)
    made.write_bytes(bytes(data))
    assert "list of files" in refused(tmp_path, made)


def test_an_encrypted_zip_says_what_to_do(tmp_path: Path):
    made = make_zip(tmp_path / "a.zip", {"a": b"secret"})
    data = bytearray(made.read_bytes())
    data[6] |= 1
    data[data.index(b"PK\x01\x02") + 8] |= 1
    made.write_bytes(bytes(data))
    assert "encrypted" in refused(tmp_path, made)


@pytest.mark.parametrize("data", [b"", b"PK\x03\x04 no zip", b"<robot/>", b"PK\x05\x06" + bytes(7)])
def test_what_is_no_zip_is_refused(tmp_path: Path, data: bytes):
    (tmp_path / "a.zip").write_bytes(data)
    assert refused(tmp_path, tmp_path / "a.zip") == "it is no zip."


def test_a_damaged_zip_is_refused(tmp_path: Path):
    made = make_zip(tmp_path / "a.zip", {"a": os.urandom(5000)})
    data = bytearray(made.read_bytes())
    data[2000] ^= 0xFF
    made.write_bytes(bytes(data))
    assert "damaged" in refused(tmp_path, made)


def test_a_cut_zip_is_refused(tmp_path: Path):
    made = make_zip(tmp_path / "a.zip", {"a": os.urandom(5000)})
    made.write_bytes(made.read_bytes()[:3000])
    assert refused(tmp_path, made) == "it is no zip."


@pytest.mark.skipif(os.name == "nt", reason="pipes of Unix")
def test_a_pipe_that_is_called_zip_does_not_block(tmp_path: Path):
    os.mkfifo(tmp_path / "a.zip")
    assert refused(tmp_path, tmp_path / "a.zip") == "it is no file."


def test_a_folder_that_is_there_is_never_unpacked_into(tmp_path: Path):
    (tmp_path / "into").mkdir()
    (tmp_path / "into" / "mine").touch()
    made = make_zip(tmp_path / "a.zip", {"a": b""})
    assert "the system refused" in refused(tmp_path, made)
