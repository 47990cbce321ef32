"""The table of the graph ends in the same state whatever the order in which tokens come and go."""

from __future__ import annotations

from itertools import permutations
from typing import TYPE_CHECKING

from hypothesis import given
from hypothesis import strategies as st

from studio.ros.graph import endpoints as tables
from studio.ros.graph.endpoints import GraphTable, Taken
from studio.ros.qos import QoSProfile
from studio.ros.tokens import EndpointKind, EndpointToken, NodeToken, gid_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pytest

NODE = NodeToken(0, "aa", 0, "/robot", "talker")
TOKENS = [
    str(NODE),
    *(
        str(
            EndpointToken(
                NODE, number, kind, name, "std_msgs/msg/String", "RIHS01_df", QoSProfile(depth=10)
            )
        )
        for number, (kind, name) in enumerate(
            [
                (EndpointKind.PUBLISHER, "/chatter"),
                (EndpointKind.SUBSCRIPTION, "/chatter"),
                (EndpointKind.SERVICE, "/robot/talker/get_parameters"),
            ],
            start=1,
        )
    ),
]
EVENTS = st.lists(st.tuples(st.booleans(), st.sampled_from(TOKENS)), max_size=30)


def endpoint(
    node: NodeToken = NODE,
    eid: int = 1,
    kind: EndpointKind = EndpointKind.PUBLISHER,
    name: str = "/chatter",
) -> str:
    return str(
        EndpointToken(node, eid, kind, name, "std_msgs/msg/String", "RIHS01_df", QoSProfile())
    )


def filled(tokens: Sequence[str] = TOKENS) -> GraphTable:
    table = GraphTable()
    for token in tokens:
        assert table.put(token) is Taken.CHANGED
    return table


def seen(table: GraphTable) -> set[tuple[str, tuple[str, ...]]]:
    return {
        (node.path, tuple(one.token for one in table.endpoints_of(node))) for node in table.nodes()
    }


def is_empty(table: GraphTable) -> bool:
    named = [table.named(kind) for kind in EndpointKind]
    return not (len(table) or table.nodes() or any(named))


def test_every_order_of_coming_gives_the_same_graph():
    expected = seen(filled())
    assert len(expected) == 1
    assert all(seen(filled(order)) == expected for order in permutations(TOKENS))


def test_every_order_of_going_leaves_nothing():
    for order in permutations(TOKENS):
        table = filled()
        for token in order:
            table.delete(token)
        assert is_empty(table)


def test_a_token_that_comes_twice_is_there_once_and_goes_once():
    table = filled()
    assert table.put(TOKENS[1]) is Taken.KNOWN
    assert table.delete(TOKENS[1]) is Taken.CHANGED
    assert table.count(EndpointKind.PUBLISHER, "/chatter") == 0


def test_a_node_takes_its_endpoints_with_it():
    table = filled()
    table.delete(TOKENS[0])
    assert is_empty(table)


def test_endpoints_that_went_with_their_node_come_again_with_it():
    """As when a router ends and returns: the tokens of before stand anew."""
    table = filled()
    for token in TOKENS:
        table.delete(token)
    for token in TOKENS:
        assert table.put(token) is Taken.CHANGED
    assert seen(table) == seen(filled())


def test_a_node_is_known_by_its_endpoints_alone_and_goes_with_the_last():
    table = filled(TOKENS[1:3])
    assert [node.path for node in table.nodes()] == ["/robot/talker"]
    table.delete(TOKENS[1])
    assert [node.path for node in table.nodes()] == ["/robot/talker"]
    table.delete(TOKENS[2])
    assert is_empty(table)


def test_what_goes_before_it_comes_is_doubted_until_somebody_is_sure():
    table = GraphTable()
    table.delete(TOKENS[1])
    assert table.put(TOKENS[1]) is Taken.UNCERTAIN
    assert is_empty(table)
    table.settle(TOKENS[1], is_alive=True)
    assert table.count(EndpointKind.PUBLISHER, "/chatter") == 1


