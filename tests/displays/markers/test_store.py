from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

from studio.displays.markers import store as store_module
from studio.displays.markers import table
from studio.displays.markers.kinds import Action, Kind, Problem
from studio.displays.markers.store import MarkerStore
from tests.support.markers import columns_of, marker

if TYPE_CHECKING:
    from collections.abc import Callable

S = 10**9
NAN = float("nan")
NAMESPACES = ("", "lane", "wall")


def there(store: MarkerStore) -> dict[tuple[str, int], tuple[float, int, int]]:
    """Namespace and id of each marker with its x, its type and how many points it has."""
    table = store.table
    rows = np.flatnonzero(table.batch[: table.size] >= 0).tolist()
    return {
        table.keys[row]: (
            float(table.positions[row, 0]),
            int(table.types[row]),
            len(table.items[row].points),
        )
        for row in rows
    }


class Model:
    """RViz's rules, one marker after the other."""

    def __init__(self) -> None:
        self.markers: dict[tuple[str, int], tuple[float, int, int]] = {}
        self.ends_ns: dict[tuple[str, int], int] = {}

    def take(self, one: Any, now_ns: int) -> None:  # noqa: ANN401
        key = (one.ns, one.id)
        if np.isnan(one.pose.position.x):
            return
        if one.action == Action.DELETE_ALL:
            for each in [each for each in self.markers if one.ns in ("", each[0])]:
                del self.markers[each]
        elif one.action == Action.DELETE:
            self.markers.pop(key, None)
        elif one.action == Action.ADD:
            self.markers[key] = (one.pose.position.x, one.type, len(one.points))
            lifetime_ns = one.lifetime.sec * S + one.lifetime.nanosec
            self.ends_ns[key] = now_ns + lifetime_ns if lifetime_ns > 100_000 else 2**62

    def expire(self, now_ns: int) -> None:
        for key in [key for key in self.markers if self.ends_ns[key] <= now_ns]:
            del self.markers[key]


@st.composite
def any_marker(draw: st.DrawFn) -> Any:  # noqa: ANN401
    actions = [*[Action.ADD] * 5, Action.DELETE, Action.DELETE_ALL, 1]
    return marker(
        draw(st.sampled_from([Kind.CUBE, Kind.LINE_STRIP])),
        draw(st.integers(-2, 3)),
        at=(draw(st.sampled_from([0.0, 1.0, 2.0, NAN])), 0.0, 0.0),
        points=[(1.0, 2.0, 3.0)] * draw(st.integers(0, 3)),
        frame=draw(st.sampled_from(["map", "odom"])),
        stamp_ns=draw(st.sampled_from([0, S])),
        lifetime_ns=draw(st.sampled_from([0, 50_000, S, 3 * S])),
        ns=draw(st.sampled_from(NAMESPACES)),
        action=int(draw(st.sampled_from(actions))),
        frame_locked=draw(st.booleans()),
    )


