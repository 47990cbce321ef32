import numpy as np

from studio.displays.markers.kinds import Action
from studio.displays.markers.store import Outcome, outcome_of

ADD, DELETE, ALL = Action.ADD, Action.DELETE, Action.DELETE_ALL


def outcome(*markers: tuple[str, int, int], untaken: tuple[int, ...] = ()) -> Outcome:
    """Of namespaces, ids and actions."""
    taken = np.array([at not in untaken for at in range(len(markers))], dtype=np.bool_)
    namespaces = [namespace for namespace, _, _ in markers]
    ids, actions = (
        np.array([each[column] for each in markers], dtype=np.int32) for column in (1, 2)
    )
    return outcome_of(namespaces, ids, actions, taken)


def test_the_last_word_on_a_marker_counts():
    found = outcome(("a", 1, ADD), ("a", 1, DELETE), ("a", 2, DELETE), ("a", 2, ADD))
    assert found.deleted == [("a", 1)]
    assert found.added.tolist() == [3]


def test_what_is_added_before_all_are_deleted_is_added_in_vain():
    found = outcome(("a", 1, ADD), ("", 0, ALL), ("a", 2, ADD))
    assert found.clears_all
    assert found.added.tolist() == [2]


def test_a_namespace_can_be_cleared_by_itself_and_filled_again():
    found = outcome(("a", 1, ADD), ("b", 1, ADD), ("a", 0, ALL), ("a", 2, ADD))
    assert not found.clears_all
    assert found.cleared == ["a"]
    assert found.added.tolist() == [1, 3]


def test_a_namespace_that_was_cleared_before_all_are_is_no_matter_of_its_own():
    found = outcome(("a", 0, ALL), ("a", 1, ADD), ("", 0, ALL))
    assert found.clears_all
    assert found.cleared == []
    assert found.added.tolist() == []


def test_markers_that_are_not_looked_at_ask_for_nothing():
    found = outcome(("a", 1, ADD), ("", 0, ALL), ("a", 1, DELETE), untaken=(1, 2))
    assert found == (False, [], [], found.added, None)
    assert found.added.tolist() == [0]


def test_one_that_is_named_twice_is_told():
    assert outcome(("a", 1, ADD), ("b", 1, ADD)).twice is None
    assert outcome(("a", 1, ADD), ("b", 1, ADD), ("b", 1, ADD)).twice == ("b", 1)
