from __future__ import annotations

from studio.ros.parameters.listing import listed, prefixes_of

NAMES = ["a", "b.c", "b.d.e", "bc.x", "use_sim_time"]


def test_no_prefix_and_no_depth_is_everything():
    assert listed(reversed(NAMES)) == NAMES


def test_a_depth_counts_the_parts_of_a_name():
    assert listed(NAMES, (), 1) == ["a", "use_sim_time"]
    assert listed(NAMES, (), 2) == ["a", "b.c", "bc.x", "use_sim_time"]


def test_a_prefix_ends_at_a_dot():
    assert listed(NAMES, ["b"]) == ["b.c", "b.d.e"]
    assert listed(NAMES, ["b"], 1) == ["b.c"]
    assert listed(NAMES, ["b.d", "a"]) == ["a", "b.d.e"]


def test_groups_are_named_that_lie_above_names():
    assert prefixes_of(NAMES) == ["b", "b.d", "bc"]
