"""What a sample has that a bridge to DDS stamped, and no node of rmw_zenoh attached anything to."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING, Any, cast

from studio.ros.node.samples import bridged_attachment, bridged_sample, sender_of
from studio.ros.qos import QoSProfile
from studio.ros.tokens import EndpointKind, EndpointToken, NodeToken
from studio.ros.wire.zenoh import declare_subscription
from tests.support.wire import session_pair, wait_until

if TYPE_CHECKING:
    from studio.ros.wire.session import WireSession
    from studio.ros.wire.zenoh import Sample

STRING = "std_msgs/msg/String"


def received(one: WireSession, other: WireSession) -> Sample:
    """A sample of the one session at the other."""
    incoming = declare_subscription(other.zenoh, "chatter", 10, reliable=True)
    came: list[Sample] = []
    session = cast("Any", one.zenoh)

    def is_there() -> bool:
        session.put("chatter", b"cdr", timestamp=session.new_timestamp())
        came.extend(incoming.take(1))
        return bool(came)

    wait_until("a sample comes", is_there)
    return came[0]


def test_a_bridged_sample_has_the_time_and_the_sender_of_its_stamp():
    with session_pair() as (bridge, ours):
        sample = received(bridge, ours)
        node = NodeToken(0, ours.zid, 0, "/", "listener")
        token = EndpointToken(
            node, 1, EndpointKind.SUBSCRIPTION, "/chatter", STRING, "", QoSProfile(depth=1)
        )
        came = bridged_sample(ours.bridges, token, sample, 7)
        sender = ours.bridges.sender(bridge.zid, "/chatter")
        assert came is not None
        assert sender is not None
        assert sender_of(ours.bridges, "/chatter", sample) == sender
        attached = bridged_attachment(ours.bridges, "/chatter", sample, 7)
        assert attached == (came.attachment, sender.type_hash)
        assert came.attachment.gid == sender.gid
        stamp = cast("Any", sample.timestamp).get_time()
        sent = datetime.fromtimestamp(came.attachment.source_time_ns / 1e9, UTC)
        assert abs(sent - stamp) < timedelta(microseconds=5)
