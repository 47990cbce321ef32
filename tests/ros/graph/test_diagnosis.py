"""Whoever sees or hears nobody is told why, and what to do about it."""

from __future__ import annotations

from studio.ros.graph.diagnosis import (
    DistroHashes,
    ForeignHashes,
    foreign_hashes,
    why_nobody,
    why_not_received,
)
from studio.ros.graph.endpoints import GraphEndpoint, GraphNode
from studio.ros.profiles import HUMBLE, JAZZY, NO_HASH, PROFILES
from studio.ros.qos import QoSProfile
from studio.ros.tokens import EndpointKind
from studio.ros.types.library import TypeLibrary

ENDPOINT = "tcp/127.0.0.1:7447"
STRING = "std_msgs/msg/String"
RANGE = "sensor_msgs/msg/Range"
"""Of which Humble's differs from Jazzy's; Humble's keys hold no hash at all."""
TRANSITION = "lifecycle_msgs/msg/TransitionEvent"
NODE = GraphNode("aa", 0, "/", "talker", "/", "/talker")
HASHES = DistroHashes(TypeLibrary("jazzy"))


def publisher(type_name: str, type_hash: str | None) -> GraphEndpoint:
    assert type_hash is not None
    return GraphEndpoint(
        "token", NODE, EndpointKind.PUBLISHER, "/x", type_name, type_hash, QoSProfile()
    )


def test_a_router_without_nodes_is_told():
    assert "no node is" in (why_nobody(ENDPOINT, 0, {}) or "")


def test_nodes_in_other_domains_are_counted_and_the_first_is_offered():
    sentence = why_nobody(ENDPOINT, 0, {0: 0, 3: 1, 7: 12})
    assert sentence == (
        "No node is in domain 0, but 1 node is in domain 3, 12 nodes are in domain 7: "
        "choose --domain 3."
    )


def test_who_sees_nodes_is_told_nothing():
    assert why_nobody(ENDPOINT, 3, {3: 1, 7: 2}) is None


def test_types_of_the_distribution_that_is_spoken_are_no_foreigners():
    ours = [publisher(name, HASHES("jazzy", name)) for name in (STRING, TRANSITION)]
    assert foreign_hashes(ours, JAZZY, HASHES) == []


def test_keys_without_hashes_are_of_humble():
    found = foreign_hashes([publisher(STRING, NO_HASH)], JAZZY, HASHES)
    assert found == [ForeignHashes((STRING,), ("humble",))]
    assert why_not_received(found[0], JAZZY) == (
        f"Others have {STRING} as of humble, where jazzy is spoken, and neither receives the "
        "other: choose --distro humble."
    )


def test_who_speaks_humble_is_told_which_distributions_have_a_hash():
    found = foreign_hashes([publisher(RANGE, HASHES("jazzy", RANGE))], HUMBLE, HASHES)
    assert found == [ForeignHashes((RANGE,), ("jazzy", "kilted"))]


def test_a_form_that_no_distribution_has_asks_for_its_package():
    types = [publisher(name, "RIHS01_00") for name in (STRING, RANGE)]
    found = foreign_hashes(types, JAZZY, HASHES)
    assert found == [ForeignHashes((RANGE, STRING), ())]
    assert "--interfaces" in why_not_received(found[0], JAZZY)


def test_a_type_that_is_unknown_here_is_no_foreign_form():
    assert foreign_hashes([publisher("a/msg/B", "RIHS01_00")], JAZZY, HASHES) == []


def test_many_types_are_named_in_part():
    found = ForeignHashes(tuple(f"a/msg/B{at}" for at in range(9)), ("kilted",))
    assert "a/msg/B2 and 6 more" in why_not_received(found, JAZZY)


def test_every_distribution_has_its_hashes():
    assert all(HASHES(distro, STRING) for distro in PROFILES)
    assert HASHES("humble", STRING) == NO_HASH
    assert HASHES("jazzy", "a/msg/B") is None
