from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from studio.ros.attachment import Attachment
from studio.ros.node.samples import LATE_MAX, SENDERS_MAX, Gaps

GID, OTHER = b"a" * 16, b"b" * 16


def sent(number: int, gid: bytes = GID, sent_ns: int | None = None) -> Attachment:
    """A sample's attachment; each is sent a nanosecond after the one before it."""
    return Attachment(number, number if sent_ns is None else sent_ns, gid)


def lost_of(*numbers: int) -> int:
    gaps = Gaps()
    for number in numbers:
        gaps.count(sent(number))
    return gaps.lost


def test_numbers_that_follow_each_other_have_no_gap():
    gaps = Gaps()
    assert [gaps.count(sent(number)) for number in (4, 5, 6)] == [0, 0, 0]


def test_what_is_missing_is_counted_for_each_sender():
    gaps = Gaps()
    for gid, number in ((GID, 1), (OTHER, 1), (GID, 4), (OTHER, 2)):
        gaps.count(sent(number, gid))
    assert gaps.lost == 2


def test_a_sender_that_begins_anew_has_lost_nothing_and_is_counted_again():
    gaps = Gaps()
    began_anew = [gaps.count(sent(number, sent_ns=at)) for at, number in enumerate((9, 1, 2, 4))]
    assert began_anew == [0, 0, 0, 1]


def test_what_comes_late_was_not_lost_and_what_follows_is_not_counted_twice():
    assert lost_of(1, 3, 2, 4) == 0
    assert lost_of(1, 5, 3, 6, 4) == 1


def test_what_comes_twice_or_was_never_missing_changes_nothing():
    assert lost_of(1, 4, 4, 1, 2, 2, 5) == 1
    assert lost_of(10, 5, 6, 7, 11) == 0


def test_of_a_long_gap_the_newest_may_still_come():
    last = 3 * LATE_MAX
    assert lost_of(1, last, last - 1, 2) == last - 3


@given(st.sets(st.integers(1, 200), min_size=1))
def test_gaps_are_what_lies_between_the_first_and_the_last_and_did_not_come(numbers: set[int]):
    assert lost_of(*sorted(numbers)) == max(numbers) - min(numbers) + 1 - len(numbers)


@given(st.permutations(range(2, 40)))
def test_in_whatever_order_all_come_nothing_was_lost(numbers: list[int]):
    assert lost_of(1, *numbers) == 0


def test_a_peer_that_invents_senders_costs_no_memory():
    gaps = Gaps()
    for number in range(2 * SENDERS_MAX):
        gaps.count(sent(1, number.to_bytes(16, "little")))
    # The first ones are forgotten, so that they begin anew.
    assert gaps.count(sent(100, (0).to_bytes(16, "little"))) == 0
