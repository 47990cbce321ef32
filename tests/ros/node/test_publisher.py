from __future__ import annotations

import pytest

from studio.ros.messages import message
from tests.support.node_pair import node_pair
from tests.support.wire import wait_until

pytestmark = pytest.mark.network
String = message("std_msgs/msg/String")
Int32 = message("std_msgs/msg/Int32")


def test_who_subscribes_with_another_type_is_not_counted_among_those_who_hear():
    with node_pair() as (talker, listener):
        publisher = talker.create_publisher(String, "said", 10)
        for kind in (String, Int32):
            listener.create_subscription(kind, "said", print, 10)
        wait_until("both are there", lambda: talker.count_subscribers("/said") == 2)
        assert publisher.get_subscription_count() == 1
