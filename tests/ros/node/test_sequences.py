from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from studio.ros.node.sequences import SENDERS_MAX, Gaps

GID, OTHER = b"a" * 16, b"b" * 16


def test_numbers_that_follow_each_other_have_no_gap():
    gaps = Gaps()
    assert [gaps.count(GID, number) for number in (4, 5, 6)] == [0, 0, 0]


def test_what_is_missing_is_counted_for_each_sender():
    gaps = Gaps()
    for gid, number in ((GID, 1), (OTHER, 1), (GID, 4), (OTHER, 2)):
        gaps.count(gid, number)
    assert gaps.lost == 2


def test_a_sender_that_begins_anew_has_lost_nothing():
    gaps = Gaps()
    assert [gaps.count(GID, number) for number in (9, 1, 2)] == [0, 0, 0]


@given(st.sets(st.integers(1, 200), min_size=1))
def test_gaps_are_what_lies_between_the_first_and_the_last_and_did_not_come(numbers: set[int]):
    gaps = Gaps()
    for number in sorted(numbers):
        gaps.count(GID, number)
    assert gaps.lost == max(numbers) - min(numbers) + 1 - len(numbers)


def test_a_peer_that_invents_senders_costs_no_memory():
    gaps = Gaps()
    for number in range(2 * SENDERS_MAX):
        gaps.count(number.to_bytes(16, "little"), 1)
    # The first ones are forgotten, so that they begin anew.
    assert gaps.count((0).to_bytes(16, "little"), 100) == 0
