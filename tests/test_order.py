"""The order of a parallel run: all tests, each file whole, and browsers apart from each other."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from hypothesis import given
from hypothesis import strategies as st

from tests.support.compiling import part_of
from tests.support.order import LONGEST, in_order, spread

if TYPE_CHECKING:
    import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
names = st.lists(st.text("abc", min_size=1), unique=True)


def test_every_test_is_there_once_and_each_file_is_whole(request: pytest.FixtureRequest):
    items = request.session.items
    ordered = in_order([*items[1::2], *items[::2]])
    assert sorted(one.nodeid for one in ordered) == sorted(one.nodeid for one in items)
    files = [one.path for one in ordered]
    begins = [path for at, path in enumerate(files) if at == 0 or files[at - 1] != path]
    assert len(begins) == len(set(begins))


def test_long_files_are_those_that_are_there():
    assert [path for path in LONGEST if not (REPOSITORY / path).is_file()] == []


def test_each_file_is_compiled_by_one_process(request: pytest.FixtureRequest):
    parts = [name for worker in range(3) for name in part_of(worker, 3)]
    assert len(parts) == len(set(parts))
    collected = {one.path.relative_to(REPOSITORY) for one in request.session.items}
    assert {".".join(path.with_suffix("").parts) for path in collected} <= set(parts)


@given(names, names)
def test_what_is_spread_lies_evenly_and_in_its_order(some: list[str], others: list[str]):
    first, second = [f"1{one}" for one in some], [f"2{one}" for one in others]
    mixed = spread(first, second)
    assert [one for one in mixed if one in first] == first
    assert [one for one in mixed if one in second] == second
    between = "".join(one[0] for one in mixed).split("1")[1:]
    assert max(map(len, between), default=0) - min(map(len, between), default=0) <= 1
