from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from studio.displays.markers.kinds import Kind
from studio.displays.markers.store import STAMPS_MAX, Naming, few_stamps
from tests.support.markers import columns_of, marker

S = 10**9
STAMPS = st.integers(-(2**31) * S, 2**31 * S - 1)


def stamps(values: list[int]) -> list[int]:
    return few_stamps(np.array(values, dtype=np.int64)).tolist()


def test_stamps_of_a_few_moments_stay_what_they_are():
    values = [number * 1000 for number in range(STAMPS_MAX)] * 2
    assert stamps(values) == values


def test_markers_that_are_stamped_as_they_are_made_are_of_one_moment():
    values = [S + number * 1000 for number in range(2000)]
    assert stamps(values) == [S] * 2000


def test_a_long_trail_keeps_as_many_moments_as_can_be_told_apart():
    values = [number * S for number in range(1000)]
    found = stamps(values)
    assert len(set(found)) == STAMPS_MAX
    assert max(abs(one - other) for one, other in zip(found, values, strict=True)) <= 3 * S


@given(st.lists(STAMPS, min_size=1, max_size=50), st.integers(0, 10**9))
def test_whatever_comes_there_are_few_and_each_is_one_that_was_sent_no_later(
    values: list[int], step_ns: int
):
    many = [values[0] // 2 + number * step_ns for number in range(2 * STAMPS_MAX)]
    everyone = [*values, *many]
    found = stamps(everyone)
    assert len(set(found)) <= STAMPS_MAX
    assert set(found) <= set(everyone)
    assert all(one <= other for one, other in zip(found, everyone, strict=True))


def test_texts_that_come_again_are_numbered_once_and_a_bounded_number_is_kept():
    naming = Naming()
    first = columns_of(
        marker(Kind.CUBE, ns="a"), marker(Kind.CUBE, frame="odom"), marker(Kind.CUBE)
    )
    named = naming.named(first.texts)
    assert naming.named(first.texts) is named
    assert named.pairs.tolist() == [0, 1, 2]
    assert named.namespaces == ["a", "lane", "lane"]
    for number in range(4):
        naming.named(columns_of(marker(Kind.CUBE, ns=f"n{number}")).texts)
    assert naming.named(first.texts) is not named
