"""Indexes that are kept: of the file as it is, and never in the way of reading it."""

from __future__ import annotations

import hashlib
import io
import os
from typing import TYPE_CHECKING

import numpy as np
import pytest

from studio.bags import index_cache, opening
from studio.bags.index_cache import IndexCache
from studio.bags.mending import rebuilt_index
from studio.bags.opening import open_bag
from studio.files import stamp_of
from tests.support.bags import Told, write_mcap
from tests.support.read_bags import as_read, read_bag

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from studio.bags.mcap_index import McapIndex

TOLD = [Told(f"/topic{n % 3}", n * 1_000_000, f"text {n}") for n in range(300)]


def _cut(folder: Path) -> Path:
    file = write_mcap(folder / "bag.mcap", TOLD)
    os.truncate(file, file.stat().st_size - 50)
    return file


def _index_of(file: Path) -> McapIndex:
    with file.open("rb") as stream:
        return rebuilt_index(stream.fileno(), file.name, "it was not closed")


def _kept(folder: Path) -> tuple[IndexCache, Path, Path]:
    """A cache that keeps the index of a file; the file, and where the index lies."""
    file, cache = _cut(folder), IndexCache(folder / "kept")
    cache.keep(file, stamp_of(file), _index_of(file))
    (kept,) = cache.folder.iterdir()
    return cache, file, kept


def test_an_index_comes_back_as_it_was_made(tmp_path: Path):
    cache, file, _ = _kept(tmp_path)
    found, made = cache.get(file), _index_of(file)
    assert found is not None
    for name in made.blocks.__dataclass_fields__:
        np.testing.assert_array_equal(getattr(found.blocks, name), getattr(made.blocks, name))
    assert (found.schemas, found.channels, found.counts, found.metadata, found.troubles) == (
        (made.schemas, made.channels, made.counts, made.metadata, made.troubles)
    )


def _other_arrays(kept: Path) -> None:
    """As if another version of the studio had kept it."""
    with np.load(io.BytesIO(kept.read_bytes()[32:])) as arrays:
        parts = {name: arrays[name] for name in arrays.files if name != "are_chunks"}
    stream = io.BytesIO()
    np.savez(stream, allow_pickle=False, **parts)
    digest = hashlib.blake2b(stream.getvalue(), digest_size=32).digest()
    kept.write_bytes(digest + stream.getvalue())


def _flip_a_byte(kept: Path) -> None:
    data = bytearray(kept.read_bytes())
    data[len(data) // 2] ^= 1
    kept.write_bytes(data)


def _cut_short(kept: Path) -> None:
    os.truncate(kept, 100)


def _empty(kept: Path) -> None:
    kept.write_bytes(b"")


def _folder_instead(kept: Path) -> None:
    kept.unlink()
    kept.mkdir()


@pytest.mark.parametrize("harm", [_other_arrays, _flip_a_byte, _cut_short, _empty, _folder_instead])
def test_a_kept_index_that_is_damaged_is_none(tmp_path: Path, harm: Callable[[Path], None]):
    cache, file, kept = _kept(tmp_path)
    harm(kept)
    assert cache.get(file) is None
    cache.keep(file, stamp_of(file), _index_of(file))
    assert (cache.get(file) is not None) == (harm is not _folder_instead)


def test_the_index_of_a_file_that_changed_is_none(tmp_path: Path):
    cache, file, _ = _kept(tmp_path)
    os.truncate(file, file.stat().st_size - 1)
    assert cache.get(file) is None
    assert cache.get(tmp_path / "nobody.mcap") is None


def test_only_so_many_are_kept(tmp_path: Path):
    cache, file, _ = _kept(tmp_path)
    index = _index_of(file)
    for number in range(104):
        other = tmp_path / f"{number}.mcap"
        other.write_bytes(b"another file")
        cache.keep(other, stamp_of(other), index)
    assert len(list(cache.folder.iterdir())) == 100
    assert cache.get(file) is None


def test_an_index_that_took_long_is_made_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(opening, "KEPT_AFTER_S", 0.0)
    file = _cut(tmp_path)
    told: list[float] = []
    open_bag(file, told.append, kept_in=tmp_path / "kept").close()
    first, told[:] = len(told), []
    assert first > 0
    bag = open_bag(file, told.append, kept_in=tmp_path / "kept")
    assert not told
    bag.close()
    assert read_bag(file, tmp_path / "kept").messages == as_read(TOLD)


def test_where_no_index_can_be_kept_the_bag_is_read_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(opening, "KEPT_AFTER_S", 0.0)
    (tmp_path / "kept").mkdir()
    (tmp_path / "kept" / index_cache.FOLDER).write_text("a file in the place of the folder")
    assert read_bag(_cut(tmp_path), tmp_path / "kept").messages == as_read(TOLD)
