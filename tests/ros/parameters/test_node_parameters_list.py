from __future__ import annotations

from studio.ros.parameters.node_parameters import list_names, prefixes_of

NAMES = ["a", "b.c", "b.d.e", "bc.x", "use_sim_time"]


def test_no_prefix_and_no_depth_is_everything():
    assert list_names(reversed(NAMES)) == NAMES


def test_a_depth_counts_the_parts_of_a_name():
    assert list_names(NAMES, (), 1) == ["a", "use_sim_time"]
    assert list_names(NAMES, (), 2) == ["a", "b.c", "bc.x", "use_sim_time"]


def test_a_prefix_ends_at_a_dot():
    assert list_names(NAMES, ["b"]) == ["b.c", "b.d.e"]
    assert list_names(NAMES, ["b"], 1) == ["b.c"]
    assert list_names(NAMES, ["b.d", "a"]) == ["a", "b.d.e"]


def test_groups_are_named_that_lie_above_names():
    assert prefixes_of(NAMES) == ["b", "b.d", "bc"]
