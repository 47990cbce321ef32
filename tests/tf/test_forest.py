from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from studio.tf.forest import DEPTH_MAX, NONE, Forest

NAMES = st.sampled_from("abcdefgh")
EDGES = st.lists(
    st.tuples(st.sampled_from(["hang", "cut"]), NAMES, NAMES).filter(lambda one: one[1] != one[2]),
    max_size=60,
)


@given(EDGES)
def test_a_forest_is_what_a_dictionary_of_parents_says(edges: list[tuple[str, str, str]]):
    forest, parents = Forest(), dict[str, str]()
    for what, parent, child in edges:
        if what == "cut":
            if parents.pop(child, None) is not None:
                number = forest.number(child)
                assert number is not None
                forest.cut(number)
        elif parent not in below(parents, child):
            assert forest.is_above(child, parent) is False
            before = forest.version
            forest.hang(parent, child)
            assert (forest.version == before) == (parents.get(child) == parent)
            parents[child] = parent
        else:
            assert forest.is_above(child, parent) is True
    known = parents.keys() | set(parents.values())
    assert len(forest) == len(known)
    assert {forest.names[number] for number in forest.numbers()} == known
    for name in known:
        number = forest.number(name)
        assert number is not None
        upper = forest.parents[number]
        assert parents.get(name) == (None if upper == NONE else forest.names[upper])
        assert forest.chain(number)[-1] == forest.root(number)


def below(parents: dict[str, str], name: str) -> set[str]:
    """A frame and all that hangs on it."""
    found = {name}
    while more := {child for child, parent in parents.items() if parent in found} - found:
        found |= more
    return found


def test_how_a_chain_that_is_too_deep_ends_is_not_looked_for():
    forest = Forest()
    for number in range(DEPTH_MAX + 5):
        forest.hang(f"f{number + 1}", f"f{number}")
    assert forest.is_above("elsewhere", "f0") is None
    assert forest.is_above("elsewhere", f"f{DEPTH_MAX}") is False
    assert forest.is_above("f0", "f0") is True


def test_numbers_of_frames_that_are_gone_are_given_again():
    forest = Forest()
    for number in range(1000):
        forest.cut(forest.hang("base", f"f{number}"))
    assert len(forest) == 0
    assert len(forest.names) == 2