class Stores(RuleBasedStateMachine):
    def __init__(self) -> None:
        super().__init__()
        self.store, self.model, self.now_ns = MarkerStore(), Model(), 10 * S

    @rule(markers=st.lists(any_marker(), max_size=8), times=st.integers(1, 2))
    def a_message_comes(self, markers: list[Any], times: int) -> None:
        columns = columns_of(*markers)
        for _ in range(times):
            self.store.take(columns, self.now_ns)
            for one in markers:
                self.model.take(one, self.now_ns)

    @rule(after_ns=st.sampled_from([1, S // 2, S]))
    def time_goes_on(self, after_ns: int) -> None:
        self.now_ns += after_ns
        self.store.expire(self.now_ns)
        self.model.expire(self.now_ns)

    @invariant()
    def the_same_markers_are_there(self) -> None:
        assert there(self.store) == self.model.markers
        assert len(self.store) == len(self.model.markers)

    @invariant()
    def batches_are_those_of_markers_that_are_there(self) -> None:
        table = self.store.table
        used = table.batch[: table.size]
        assert set(used[used >= 0].tolist()) == self.store.batches.keys()
        assert self.store.namespaces() == {key[0] for key in self.model.markers}


Stores.TestCase.settings = settings(max_examples=60, stateful_step_count=12, deadline=None)
TestStores = Stores.TestCase


def problems(store: MarkerStore) -> list[int]:
    table = store.table
    return table.problems[: table.size][table.batch[: table.size] >= 0].tolist()


def test_more_markers_than_there_is_room_for_are_left_out_and_told(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.setattr(store_module, "MARKERS_MAX", 3)
    store = MarkerStore()
    store.take(columns_of(*(marker(Kind.CUBE, number) for number in range(5))), 0)
    store.take(columns_of(marker(Kind.CUBE, 1, at=(9.0, 0.0, 0.0))), 0)
    assert [there(store)[("lane", number)][0] for number in range(3)] == [1.0, 9.0, 1.0]
    assert store.refused == {("lane", 3): Problem.TOO_MANY, ("lane", 4): Problem.TOO_MANY}


def test_more_points_than_there_is_room_for_are_left_out_until_others_go(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.setattr(table, "POINTS_MAX", 5)
    store = MarkerStore()
    line = [(0.0, 0.0, 0.0)] * 3
    lines = [marker(Kind.LINE_STRIP, number, points=line) for number in range(2)]
    store.take(columns_of(*lines), 0)
    assert problems(store) == [Problem.NONE, Problem.TOO_LARGE]
    store.take(columns_of(marker(Kind.CUBE, 0, action=int(Action.DELETE))), 0)
    store.take(columns_of(lines[1]), 0)
    assert problems(store) == [Problem.NONE]


def test_a_line_that_is_sent_again_and_again_needs_no_more_room(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(table, "POINTS_MAX", 5)
    store = MarkerStore()
    line = columns_of(marker(Kind.LINE_STRIP, points=[(0.0, 0.0, 0.0)] * 3))
    for _ in range(10):
        store.take(line, 0)
    assert problems(store) == [Problem.NONE]


BAD: dict[str, Callable[[float], Any]] = {
    "at": lambda bad: marker(Kind.SPHERE, 1, at=(bad, 0.0, 0.0)),
    "scale": lambda bad: marker(Kind.SPHERE, 1, scale=(0.0, bad, 0.0)),
    "points": lambda bad: marker(Kind.LINE_STRIP, 1, points=[(1.0, 1.0, 1.0), (0.0, 0.0, bad)]),
    "wxyz": lambda bad: marker(Kind.SPHERE, 1, wxyz=(bad, 0.0, 0.0, 0.0)),
    "rgba": lambda bad: marker(Kind.SPHERE, 1, rgba=(1.0, bad, 0.0, 1.0)),
}


@pytest.mark.parametrize("number", [NAN, float("inf"), 1e38])
@pytest.mark.parametrize("where", list(BAD))
def test_numbers_that_cannot_be_drawn_leave_what_was_there(where: str, number: float):
    store = MarkerStore()
    good = marker(Kind.CUBE, 1)
    store.take(columns_of(good, marker(Kind.SPHERE, 2)), 0)
    store.take(columns_of(BAD[where](number), marker(Kind.CUBE, 2)), 0)
    assert there(store)[("lane", 1)] == (1.0, Kind.CUBE, 0)
    assert there(store)[("lane", 2)][1] == Kind.CUBE
    assert store.refused == {("lane", 1): Problem.NOT_FINITE}
    store.take(columns_of(good), 0)
    assert not store.refused


def test_an_action_that_does_not_exist_is_told_and_does_nothing():
    store = MarkerStore()
    store.take(columns_of(marker(Kind.CUBE, 1, action=1)), 0)
    assert not len(store)
    assert store.refused == {("lane", 1): Problem.UNKNOWN_ACTION}


def test_troubles_that_never_end_fill_no_memory():
    store = MarkerStore()
    for first in range(0, 3000, 500):
        many = [marker(99, number, at=(NAN, 0.0, 0.0)) for number in range(first, first + 500)]
        store.take(columns_of(*many), 0)
    assert len(store.refused) == store_module.REFUSED_MAX


def test_ever_new_namespaces_are_kept_up_to_a_bound_and_shown_all_the_same(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.setattr(store_module, "NAMESPACES_MAX", 3)
    store = MarkerStore()
    store.take(columns_of(*(marker(Kind.CUBE, ns=f"n{each}") for each in range(5))), 0)
    assert list(store.namespaces_so_far) == ["n0", "n1", "n2"]
    assert len(store) == 5


def test_a_stamp_that_changes_with_each_message_leaves_one_batch():
    store = MarkerStore()
    for stamp_ns in range(S, S + 50):
        store.take(columns_of(marker(Kind.CUBE, stamp_ns=stamp_ns)), 0)
    assert [key.stamp_ns for key in store.batches.values()] == [S + 49]
    assert store.take_dirty() == store.batches.keys()
    assert store.take_dirty() == set()


def test_two_of_one_name_in_one_message_are_told_and_the_last_counts():
    store = MarkerStore()
    store.take(columns_of(marker(Kind.CUBE, 1), marker(Kind.SPHERE, 1)), 0)
    assert store.twice == ("lane", 1)
    assert there(store)[("lane", 1)][1] == Kind.SPHERE
    store.take(columns_of(marker(Kind.CUBE, 1)), 0)
    assert store.twice is None


def test_points_are_copies_so_that_one_marker_keeps_no_message_in_memory():
    store = MarkerStore()
    long, short = [(0.0, 0.0, 0.0)] * 1000, [(1.0, 1.0, 1.0)] * 2
    lines = [marker(Kind.LINE_STRIP, at, points=each) for at, each in enumerate((long, short))]
    store.take(columns_of(*lines), 0)
    kept = store.table.items[1].points
    assert kept.base is None
    assert kept.shape == (2, 3)
