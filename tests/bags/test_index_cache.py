"""What is kept of an index is the index again, for as long as its file stays as it was."""

from __future__ import annotations

import os
from dataclasses import astuple
from typing import TYPE_CHECKING

import numpy as np
import pytest

from studio.bags.index_cache import IndexCache
from studio.bags.mcap_file import opened
from studio.bags.mending import rebuilt_index
from studio.files import stamp_of
from tests.support.bags import Told, write_mcap

if TYPE_CHECKING:
    from pathlib import Path

    from studio.bags.mcap_index import McapIndex


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A bag that was cut off."""
    told = [Told(f"/t{number % 3}", number, str(number)) for number in range(500)]
    made = write_mcap(tmp_path / "bag.mcap", told)
    made.write_bytes(made.read_bytes()[:-200])
    return made


def _rebuilt(file: Path) -> McapIndex:
    handle = opened(file)
    try:
        return rebuilt_index(handle, file.name, "it was cut off")
    finally:
        os.close(handle)


@pytest.fixture
def kept(file: Path, tmp_path: Path) -> IndexCache:
    """A cache that has its index."""
    made = IndexCache(tmp_path / "kept")
    made.keep(file, stamp_of(file), _rebuilt(file))
    return made


def test_an_index_that_was_kept_is_the_same_again(file: Path, kept: IndexCache):
    made, found = _rebuilt(file), kept.get(file)
    assert found is not None
    for one, other in zip(astuple(made.blocks), astuple(found.blocks), strict=True):
        assert np.array_equal(one, other)
    assert (found.schemas, found.channels) == (made.schemas, made.channels)
    assert (found.counts, found.metadata) == (made.counts, made.metadata)
    assert found.troubles == made.troubles
    assert found.troubles


def test_the_index_of_a_file_that_was_changed_is_not_taken(file: Path, kept: IndexCache):
    with file.open("ab") as stream:
        stream.write(b"more")
    assert kept.get(file) is None


def test_the_index_of_another_file_is_not_taken(file: Path, kept: IndexCache):
    other = file.with_name("other.mcap")
    other.write_bytes(file.read_bytes())
    assert kept.get(other) is None


def test_an_index_that_is_damaged_is_not_taken(file: Path, kept: IndexCache):
    (place,) = kept.folder.glob("*.index")
    data = bytearray(place.read_bytes())
    data[len(data) // 2] ^= 1
    place.write_bytes(data)
    assert kept.get(file) is None
