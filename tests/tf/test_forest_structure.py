from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from studio.tf.forest import Structure

# Each row hangs on an earlier one, or on nothing; then rows are shuffled.
FORESTS = st.integers(1, 40).flatmap(
    lambda count: st.tuples(
        st.tuples(*(st.integers(-1, row - 1) for row in range(count))),
        st.permutations(range(count)),
    )
)


def shuffled(forest: tuple[tuple[int, ...], list[int]]) -> list[int]:
    parents, order = forest
    result = [0] * len(parents)
    for row, parent in enumerate(parents):
        result[order[row]] = -1 if parent < 0 else order[parent]
    return result


def upwards(parents: list[int], row: int) -> list[int]:
    way = [row]
    while parents[way[-1]] >= 0:
        way.append(parents[way[-1]])
    return way


@given(FORESTS)
def test_rounds_of_doubling_reach_every_root_with_every_product(
    forest: tuple[tuple[int, ...], list[int]],
):
    parents = shuffled(forest)
    structure = Structure(np.array(parents, np.int64))
    matrices = np.stack([np.eye(4)] * len(parents))
    for row, parent in enumerate(parents):
        if parent >= 0:
            matrices[row, 0, 3] = row + 1
    expected = [sum(one + 1 for one in upwards(parents, row)[:-1]) for row in range(len(parents))]
    assert structure.root_from_rows(matrices)[:, 0, 3].tolist() == expected
    assert structure.roots.tolist() == [upwards(parents, row)[-1] for row in range(len(parents))]


@given(FORESTS, st.data())
def test_a_turned_tree_has_the_same_edges(
    forest: tuple[tuple[int, ...], list[int]], data: st.DataObject
):
    parents = shuffled(forest)
    row = data.draw(st.integers(0, len(parents) - 1))
    turned, edges = Structure(np.array(parents, np.int64)).seen_from(row)
    turned_parents = turned.parents.tolist()
    root = upwards(parents, row)[-1]
    for one, parent in enumerate(turned_parents):
        edge = int(edges[one])
        if one == row:
            assert parent == -1
        elif parent >= 0:
            assert {one, parent} == {edge, parents[edge]}
        if upwards(parents, one)[-1] == root:
            assert upwards(turned_parents, one)[-1] == row


def test_the_greatest_value_on_the_way_is_found():
    structure = Structure(np.array([-1, 0, 1, 2, 0]))
    assert structure.greatest_above(np.array([9.0, 1.0, 5.0, 2.0, 3.0])).tolist() == [
        9.0, 1.0, 5.0, 5.0, 3.0,
    ]  # fmt: skip


def test_what_is_cut_begins_a_tree_of_its_own():
    structure = Structure(np.array([-1, 0, 1, 2])).without(np.array([False, False, True, False]))
    assert structure.roots.tolist() == [0, 0, 2, 2]


def test_a_forest_of_nothing_is_one():
    assert Structure(np.zeros(0, np.int64)).roots.tolist() == []


@given(FORESTS, st.data())
def test_the_first_with_a_flag_is_found_on_the_way_up(
    forest: tuple[tuple[int, ...], list[int]], data: st.DataObject
):
    parents = shuffled(forest)
    flags = data.draw(st.lists(st.booleans(), min_size=len(parents), max_size=len(parents)))
    found = Structure(np.array(parents, np.int64)).first_above(np.array(flags, np.bool_))
    ways = [upwards(parents, row)[:-1] for row in range(len(parents))]
    expected = [next((one for one in way if flags[one]), -1) for way in ways]
    assert found.tolist() == expected
