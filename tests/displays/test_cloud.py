import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from studio.displays.cloud import evenly, evenly_among


@given(st.integers(0, 5000), st.integers(0, 5000))
def test_exactly_so_many_are_chosen_in_their_order(count: int, limit: int):
    chosen = evenly(count, limit)
    assert len(chosen) == min(count, limit)
    assert (np.diff(chosen) > 0).all()
    assert len(chosen) == 0 or 0 <= chosen[0] <= chosen[-1] < count


@pytest.mark.parametrize("columns", [640, 1280, 1800])
def test_the_chosen_ones_lie_evenly_in_rows_and_in_columns_of_a_picture(columns: int):
    shown = np.zeros(columns * 480, dtype=bool)
    shown[evenly(shown.size, shown.size // 5)] = True
    blocks = shown.reshape(480 // 20, 20, columns // 20, 20).sum(axis=(1, 3))
    assert blocks.min() > 80 - 16
    assert blocks.max() < 80 + 16


def test_a_smaller_number_is_a_part_of_a_larger_one():
    fewer, more = evenly(100_000, 10_000), evenly(100_000, 20_000)
    assert len(np.setdiff1d(fewer, more)) <= 16


@given(st.lists(st.booleans(), max_size=300), st.integers(0, 300))
def test_only_what_is_kept_is_chosen_and_all_of_it_when_it_is_not_too_much(
    flags: list[bool], limit: int
):
    kept = np.array(flags, dtype=bool)
    chosen = evenly_among(kept, limit)
    assert len(chosen) <= limit
    assert kept[chosen].all()
    if kept.sum() <= limit:
        assert_array_equal(chosen, np.flatnonzero(kept))


def test_of_those_kept_about_as_many_are_chosen_as_may_be():
    kept = np.random.default_rng(1).uniform(size=200_000) < 0.5
    assert 9_800 < len(evenly_among(kept, 10_000)) <= 10_000


def test_points_that_come_and_go_leave_the_choice_among_the_others_as_it_is():
    rng = np.random.default_rng(2)
    before = rng.uniform(size=100_000) < 0.9
    after = before.copy()
    after[rng.integers(0, before.size, 100)] = False
    one, other = evenly_among(before, 20_000), evenly_among(after, 20_000)
    assert len(np.intersect1d(one, other)) > 19_800
