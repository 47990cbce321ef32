from __future__ import annotations

from dataclasses import replace

from studio.ros.tokens import gid_of
from studio.ros.wire.bridges.admin import Bounds, DdsNode, Told
from studio.ros.wire.bridges.bridge import Met, Sender, bridges_of, sender_gid, senders_of
from studio.ros.wire.bridges.dialect import Route, RouteKind
from tests.support.dds_bridges import bridge, bridged_end

HASH = "RIHS01_" + "1" * 64


def test_the_sender_of_a_topic_with_one_publisher_is_that_publisher():
    end = bridged_end("/chatter", type_hash=HASH)
    one = bridge("/talker", ends=(end,))
    found = senders_of((one,), {})
    assert found == {(one.zid, "/chatter"): Sender(gid_of(end.identity), HASH)}


def test_of_several_publishers_nobody_knows_which_one_sent():
    ends = tuple(bridged_end("/tf", node, type_hash=HASH) for node in ("/left", "/right"))
    one = bridge("/left", "/right", ends=ends)
    found = senders_of((one,), {})
    assert found == {(one.zid, "/tf"): Sender(sender_gid(one.zid, "/tf"), HASH)}
    assert sender_gid(one.zid, "/tf") not in {gid_of(end.identity) for end in ends}


def test_a_topic_that_another_bridge_brings_as_well_has_no_sender():
    one = replace(bridge("/talker"), zid="c1c1c1")
    assert senders_of((one,), {one.zid: frozenset({"/chatter"})}) == {(one.zid, "/chatter"): None}


def test_thousands_of_routes_of_one_name_and_of_nodes_that_have_it_are_bounded():
    """Each with each would be 50 millions: more than a test may take."""
    chatter, kind = "/chatter", "std_msgs/msg/String"
    ends = ((RouteKind.PUBLISHER, chatter, kind),)
    nodes = [DdsNode(f"0110{one:028x}", f"/n{one}", ends) for one in range(10_000)]
    met = [
        Met(
            zid,
            {
                f"{one}": Route(zid, RouteKind.PUBLISHER, chatter, kind, str(one))
                for one in range(5_000)
            },
            Told(nodes=nodes),
            asked=True,
        )
        for zid in ("a1", "b1")
    ]
    (first, second), doubles = bridges_of(met, 0)
    assert len(first.ends) == Bounds.of_each(2).ends
    assert (second.ends, second.nodes, second.twin) == ((), (), first.name)
    assert doubles["b1"] == {chatter}
