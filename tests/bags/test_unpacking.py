"""Files that were compressed whole: unpacked once, kept within bounds, never a way to crash."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest
import zstandard

from studio.bags import unpacking
from studio.bags.opening import open_bag
from studio.bags.unpacking import UnpackedFiles
from studio.bags.writer import Storing
from studio.errors import BagNotReadableError
from tests.support.permissions import open_folder, unprivileged
from tests.support.read_bags import read_bag
from tests.support.written_bags import some_messages, write

if TYPE_CHECKING:
    from pathlib import Path

    from tests.support.written_bags import Told


def _packed(folder: Path, name: str, data: bytes) -> Path:
    file = folder / f"{name}.zstd"
    file.write_bytes(zstandard.compress(data))
    return file


def _bag(folder: Path) -> tuple[Path, list[Told]]:
    told = some_messages(60)
    write(folder / "bag", told, Storing(mode="file"))
    return folder / "bag", told


def test_a_file_is_unpacked_once_and_again_after_it_changed(tmp_path: Path):
    source = _packed(tmp_path, "a.mcap", b"first")
    kept = UnpackedFiles(tmp_path / "kept")
    shares: list[float] = []
    target = kept.unpacked(source, shares.append)
    assert (target.name, target.read_bytes(), shares[-1]) == ("a.mcap", b"first", 1.0)
    assert kept.unpacked(source, shares.append) == target
    assert len(shares) == 1
    _packed(tmp_path, "a.mcap", b"second, and longer")
    assert kept.unpacked(source).read_bytes() == b"second, and longer"


def test_a_file_that_holds_more_than_it_may_is_refused_and_nothing_is_left(tmp_path: Path):
    source = _packed(tmp_path, "a.mcap", bytes(10_000_000))
    kept = UnpackedFiles(tmp_path / "kept", file_bytes_max=9_999_999)
    with pytest.raises(BagNotReadableError, match="holds more than 9999999 bytes"):
        kept.unpacked(source)
    assert not [one for one in (tmp_path / "kept").rglob("*") if one.is_file()]


def test_the_oldest_go_when_there_is_too_much(tmp_path: Path):
    kept = UnpackedFiles(tmp_path / "kept", kept_bytes_max=2_500)
    found: list[Path] = []
    for number in range(5):
        found.append(kept.unpacked(_packed(tmp_path, f"{number}.mcap", bytes(1_000))))
        os.utime(found[-1], (number, number))
    assert [one.exists() for one in found] == [False, False, True, True, True]


def test_what_goes_while_the_oldest_are_looked_for_harms_nothing(tmp_path: Path):
    other = tmp_path / "kept" / "other"
    other.mkdir(parents=True)
    (other / "gone.mcap").symlink_to(tmp_path / "nowhere")
    kept = UnpackedFiles(tmp_path / "kept")
    assert kept.unpacked(_packed(tmp_path, "a.mcap", b"data")).read_bytes() == b"data"


def test_a_file_that_is_no_zstd_is_a_sentence(tmp_path: Path):
    (tmp_path / "a.mcap.zstd").write_bytes(b"not packed at all")
    with pytest.raises(BagNotReadableError, match=r"a\.mcap\.zstd.*damaged"):
        open_bag(tmp_path / "a.mcap.zstd", kept_in=tmp_path / "kept")
    with pytest.raises(BagNotReadableError, match="it is not there"):
        UnpackedFiles(tmp_path / "kept").unpacked(tmp_path / "b.mcap.zstd")


def test_a_bag_packed_whole_and_cut_off_keeps_what_came_before(tmp_path: Path):
    path, told = _bag(tmp_path)
    (file,) = path.glob("*.zstd")
    plain = zstandard.ZstdDecompressor().decompress(file.read_bytes(), 10**8)
    packed = zstandard.ZstdCompressor(level=1).compress(plain + os.urandom(200_000))
    file.write_bytes(packed[: len(packed) - 300_000 // 2])
    found = read_bag(path, tmp_path / "kept")
    assert found.messages == told
    assert "it was not closed" in found.troubles[0]


def test_where_nothing_can_be_kept_another_folder_takes_it(tmp_path: Path):
    path, told = _bag(tmp_path)
    (tmp_path / "kept").write_text("a file stands in the place of the folder")
    assert read_bag(path, tmp_path / "kept").messages == told


def test_where_nothing_can_be_unpacked_it_is_a_sentence(tmp_path: Path):
    path, _ = _bag(tmp_path)
    (tmp_path / "kept").mkdir()
    (tmp_path / "kept" / unpacking.FOLDER).write_text("a file stands in the place of the folder")
    with pytest.raises(BagNotReadableError, match=f"{unpacking.FOLDER} cannot take what it holds"):
        open_bag(path, kept_in=tmp_path / "kept")


def test_a_bag_in_a_folder_that_may_only_be_read_is_unpacked_elsewhere():
    with open_folder() as folder:
        path, told = _bag(folder)
        (folder / "kept").mkdir()
        (folder / "kept").chmod(0o777)
        for one in (path, *path.iterdir()):
            one.chmod(0o555 if one == path else 0o444)
        before = sorted(path.iterdir())
        with unprivileged():
            assert read_bag(path, folder / "kept").messages == told
            with pytest.raises(OSError, match="Permission"):
                (path / "new").touch()
        assert sorted(path.iterdir()) == before
        path.chmod(0o755)
