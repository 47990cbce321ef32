from __future__ import annotations

from dataclasses import replace

from studio.ros.tokens import gid_of
from studio.ros.wire.bridges.bridge import Sender, sender_gid, senders_of
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
