from __future__ import annotations

from studio.ros.action.protocol import ActionNames


def test_an_action_is_three_services_and_two_topics_below_its_name():
    assert ActionNames.of("/ns/turn") == ActionNames(
        send_goal="/ns/turn/_action/send_goal",
        cancel_goal="/ns/turn/_action/cancel_goal",
        get_result="/ns/turn/_action/get_result",
        feedback="/ns/turn/_action/feedback",
        status="/ns/turn/_action/status",
    )