def test_what_was_doubted_and_stood_not_may_come_later():
    table = GraphTable()
    table.delete(TOKENS[1])
    table.settle(TOKENS[1], is_alive=False)
    assert is_empty(table)
    assert table.put(TOKENS[1]) is Taken.CHANGED


def test_two_nodes_of_one_name_are_two():
    other = NodeToken(0, "bb", 0, "/robot", "talker")
    table = filled([str(NODE), str(other), endpoint(NODE), endpoint(other)])
    assert [node.zid for node in table.nodes()] == ["aa", "bb"]
    table.delete(str(other))
    assert [one.node.zid for one in table.endpoints(EndpointKind.PUBLISHER, "/chatter")] == ["aa"]


def test_two_nodes_of_one_number_are_two():
    """Foreign peers number the nodes of a session all alike."""
    other = NodeToken(0, "aa", 0, "/robot", "listener")
    table = filled([str(NODE), str(other)])
    table.delete(str(other))
    assert [node.name for node in table.nodes()] == ["talker"]


def test_a_token_that_is_none_is_counted_and_told_once():
    table = GraphTable()
    for _ in range(2):
        table.put("@ros2_lv/0/aa/0/0/XX/%/%/talker")
    table.put("@ros2_lv/0/aa")
    assert table.malformed == 2
    assert table.last_malformed is not None
    assert "too few parts" in table.last_malformed
    assert is_empty(table)


def test_a_token_that_was_none_goes_and_comes_without_doubt():
    table = GraphTable()
    bad = "@ros2_lv/0/aa/0/0/XX/%/%/talker"
    table.put(bad)
    table.delete(bad)
    assert table.put(bad) is Taken.REFUSED
    assert table.malformed == 2


def test_a_sample_is_traced_to_its_publisher_until_that_goes():
    table = filled()
    found = table.endpoint_of_gid(gid_of(TOKENS[1]))
    assert found is not None
    assert (found.name, found.node.path) == ("/chatter", "/robot/talker")
    table.delete(TOKENS[1])
    assert table.endpoint_of_gid(gid_of(TOKENS[1])) is None


def test_more_tokens_than_any_robot_has_are_counted_only(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(tables, "TOKENS_MAX", 3)
    table = GraphTable()
    for token in TOKENS:
        table.put(token)
    assert (len(table), table.left_out) == (3, 1)


def test_ten_thousand_topics_are_found_by_name():
    table = GraphTable()
    for number in range(10_000):
        table.put(endpoint(eid=number + 1, name=f"/topic_{number}"))
    assert len(table.named(EndpointKind.PUBLISHER)) == 10_000
    assert [one.name for one in table.endpoints(EndpointKind.PUBLISHER, "/topic_77")] == [
        "/topic_77"
    ]


@given(EVENTS)
def test_what_came_and_did_not_go_stands_whatever_happened_before(
    events: list[tuple[bool, str]],
):
    """The node's own token is left out: it takes others with it, which rows above show."""
    table, standing = GraphTable(), set[str]()
    for comes, token in events:
        if token == TOKENS[0]:
            continue
        if comes:
            if table.put(token) is Taken.UNCERTAIN:
                table.settle(token, is_alive=True)
            standing.add(token)
        else:
            table.delete(token)
            standing.discard(token)
    assert {one for _, tokens in seen(table) for one in tokens} == standing
    assert all(table.was_seen(token) for _, token in events if token != TOKENS[0])


@given(st.lists(st.tuples(st.booleans(), st.text(alphabet="@ros2_lv/%MNSP0:,ab", max_size=80))))
def test_no_text_does_harm(events: list[tuple[bool, str]]):
    table = filled()
    for comes, token in events:
        table.put(token) if comes else table.delete(token)
    assert seen(table) == seen(filled())
