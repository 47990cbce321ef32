"""The states of an action's goals, while somebody asks for them."""

from __future__ import annotations

from typing import Any

import pytest

from studio.errors import RosNameError
from studio.live.panels import goal_statuses
from studio.live.panels.goal_statuses import GoalStatusTopics
from studio.protocol.goals import GetGoalStatuses
from studio.ros.cdr import codec_of
from studio.ros.messages import message
from studio.ros.qos import qos_profile_action_status_default
from tests.support.memory_source import MemorySource

ARRAY = "action_msgs/msg/GoalStatusArray"
TOPIC = "/dock/_action/status"


def array(*goals: tuple[int, int]) -> bytes:
    """Goals by the last byte of their ids, each in a state."""
    status, info = message("action_msgs/msg/GoalStatus"), message("action_msgs/msg/GoalInfo")
    uuid = message("unique_identifier_msgs/msg/UUID")
    time = message("builtin_interfaces/msg/Time")

    def goal(number: int, state: int) -> Any:  # noqa: ANN401
        made = uuid(uuid=[0] * 15 + [number])
        return status(goal_info=info(goal_id=made, stamp=time(sec=number)), status=state)

    value = message(ARRAY)(status_list=[goal(*one) for one in goals])
    return bytes(codec_of(message(ARRAY)).encode(value))


def shown(topics: GoalStatusTopics, name: str = "/dock") -> list[tuple[str, str, bool]]:
    goals = topics.statuses(GetGoalStatuses(name=name)).goals
    return [(one.goal_id[-2:], one.state, one.is_ours) for one in goals]


def test_the_newest_states_are_told_the_last_goal_first():
    source = MemorySource()
    server = source.offer(TOPIC, ARRAY, qos_profile_action_status_default)
    server.say(array((1, 2)))
    own = "0" * 30 + "02"
    topics = GoalStatusTopics(source, lambda: frozenset({own}))
    assert shown(topics) == [("01", "executing", False)]
    server.say(array((1, 4), (2, 2)))
    assert shown(topics) == [("02", "executing", True), ("01", "succeeded", False)]
    with pytest.raises(RosNameError):
        shown(topics, "no name")


def test_goals_of_another_connection_are_not_told():
    source = MemorySource()
    server = source.offer(TOPIC, ARRAY, qos_profile_action_status_default)
    server.say(array((1, 2)))
    topics = GoalStatusTopics(source, frozenset)
    assert shown(topics)
    source.forget(server)
    source.connect("none")
    assert shown(topics) == []
    source.connect()
    assert shown(topics) == []


def test_while_somebody_is_told_of_changes_an_action_stays_subscribed_without_a_question(
    monkeypatch: pytest.MonkeyPatch,
):
    source = MemorySource()
    changes: list[int] = []
    topics = GoalStatusTopics(source, frozenset, lambda: changes.append(1), lambda: True)
    monkeypatch.setattr(goal_statuses, "_ASKED_FOR_S", -1.0)
    shown(topics)
    source.offer(TOPIC, ARRAY, qos_profile_action_status_default).say(array((1, 2)))
    assert changes
    for number in range(30):
        shown(topics, f"/other_{number}")
    names = [one.topic.partition("/_action")[0] for one in source.opened]
    assert names == [f"/other_{number}" for number in range(10, 30)]


def test_an_action_that_nobody_asks_for_any_more_is_unsubscribed(monkeypatch: pytest.MonkeyPatch):
    source = MemorySource()
    topics = GoalStatusTopics(source, frozenset)
    shown(topics)
    assert [one.topic for one in source.opened] == [TOPIC]
    monkeypatch.setattr(goal_statuses, "_ASKED_FOR_S", -1.0)
    shown(topics, "/other")
    assert [one.topic for one in source.opened] == ["/other/_action/status"]
    topics.let_go()
    assert source.opened == []
